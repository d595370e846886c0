# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The test cgal-layout-clone: doc/cgal_layout.cmake writes nothing into a clone of CGAL that lacks a
# file or an anchor, and names each that is missing; into one that has them all it writes
# everything, once. Called as that script is; OUTPUT is where a mock of a clone goes.

cmake_minimum_required(VERSION 3.16)
find_path(CGAL_INCLUDE_DIR NAMES CGAL/version.h PATHS /usr/local/include /usr/include)
set(everything "${OUTPUT}/Everything/include/CGAL")
file(REMOVE "${everything}") # a link, before what is around it
file(REMOVE_RECURSE "${OUTPUT}")
file(COPY "${CGAL_INCLUDE_DIR}/CGAL/config.h" DESTINATION "${OUTPUT}/Installation/include/CGAL")
file(MAKE_DIRECTORY "${OUTPUT}/Everything/include")
file(CREATE_LINK "${CGAL_INCLUDE_DIR}/CGAL" "${everything}" SYMBOLIC)

# The files of the clone and what is in them.
function(state result)
  file(GLOB_RECURSE files LIST_DIRECTORIES false "${OUTPUT}/*")
  list(REMOVE_ITEM files "${everything}")
  set(all "")
  foreach(file IN LISTS files)
    file(SHA256 "${file}" hash)
    string(APPEND all "${file} ${hash}\n")
  endforeach()
  set(${result} "${all}" PARENT_SCOPE)
endfunction()

# What the script says, which is to succeed or else to leave the clone as it is.
function(lay_out succeeds said)
  state(before)
  execute_process(COMMAND ${CMAKE_COMMAND} -DOUTPUT=${OUTPUT} -DEIGEN3_INCLUDE_DIR=${EIGEN3_INCLUDE_DIR} -DCXX=${CXX} -DCHECK=ON
                          -P "${CMAKE_CURRENT_LIST_DIR}/../cgal_layout.cmake"
                  RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE errors)
  state(after)
  if(succeeds AND NOT status EQUAL 0 OR NOT succeeds AND (status EQUAL 0 OR NOT before STREQUAL after))
    message(FATAL_ERROR "The script ended with ${status}, or changed a clone that it refused:\n${errors}")
  endif()
  set(${said} "${errors}" PARENT_SCOPE)
endfunction()

# Each file that is missing becomes an empty one, then each anchor that is missing is put in.
lay_out(FALSE said)
string(REGEX MATCHALL "There is no [^\n]+\\.\n" lines "${said}")
foreach(line IN LISTS lines)
  string(REGEX REPLACE "There is no ([^\n]+)\\.\n" "\\1" file "${line}")
  file(WRITE "${OUTPUT}/${file}" "")
endforeach()
lay_out(FALSE said)
string(REGEX MATCHALL "\n +[A-Za-z_/]+\\.[a-z]+ has no '[^\n]+'," lines "${said}")
list(LENGTH lines anchors)
list(POP_FRONT lines one)
foreach(line IN LISTS lines)
  string(REGEX MATCH "([^ \n]+) has no '([^\n]+)'" found "${line}")
  file(APPEND "${OUTPUT}/${CMAKE_MATCH_1}" "before\n${CMAKE_MATCH_2}\nafter\n")
endforeach()
lay_out(FALSE said)
string(REGEX MATCH "([^ \n]+) has no '([^\n]+)'" found "${one}")
set(file "${CMAKE_MATCH_1}")
set(anchor "${CMAKE_MATCH_2}")
string(FIND "${said}" "${file} has no '${anchor}'" at)
if(anchors LESS 7 OR at EQUAL -1)
  message(FATAL_ERROR "Of ${anchors} anchors one is missing, '${anchor}', and the script said:\n${said}")
endif()
file(APPEND "${OUTPUT}/${file}" "before\n${anchor}\nafter\n")
lay_out(TRUE said)
lay_out(FALSE said)
string(REGEX REPLACE "[ \n]+" " " said "${said}") # CMake breaks lines where the path of this folder has it
if(NOT said MATCHES "has the package Spectral_geometry already")
  message(FATAL_ERROR "The second run said:\n${said}")
endif()
foreach(line IN LISTS lines ITEMS "${one}")
  string(REGEX MATCH "([^ \n]+) has no '([^\n]+)'" found "${line}")
  file(READ "${OUTPUT}/${CMAKE_MATCH_1}" text)
  string(REGEX REPLACE "[][*?+(){}\\.$^]" "\\\\\\0" anchor "${CMAKE_MATCH_2}")
  string(REPLACE ";" "," text "${text}")
  if(NOT text MATCHES "^before\n.*${anchor}\n.*after\n" OR text MATCHES "^before\n${anchor}\nafter\n$")
    message(FATAL_ERROR "${CMAKE_MATCH_1} was not extended:\n${text}")
  endif()
endforeach()
