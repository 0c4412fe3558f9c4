# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
#
# libFuzzer targets with a bounded run as a test: the decoder in the core-only build, messages in
# the build with ROS. They and what they call are compiled by clang, whatever compiles the rest.
# Without clang's fuzzer the committed corpus is replayed.
find_program(PLANECLOUD_SLAM_CLANG NAMES clang++ clang++-14)
# Tracing every comparison takes most of the time: without it three times as many inputs are tried.
set(PLANECLOUD_SLAM_FUZZ_FLAGS -std=c++17 -O2 -g1 -ffp-contract=off
  -fno-sanitize-coverage=trace-cmp
  -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined)
if(PLANECLOUD_SLAM_CLANG AND NOT DEFINED PLANECLOUD_SLAM_CAN_FUZZ)
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/fuzzer_probe.cpp
    "#include <cstddef>\nextern \"C\" int LLVMFuzzerTestOneInput(const char*, std::size_t) { return 0; }\n")
  execute_process(
    COMMAND ${PLANECLOUD_SLAM_CLANG} ${PLANECLOUD_SLAM_FUZZ_FLAGS}
      ${CMAKE_CURRENT_BINARY_DIR}/fuzzer_probe.cpp -o ${CMAKE_CURRENT_BINARY_DIR}/fuzzer_probe
    RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
  if(result EQUAL 0)
    set(PLANECLOUD_SLAM_CAN_FUZZ ON CACHE INTERNAL "clang links libFuzzer")
  else()
    set(PLANECLOUD_SLAM_CAN_FUZZ OFF CACHE INTERNAL "clang links libFuzzer")
    message(STATUS "No libFuzzer (clang, libclang-rt-14-dev): the fuzz targets replay their corpus")
  endif()
endif()

# planecloud_slam_add_fuzz_target(<name> SOURCES ... INCLUDES ... LIBRARIES ...): fuzz/<name>.cpp
# with the sources named; its corpus is fuzz/corpus_<name>.
function(planecloud_slam_add_fuzz_target name)
  cmake_parse_arguments(ARG "" "" "SOURCES;INCLUDES;LIBRARIES" ${ARGN})
  set(program ${CMAKE_CURRENT_BINARY_DIR}/fuzz_${name})
  set(sources ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/fuzz_${name}.cpp ${ARG_SOURCES})
  if(PLANECLOUD_SLAM_CAN_FUZZ)
    list(TRANSFORM ARG_INCLUDES PREPEND -isystem)
    # All in one file: headers are read once.
    set(unity ${CMAKE_CURRENT_BINARY_DIR}/fuzz_${name}_unity.cpp)
    list(TRANSFORM sources PREPEND "#include \"" OUTPUT_VARIABLE includes)
    list(TRANSFORM includes APPEND "\"\n")
    list(JOIN includes "" includes)
    file(GENERATE OUTPUT ${unity} CONTENT "${includes}")
    file(GLOB headers ${PROJECT_SOURCE_DIR}/plane_fit/*.h ${PROJECT_SOURCE_DIR}/planecloud_msgs/*.h)
    add_custom_command(OUTPUT ${program}
      COMMAND ${PLANECLOUD_SLAM_CLANG} ${PLANECLOUD_SLAM_FUZZ_FLAGS}
        -I${PLANECLOUD_SLAM_DEVEL_INCLUDE} ${ARG_INCLUDES} ${unity} ${ARG_LIBRARIES} -o ${program}
      DEPENDS ${unity} ${sources} ${headers} VERBATIM)
    add_custom_target(${PROJECT_NAME}_fuzz_${name} ALL DEPENDS ${program})
  else()
    add_executable(${PROJECT_NAME}_fuzz_${name}
      ${sources} ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/replay_corpus.cpp)
    set_target_properties(${PROJECT_NAME}_fuzz_${name} PROPERTIES OUTPUT_NAME fuzz_${name}
      RUNTIME_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
    target_include_directories(${PROJECT_NAME}_fuzz_${name} PRIVATE
      ${PLANECLOUD_SLAM_DEVEL_INCLUDE} ${ARG_INCLUDES})
    target_link_libraries(${PROJECT_NAME}_fuzz_${name} ${ARG_LIBRARIES})
  endif()
endfunction()

get_target_property(PLANECLOUD_SLAM_FUZZED ${PROJECT_NAME}_plane_fit SOURCES)
list(FILTER PLANECLOUD_SLAM_FUZZED EXCLUDE REGEX "simd|appearance|option_values")
list(TRANSFORM PLANECLOUD_SLAM_FUZZED PREPEND ${PROJECT_SOURCE_DIR}/plane_fit/)
set(PLANECLOUD_SLAM_FUZZ_RUN ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/run_fuzz_target.py)
if(PLANECLOUD_SLAM_CORE_ONLY)
  planecloud_slam_add_fuzz_target(plane_cloud_decoder
    SOURCES ${PLANECLOUD_SLAM_FUZZED} INCLUDES ${EIGEN3_INCLUDE_DIRS})
  add_test(NAME fuzz_plane_cloud_decoder COMMAND ${PLANECLOUD_SLAM_FUZZ_RUN}
    ${CMAKE_CURRENT_BINARY_DIR}/fuzz_plane_cloud_decoder
    ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus_plane_cloud_decoder
    ${CMAKE_CURRENT_BINARY_DIR}/fuzz_plane_cloud_decoder.xml)
else()
  set(PLANECLOUD_SLAM_ROS_INCLUDES ${roscpp_INCLUDE_DIRS})
  list(REMOVE_ITEM PLANECLOUD_SLAM_ROS_INCLUDES /usr/include)  # the compiler's own, last of all
  foreach(source conversions plane_cloud_conversions pose_conversions robot_name)
    list(APPEND PLANECLOUD_SLAM_FUZZED ${PROJECT_SOURCE_DIR}/planecloud_msgs/${source}.cpp)
  endforeach()
  planecloud_slam_add_fuzz_target(keyframe_message
    SOURCES ${PLANECLOUD_SLAM_FUZZED}
    INCLUDES ${EIGEN3_INCLUDE_DIRS} ${PLANECLOUD_SLAM_ROS_INCLUDES}
    LIBRARIES -lroscpp_serialization -lrostime -lcpp_common)
  add_dependencies(${PROJECT_NAME}_fuzz_keyframe_message ${PROJECT_NAME}_generate_messages_cpp)
  catkin_run_tests_target(fuzz keyframe_message fuzz_keyframe_message.xml
    COMMAND "${PLANECLOUD_SLAM_FUZZ_RUN} ${CMAKE_CURRENT_BINARY_DIR}/fuzz_keyframe_message ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus_keyframe_message ${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}/fuzz_keyframe_message.xml"
    DEPENDENCIES ${PROJECT_NAME}_fuzz_keyframe_message)
endif()
