# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The examples on a small copy of the demonstration's shape, and the command line with its errors.

set(shape "${CMAKE_CURRENT_BINARY_DIR}/shape.off")

# The examples print how they ended; a wrong exit status is a failure as well.
if(TARGET make_demo_shape)
  add_test(NAME "make-demo-shape" COMMAND make_demo_shape "${shape}" --vertices 2000)
  set_tests_properties("make-demo-shape" PROPERTIES LABELS examples FIXTURES_SETUP shape)
  foreach(example IN ITEMS edge_collapse_spectral edge_collapse_spectral_attributes edge_collapse_spectral_constrained
                           edge_collapse_spectral_functions fitted_operators)
    add_test(NAME "${example}" COMMAND ${example} "${shape}" "${CMAKE_CURRENT_BINARY_DIR}/${example}.ply" 400)
    set_tests_properties("${example}" PROPERTIES LABELS examples FIXTURES_REQUIRED shape)
  endforeach()
  set(mesh_types surface_mesh polyhedron)
  if(TARGET OpenMeshCore)
    list(APPEND mesh_types openmesh)
  endif()
  foreach(type IN LISTS mesh_types)
    add_test(NAME "edge_collapse_spectral_swap-${type}"
             COMMAND edge_collapse_spectral_swap "${shape}" "${CMAKE_CURRENT_BINARY_DIR}/swap_${type}.off" 600 ${type})
    set_tests_properties("edge_collapse_spectral_swap-${type}" PROPERTIES LABELS examples FIXTURES_REQUIRED shape
                         PASS_REGULAR_EXPRESSION "with Garland-Heckbert 600 .*P is 600 x [0-9]+, [1-9][0-9]* vertices were relocated")
  endforeach()
  set_tests_properties("edge_collapse_spectral" PROPERTIES PASS_REGULAR_EXPRESSION "is 400 x [0-9]+")
  set_tests_properties("edge_collapse_spectral_attributes" PROPERTIES PASS_REGULAR_EXPRESSION
                       "normals are [0-9]\\.[0-9]+ degrees .*red is [0-9]\\.[0-9]+ of 255 .* (9[0-9].*|100) % of the labels.*P differ by (0|[0-9.]+e-1[0-9]) at most")
  set_tests_properties("edge_collapse_spectral_constrained" PROPERTIES PASS_REGULAR_EXPRESSION "-> 400 vertices")
  set_tests_properties("fitted_operators" PROPERTIES PASS_REGULAR_EXPRESSION "own operators, [0-9.]+ with the fitted ones")
  set_tests_properties("edge_collapse_spectral_functions" PROPERTIES PASS_REGULAR_EXPRESSION "back, is off by [01]\\.[0-9]+ %")
endif()

find_package(nlohmann_json CONFIG QUIET)
if(TARGET spectral_simplify AND TARGET make_demo_shape)
  # Checks what the command line wrote against its definitions, reading the files anew.
  add_executable(check_outputs check_outputs.cpp)
  target_include_directories(check_outputs PRIVATE "${PROJECT_SOURCE_DIR}/examples/programs")
  target_link_libraries(check_outputs PRIVATE spectral_examples_io nlohmann_json::nlohmann_json)
  add_test(NAME "cli" COMMAND sh "${CMAKE_CURRENT_SOURCE_DIR}/cli_test.sh" $<TARGET_FILE:spectral_simplify>
                              $<TARGET_FILE:check_outputs> "${shape}" "${CMAKE_CURRENT_BINARY_DIR}/cli")
  set_tests_properties("cli" PROPERTIES LABELS examples FIXTURES_REQUIRED shape TIMEOUT ${timeout})
endif()

if(TARGET spectral_simplify AND TARGET make_demo_shape)
  add_test(NAME "input" COMMAND sh "${CMAKE_CURRENT_SOURCE_DIR}/input_test.sh" $<TARGET_FILE:spectral_simplify> "${shape}"
                                "${CMAKE_CURRENT_BINARY_DIR}/input")
  set_tests_properties("input" PROPERTIES LABELS examples FIXTURES_REQUIRED shape TIMEOUT ${timeout})
endif()

# With the other programs where they are built.
if(TARGET spectral_simplify AND TARGET make_demo_shape)
  add_test(NAME "brought-files"
           COMMAND sh "${CMAKE_CURRENT_SOURCE_DIR}/brought_files_test.sh" $<TARGET_FILE_DIR:spectral_simplify> "${shape}"
                   "${CMAKE_CURRENT_BINARY_DIR}/brought")
  set_tests_properties("brought-files" PROPERTIES LABELS examples FIXTURES_REQUIRED shape TIMEOUT ${timeout} COST 60)
endif()

if(TARGET spectral_simplify AND TARGET make_demo_shape)
  add_test(NAME "corrupted-files"
           COMMAND sh "${CMAKE_CURRENT_SOURCE_DIR}/corrupted_files.sh" $<TARGET_FILE:spectral_simplify> "${shape}"
                   "${CMAKE_CURRENT_BINARY_DIR}/corrupted")
  set_tests_properties("corrupted-files" PROPERTIES LABELS examples FIXTURES_REQUIRED shape TIMEOUT ${timeout})
