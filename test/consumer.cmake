# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# A project outside this tree: configured, built and run against an installed copy and by
# add_subdirectory.

set(prefix "${CMAKE_CURRENT_BINARY_DIR}/installed")
# Where the library is Clang's on Linux, consumers are GCC's: both have one ABI and one standard
# library there.
set(consumer_compiler "${CMAKE_CXX_COMPILER}")
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_SYSTEM_NAME STREQUAL "Linux" AND NOT CMAKE_CROSSCOMPILING
   AND NOT SPECTRAL_SANITIZE AND NOT CMAKE_CXX_FLAGS MATCHES "-stdlib")
  find_program(SPECTRAL_GCC NAMES g++)
  mark_as_advanced(SPECTRAL_GCC)
  if(SPECTRAL_GCC)
    set(consumer_compiler "${SPECTRAL_GCC}")
  endif()
endif()
get_filename_component(consumer_compiler_name "${consumer_compiler}" NAME)
set(consumer_options -DCMAKE_CXX_COMPILER=${consumer_compiler}
                     -DCGAL_DIR=${CGAL_DIR} -DEigen3_DIR=${Eigen3_DIR})
if(SPECTRAL_SANITIZE) # the library that they link is sanitized
  list(APPEND consumer_options "-DCMAKE_CXX_FLAGS=-fsanitize=${spectral_sanitizers} -fno-sanitize-recover=all")
endif()

# Adds the test `name`: configures and builds `source`, then runs `program` with the further
# arguments. Not optimised and without debug symbols it takes half the time to compile.
function(spectral_add_consumer_test name source options program)
  add_test(NAME "${name}"
           COMMAND ${CMAKE_CTEST_COMMAND}
                   --build-and-test "${source}" "${CMAKE_CURRENT_BINARY_DIR}/${name}-${consumer_compiler_name}"
                   --build-generator ${CMAKE_GENERATOR} --build-noclean --build-target ${program}
                   --build-options ${consumer_options} -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 ${options}
                   --test-command ${program} ${ARGN})
  set_tests_properties("${name}" PROPERTIES LABELS consumer TIMEOUT ${long_timeout} COST 100) # the longest come first
endfunction()

add_test(NAME "install" COMMAND ${CMAKE_COMMAND} --install "${PROJECT_BINARY_DIR}" --prefix "${prefix}")
set_tests_properties("install" PROPERTIES LABELS consumer FIXTURES_SETUP installed)

spectral_add_consumer_test("consumer-find-package" "${CMAKE_CURRENT_SOURCE_DIR}/consumer"
                           "-DSpectral_mesh_simplification_ROOT=${prefix}" consumer)
set_tests_properties("consumer-find-package" PROPERTIES FIXTURES_REQUIRED installed)
spectral_add_consumer_test("consumer-add-subdirectory" "${CMAKE_CURRENT_SOURCE_DIR}/consumer"
                           "-DSPECTRAL_SOURCE_DIR=${PROJECT_SOURCE_DIR}" consumer)

# The examples' own CMakeLists.txt, outside of the project, with its smallest program.
if(TARGET make_demo_shape)
  spectral_add_consumer_test("examples-find-package" "${PROJECT_SOURCE_DIR}/examples"
                             "-DSpectral_mesh_simplification_ROOT=${prefix}" make_demo_shape
                             --help)
  set_tests_properties("examples-find-package" PROPERTIES FIXTURES_REQUIRED installed)

endif()

# Headers alone, without CMake: the compiler, the folder include/, and the flags of the manual. What
# nm prints is that of ELF.
if(CMAKE_NM AND NOT APPLE)
  add_test(NAME "consumer-include-folder"
           COMMAND sh "${CMAKE_CURRENT_SOURCE_DIR}/include_folder_test.sh" "${CMAKE_CXX_COMPILER}" "${CMAKE_NM}"
                   "${prefix}/${CMAKE_INSTALL_INCLUDEDIR}" "${CMAKE_CURRENT_SOURCE_DIR}/consumer"
                   "${CMAKE_CURRENT_BINARY_DIR}/include-folder" ${CGAL_INCLUDE_DIRS}
                   $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>)
  set_tests_properties("consumer-include-folder" PROPERTIES LABELS consumer TIMEOUT ${long_timeout} COST 200 FIXTURES_REQUIRED installed)
endif()
