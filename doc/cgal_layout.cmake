# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Lays the package out as the packages of CGAL's own tree are, ready to be copied beside them:
#   cmake -DOUTPUT=FOLDER -P doc/cgal_layout.cmake
# writes FOLDER/Spectral_mesh_simplification/{include,examples,test,doc,package_info}. The command-line programs stay
# behind: CGAL has no place for them. With -DCHECK=ON it stops unless the tree is complete.

cmake_minimum_required(VERSION 3.16)
set(package Spectral_mesh_simplification)
get_filename_component(root "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
if(NOT OUTPUT)
  message(FATAL_ERROR "Say where: cmake -DOUTPUT=FOLDER -P doc/cgal_layout.cmake")
endif()
get_filename_component(output "${OUTPUT}/${package}" ABSOLUTE)
file(REMOVE_RECURSE "${output}")

file(COPY "${root}/include" DESTINATION "${output}")

# Examples and tests: all but the programs that need further libraries, their parts and the tests of those.
set(stays_behind "#include [<\"](\\.\\./examples/programs/)?(boost/program_options|nlohmann|io/|report/|compare/)")
file(GLOB candidates RELATIVE "${root}" "${root}/examples/*.cpp" "${root}/test/test_*.cpp" "${root}/test/*.h"
     "${root}/test/main.cpp")
set(examples "")
foreach(file IN LISTS candidates)
  file(READ "${root}/${file}" text)
  if(text MATCHES "${stays_behind}")
    continue()
  endif()
  get_filename_component(kind "${file}" DIRECTORY)
  get_filename_component(name "${file}" NAME)
  file(COPY "${root}/${file}" DESTINATION "${output}/${kind}/${package}")
  if(kind STREQUAL "examples")
    list(APPEND examples "${name}")
  endif()
endforeach()

foreach(kind IN ITEMS examples test)
  configure_file("${root}/doc/cgal/CMakeLists.${kind}.txt" "${output}/${kind}/${package}/CMakeLists.txt" COPYONLY)
endforeach()

# The manual: one comment that Doxygen reads as Markdown, with the code taken from the examples again.
file(READ "${root}/doc/user_manual.md" manual)
if(manual MATCHES "\\*/")
  message(FATAL_ERROR "doc/user_manual.md contains the end of a C comment; reword it.")
endif()
string(REGEX REPLACE "^# [^\n]*\n+Sections: [^\n]*\n([^\n]+\n)*" "" manual "${manual}")
string(REGEX REPLACE "<!-- snippet: examples/([A-Za-z0-9_]+\\.cpp) ([a-z_]+) -->\n+```cpp\n[^`]*```"
                     "\\\\snippet ${package}/\\1 \\2" manual "${manual}")
# Pages that stay behind.
string(REGEX REPLACE "\\[([^]]*)\\]\\([a-z_/.]*\\.md\\)" "\\1" manual "${manual}")
file(WRITE "${output}/doc/${package}/${package}.txt"
     "namespace CGAL {\n/*!\n\n\\mainpage User Manual\n\\anchor Chapter_Spectral_Mesh_Simplification\n\n\\cgalAutoToc\n\n"
     "\\authors The Spectral mesh simplification authors\n${manual}\n*/\n} /* namespace CGAL */\n")

file(COPY "${root}/doc/PackageDescription.txt" "${root}/doc/fig" DESTINATION "${output}/doc/${package}")
set(list "")
foreach(name IN LISTS examples)
  string(APPEND list "\\example ${package}/${name}\n")
endforeach()
file(WRITE "${output}/doc/${package}/examples.txt" "/*!\n${list}*/\n")
file(WRITE "${output}/doc/${package}/Doxyfile.in"
     "@INCLUDE = \${CGAL_DOC_PACKAGE_DEFAULTS}\n\nPROJECT_NAME = \"CGAL \${CGAL_DOC_VERSION} - Spectral Mesh Simplification\"\n"
     "EXCLUDE_PATTERNS += */internal/*\n")
file(WRITE "${output}/doc/${package}/dependencies"
     "Manual\nKernel_23\nBGL\nSurface_mesh\nSurface_mesh_simplification\nPolygon_mesh_processing\n")

file(COPY "${root}/doc/cgal/package_info/" DESTINATION "${output}/package_info/${package}")
if(CHECK)
  set(wanted doc/${package}/${package}.txt doc/${package}/PackageDescription.txt doc/${package}/Doxyfile.in
             doc/${package}/examples.txt doc/${package}/dependencies examples/${package}/CMakeLists.txt
             examples/${package}/edge_collapse_spectral.cpp test/${package}/CMakeLists.txt test/${package}/test_kernel.cpp)
  foreach(name IN ITEMS copyright dependencies description.txt license.txt long_description.txt maintainer)
    list(APPEND wanted package_info/${package}/${name})
  endforeach()
  file(GLOB_RECURSE headers RELATIVE "${root}" "${root}/include/*.h")
  list(APPEND wanted ${headers})
  foreach(name IN LISTS wanted)
    if(NOT EXISTS "${output}/${name}")
      message(FATAL_ERROR "${name} is missing.")
    endif()
  endforeach()
  # What the manual shows: figures, and parts of examples.
  string(REGEX MATCHALL "fig/[a-z_]+\\.(png|svg)" figures "${manual}")
  foreach(figure IN LISTS figures)
    if(NOT EXISTS "${output}/doc/${package}/${figure}")
      message(FATAL_ERROR "The manual shows ${figure}, which is missing.")
    endif()
  endforeach()
  string(REGEX MATCHALL "\\\\snippet [A-Za-z_/]+\\.cpp [a-z_]+" snippets "${manual}")
  if(NOT snippets)
    message(FATAL_ERROR "No code of the manual was replaced by that of the examples.")
  endif()
  foreach(snippet IN LISTS snippets)
    string(REGEX MATCH "([A-Za-z_]+\\.cpp) ([a-z_]+)$" found "${snippet}")
    set(part "${CMAKE_MATCH_2}")
    file(READ "${output}/examples/${package}/${CMAKE_MATCH_1}" text)
    if(NOT text MATCHES "//! \\[${part}\\]")
      message(FATAL_ERROR "There is no part ${part} in ${CMAKE_MATCH_1}.")
    endif()
  endforeach()
endif()
message(STATUS "Written: ${output}")
