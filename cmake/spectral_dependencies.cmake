# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Finds what the headers need. Included by CMakeLists.txt and by the installed package
# configuration, so that a build from the source tree and a build against an installed copy agree.
#
# Sets Spectral_mesh_simplification_MISSING to one sentence when something is missing or too old, to
# nothing otherwise.

set(Spectral_mesh_simplification_MISSING "")

# CGAL's configuration stops with an error of its own when Boost is missing: ask for Boost first.
if(NOT Boost_FOUND)
  if(POLICY CMP0167)
    cmake_policy(PUSH)
    cmake_policy(SET CMP0167 NEW)
    find_package(Boost QUIET)
    cmake_policy(POP)
  else()
    find_package(Boost QUIET)
  endif()
endif()
if(NOT Boost_FOUND)
  set(Spectral_mesh_simplification_MISSING
      "Boost was not found: install it (on Debian: apt-get install libboost-dev) or set Boost_ROOT.")
  return()
endif()

find_package(CGAL QUIET)
if(NOT CGAL_FOUND OR NOT CGAL_VERSION) # which has no version where its files are not complete
  set(Spectral_mesh_simplification_MISSING
      "CGAL 5.5 or later was not found: install it (on Debian: apt-get install libcgal-dev) or set CGAL_DIR.")
  return()
elseif(CGAL_VERSION VERSION_LESS 5.5)
  set(Spectral_mesh_simplification_MISSING
      "CGAL ${CGAL_VERSION} in ${CGAL_DIR} is too old, 5.5 or later is needed: install it (on Debian: apt-get install libcgal-dev) or set CGAL_DIR.")
  return()
endif()

# No version is passed to find_package: Eigen 5 calls itself incompatible with a request for 3.4.
find_package(Eigen3 CONFIG QUIET)
if(NOT TARGET Eigen3::Eigen)
  set(Spectral_mesh_simplification_MISSING
      "Eigen 3.4 or later was not found: install it (on Debian: apt-get install libeigen3-dev) or set Eigen3_DIR.")
  return()
elseif(Eigen3_VERSION VERSION_LESS 3.4)
  set(Spectral_mesh_simplification_MISSING
      "Eigen ${Eigen3_VERSION} in ${Eigen3_DIR} is too old, 3.4 or later is needed: install it (on Debian: apt-get install libeigen3-dev) or set Eigen3_DIR.")
  return()
endif()

set(THREADS_PREFER_PTHREAD_FLAG ON)
find_package(Threads QUIET)
if(NOT TARGET Threads::Threads)
  set(Spectral_mesh_simplification_MISSING
      "No thread library was found for this compiler: install its C library's development files (on Debian: apt-get install libc6-dev).")
  return()
endif()

# Should CGAL ship a header of ours one day, two different files would compete for one name. Looks
# for `headers` (names as they are included) in the CGAL that was found; ours (an earlier
# installation into CGAL's own prefix) are recognised by their copyright line. Sets `result` to the
# first foreign file, or to nothing.
function(spectral_find_foreign_header headers result)
  set(${result} "" PARENT_SCOPE)
  foreach(directory IN LISTS CGAL_INCLUDE_DIRS)
    foreach(header IN LISTS headers)
      if(EXISTS "${directory}/${header}")
        file(STRINGS "${directory}/${header}" marker REGEX "Spectral mesh simplification authors" LIMIT_COUNT 1)
        if(NOT marker)
          set(${result} "${directory}/${header}" PARENT_SCOPE)
          return()
        endif()
      endif()
    endforeach()
  endforeach()
endfunction()