endif()

find_program(SPECTRAL_BASH bash)
if(SPECTRAL_BASH AND TARGET shape_matching AND TARGET spectral_compare AND TARGET spectral_simplify AND
   TARGET spectral_distances_on_proxy AND TARGET make_demo_shape)
  add_test(NAME "commands" COMMAND "${SPECTRAL_BASH}" "${CMAKE_CURRENT_SOURCE_DIR}/commands_test.sh" "${PROJECT_SOURCE_DIR}"
                                   $<TARGET_FILE_DIR:spectral_simplify>)
  set_tests_properties("commands" PROPERTIES LABELS examples)
endif()

if(TARGET spectral_compare AND TARGET spectral_simplify AND TARGET make_demo_shape)
  add_test(NAME "compare" COMMAND sh "${CMAKE_CURRENT_SOURCE_DIR}/compare_test.sh" $<TARGET_FILE:spectral_compare>
                                  $<TARGET_FILE:spectral_simplify> "${shape}" "${CMAKE_CURRENT_BINARY_DIR}/compare")
  set_tests_properties("compare" PROPERTIES LABELS examples FIXTURES_REQUIRED shape TIMEOUT ${timeout} COST 140)
endif()

if(TARGET spectral_simplify AND TARGET make_demo_shape)
  add_test(NAME "pyfm-recipe" COMMAND sh "${CMAKE_CURRENT_SOURCE_DIR}/pyfm_recipe_test.sh" $<TARGET_FILE:spectral_simplify>
                                      "${CMAKE_CURRENT_SOURCE_DIR}/pyfm_recipe.py" "${shape}"
                                      "${CMAKE_CURRENT_BINARY_DIR}/pyfm")
  set_tests_properties("pyfm-recipe" PROPERTIES LABELS examples FIXTURES_REQUIRED shape SKIP_RETURN_CODE 77)
endif()

if(TARGET shape_matching AND TARGET make_demo_shape)
  add_test(NAME "matching" COMMAND sh "${CMAKE_CURRENT_SOURCE_DIR}/matching_test.sh" $<TARGET_FILE:shape_matching>
                                   $<TARGET_FILE:make_demo_shape> "${shape}" "${CMAKE_CURRENT_BINARY_DIR}/matching")
  set_tests_properties("matching" PROPERTIES LABELS examples FIXTURES_REQUIRED shape TIMEOUT ${timeout} COST 150)
endif()

if(TARGET spectral_distances_on_proxy AND TARGET make_demo_shape)
  add_test(NAME "distances" COMMAND sh "${CMAKE_CURRENT_SOURCE_DIR}/distances_test.sh"
                                    $<TARGET_FILE:spectral_distances_on_proxy> "${shape}"
                                    "${CMAKE_CURRENT_BINARY_DIR}/distances")
  set_tests_properties("distances" PROPERTIES LABELS examples FIXTURES_REQUIRED shape TIMEOUT ${timeout})
endif()

if(TARGET spectral_simplification AND TARGET spectral_simplify)
  function(spectral_add_python_test name)
    add_test(NAME "${name}" COMMAND ${CMAKE_COMMAND} -E env "PYTHONPATH=${PROJECT_BINARY_DIR}/examples/python"
                                    PYTHONDONTWRITEBYTECODE=1 "${SPECTRAL_PYTHON_EXECUTABLE}" ${ARGN})
    set_tests_properties("${name}" PROPERTIES LABELS python TIMEOUT ${timeout} COST 145) # long ones come first
  endfunction()
  spectral_add_python_test("python" "${CMAKE_CURRENT_SOURCE_DIR}/python_test.py" $<TARGET_FILE:spectral_simplify>)
  spectral_add_python_test("python-package" "${CMAKE_CURRENT_SOURCE_DIR}/python_package_test.py" $<TARGET_FILE:spectral_simplify>)
  set(adapters_test "${CMAKE_CURRENT_SOURCE_DIR}/python_adapters_test.py" "${PROJECT_SOURCE_DIR}/examples/python")
  spectral_add_python_test("python-adapters" ${adapters_test} Adapters)
  add_test(NAME "python-wheel" COMMAND sh "${CMAKE_CURRENT_SOURCE_DIR}/python_wheel_test.sh" "${SPECTRAL_PYTHON_EXECUTABLE}"
                                       $<TARGET_FILE:spectral_simplification> "${CMAKE_CURRENT_BINARY_DIR}/python-wheel")
  set_tests_properties("python-wheel" PROPERTIES LABELS python SKIP_RETURN_CODE 77 TIMEOUT ${timeout})
  execute_process(COMMAND "${SPECTRAL_PYTHON_EXECUTABLE}" -c "import matplotlib" RESULT_VARIABLE no_matplotlib
                  OUTPUT_QUIET ERROR_QUIET)
  if(no_matplotlib OR NOT TARGET spectral_examples_matching)
    message(STATUS "simplify_match_plot.py is not tested: Matplotlib or LEMON was not found.")
  else()
    spectral_add_python_test("python-script" ${adapters_test} Script)
  endif()
endif()
