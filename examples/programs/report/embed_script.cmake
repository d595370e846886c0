# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Makes the target spectral_report_script: the header shape_view_script.h, which has the viewer of
# the report as a string, from shape_view.js.

file(READ "${CMAKE_CURRENT_LIST_DIR}/shape_view.js" SHAPE_VIEW_SCRIPT)
string(REGEX REPLACE "^(//[^\n]*\n|\n)+" "" SHAPE_VIEW_SCRIPT "${SHAPE_VIEW_SCRIPT}")
set(spectral_report_headers "${CMAKE_CURRENT_BINARY_DIR}/report_headers")
configure_file("${CMAKE_CURRENT_LIST_DIR}/shape_view_script.h.in"
               "${spectral_report_headers}/shape_view_script.h" @ONLY)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
             "${CMAKE_CURRENT_LIST_DIR}/shape_view.js")
add_library(spectral_report_script INTERFACE)
target_include_directories(spectral_report_script INTERFACE "${spectral_report_headers}")
