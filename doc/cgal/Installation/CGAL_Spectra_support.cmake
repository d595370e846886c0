# Finds Spectra 1.0 or later, as a CMake package or as a folder of headers, and makes the target CGAL::Spectra_support. To be included
# after CGAL_Eigen3_support, as Spectra needs Eigen.
if(TARGET CGAL::Eigen3_support AND NOT TARGET CGAL::Spectra_support)
  if(NOT TARGET Spectra::Spectra)
    find_package(Spectra CONFIG QUIET)
  endif()
  if(NOT TARGET Spectra::Spectra)
    find_path(SPECTRA_INCLUDE_DIR NAMES Spectra/SymGEigsShiftSolver.h DOC "The folder that has Spectra/SymGEigsShiftSolver.h")
    mark_as_advanced(SPECTRA_INCLUDE_DIR)
  endif()
  if(TARGET Spectra::Spectra OR SPECTRA_INCLUDE_DIR)
    find_package(Threads REQUIRED)
    add_library(CGAL::Spectra_support INTERFACE IMPORTED)
    set_target_properties(CGAL::Spectra_support PROPERTIES
      INTERFACE_COMPILE_DEFINITIONS "CGAL_SPECTRA_ENABLED"
      INTERFACE_LINK_LIBRARIES "CGAL::Eigen3_support;Threads::Threads")
    if(TARGET Spectra::Spectra)
      set_property(TARGET CGAL::Spectra_support APPEND PROPERTY INTERFACE_LINK_LIBRARIES Spectra::Spectra)
    else()
      set_target_properties(CGAL::Spectra_support PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${SPECTRA_INCLUDE_DIR}")
    endif()
  endif()
endif()
