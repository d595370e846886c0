# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Finds CHOLMOD, the sparse Cholesky factorisation of SuiteSparse, and defines the target SuiteSparse::CHOLMOD.
# SuiteSparse 7 brings a configuration of its own and is asked first; older ones (Debian 12) have none.

find_package(CHOLMOD CONFIG QUIET)
if(TARGET SuiteSparse::CHOLMOD)
  set(CHOLMOD_FOUND TRUE)
  return()
endif()

find_path(CHOLMOD_INCLUDE_DIR NAMES cholmod.h PATH_SUFFIXES suitesparse)
find_library(CHOLMOD_LIBRARY NAMES cholmod)
mark_as_advanced(CHOLMOD_INCLUDE_DIR CHOLMOD_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(CHOLMOD REQUIRED_VARS CHOLMOD_LIBRARY CHOLMOD_INCLUDE_DIR)

if(CHOLMOD_FOUND AND NOT TARGET SuiteSparse::CHOLMOD)
  add_library(SuiteSparse::CHOLMOD UNKNOWN IMPORTED)
  set_target_properties(SuiteSparse::CHOLMOD PROPERTIES IMPORTED_LOCATION "${CHOLMOD_LIBRARY}"
                                                        INTERFACE_INCLUDE_DIRECTORIES "${CHOLMOD_INCLUDE_DIR}")
  # A static libcholmod does not say what it needs.
  if(CHOLMOD_LIBRARY MATCHES "\\.a$")
    foreach(name IN ITEMS amd camd colamd ccolamd metis suitesparseconfig lapack blas)
      find_library(CHOLMOD_${name}_LIBRARY NAMES ${name})
      mark_as_advanced(CHOLMOD_${name}_LIBRARY)
      if(CHOLMOD_${name}_LIBRARY)
        target_link_libraries(SuiteSparse::CHOLMOD INTERFACE "${CHOLMOD_${name}_LIBRARY}")
      endif()
    endforeach()
  endif()
endif()
