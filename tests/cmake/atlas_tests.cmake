# SPDX-License-Identifier: MIT
# How test programs are declared, found and registered.

# atlas_add_gtest(name sources... [LIBRARIES targets...]): a GoogleTest program with the flags of the project.
function(atlas_add_gtest name)
  cmake_parse_arguments(arg "" "" "LIBRARIES" ${ARGN})
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  target_compile_features(${name} PRIVATE cxx_std_17)
  target_compile_options(${name} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Werror -ffp-contract=off)
  target_link_libraries(${name} PRIVATE atlas_core ${arg_LIBRARIES} GTest::gtest_main)
endfunction()

# Remembers the programs of a folder: lines "kind<TAB>folder<TAB>name<TAB>path".
function(atlas_collect_programs folder)
  get_property(targets DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(NOT type STREQUAL EXECUTABLE)
      continue()
    endif()
    if(target MATCHES "^unit_|_test$")
      set(kind gtest)
    elseif(target MATCHES "^bench_")
      set(kind bench)
    else()
      continue()
    endif()
    set_property(GLOBAL APPEND_STRING PROPERTY ATLAS_MANIFEST "${kind}\t${folder}\t${target}\t$<TARGET_FILE:${target}>\n")
    if(kind STREQUAL gtest)
      set_property(GLOBAL APPEND PROPERTY ATLAS_GTESTS ${target})
    endif()
  endforeach()
endfunction()

function(atlas_write_manifest)
  get_property(manifest GLOBAL PROPERTY ATLAS_MANIFEST)
  file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/tests.manifest CONTENT "${manifest}")
endfunction()

# `catkin_make run_tests`: the same programs, and the launch tests of ros/ and replay/ that are no programs' helpers.
function(atlas_register_with_catkin)
  get_property(programs GLOBAL PROPERTY ATLAS_GTESTS)
  foreach(target IN LISTS programs)
    set(result ${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}/gtest-${target}.xml)
    catkin_run_tests_target(gtest ${target} gtest-${target}.xml
                            COMMAND "$<TARGET_FILE:${target}> --gtest_output=xml:${result}" DEPENDENCIES ${target})
  endforeach()
  find_package(rostest REQUIRED)
  file(GLOB launch_tests CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/ros/*.test ${CMAKE_CURRENT_SOURCE_DIR}/replay/*.test)
  foreach(launch_test IN LISTS launch_tests)
    file(RELATIVE_PATH launch_test ${CMAKE_CURRENT_SOURCE_DIR} ${launch_test})
    add_rostest(${launch_test})
  endforeach()
endfunction()
