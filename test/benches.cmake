# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Programs that measure: speed against peers in the same run, accuracy, cost against size. Built on
# request. Peers that are not installed are skipped.

# planecloud_slam_add_bench(<name> SOURCES ... LINK ...): target planecloud_slam_<name> of <name>.cpp
# and the sources named.
function(planecloud_slam_add_bench name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  set(target ${PROJECT_NAME}_${name})
  add_executable(${target} EXCLUDE_FROM_ALL ${name}.cpp ${ARG_SOURCES})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${name})
  target_link_libraries(${target} ${ARG_LINK})
endfunction()

# --- plane extraction
add_library(${PROJECT_NAME}_plane_fit_peers STATIC EXCLUDE_FROM_ALL
  peer_paper_fitter.cpp peer_pcl_planes.cpp peer_rgbd_plane.cpp)
target_link_libraries(${PROJECT_NAME}_plane_fit_peers ${PROJECT_NAME}_plane_fit)
if(TARGET opencv_rgbd)
  target_compile_definitions(${PROJECT_NAME}_plane_fit_peers PRIVATE PLANECLOUD_SLAM_HAVE_RGBD)
  target_link_libraries(${PROJECT_NAME}_plane_fit_peers opencv_rgbd)
endif()
find_path(PLANECLOUD_SLAM_PCL_INCLUDE pcl/point_types.h PATH_SUFFIXES pcl-1.13 pcl-1.12 pcl-1.10)
find_library(PLANECLOUD_SLAM_PCL_SEGMENTATION pcl_segmentation)
if(PLANECLOUD_SLAM_PCL_INCLUDE AND PLANECLOUD_SLAM_PCL_SEGMENTATION)
  set_source_files_properties(peer_pcl_planes.cpp PROPERTIES
    COMPILE_DEFINITIONS PLANECLOUD_SLAM_HAVE_PCL
    INCLUDE_DIRECTORIES ${PLANECLOUD_SLAM_PCL_INCLUDE} SKIP_UNITY_BUILD_INCLUSION ON)
  target_link_libraries(${PROJECT_NAME}_plane_fit_peers
    ${PLANECLOUD_SLAM_PCL_SEGMENTATION} pcl_features pcl_search pcl_kdtree pcl_common)
endif()
planecloud_slam_add_bench(bench_plane_fit
  LINK ${PROJECT_NAME}_plane_fit_peers opencv_core opencv_imgcodecs)

# --- depth codecs
add_library(${PROJECT_NAME}_depth_codec_peers STATIC EXCLUDE_FROM_ALL
  peer_draco.cpp peer_image_codecs.cpp)
target_link_libraries(${PROJECT_NAME}_depth_codec_peers
  ${PROJECT_NAME}_plane_fit opencv_core opencv_imgcodecs)
find_library(DRACO_LIBRARY draco)
if(DRACO_LIBRARY)
  target_compile_definitions(${PROJECT_NAME}_depth_codec_peers PRIVATE PLANECLOUD_SLAM_HAVE_DRACO)
  target_link_libraries(${PROJECT_NAME}_depth_codec_peers ${DRACO_LIBRARY})
endif()
planecloud_slam_add_bench(bench_plane_cloud_codec LINK ${PROJECT_NAME}_depth_codec_peers)
planecloud_slam_add_bench(bench_figures
  LINK ${PROJECT_NAME}_compression ${PROJECT_NAME}_open_recordings ${PROJECT_NAME}_command_line
    ${PROJECT_NAME}_depth_codec_peers ${PROJECT_NAME}_plane_fit_peers)
planecloud_slam_add_bench(bench_keyframe_budgets
  SOURCES frame_set.cpp LINK ${PROJECT_NAME}_frontend_core ${PROJECT_NAME}_recordings)

# --- alignment: PCL's libraries are looked for by name, see backend_node/CMakeLists.txt
planecloud_slam_add_bench(bench_icap SOURCES icap_pairs.cpp icap_peers.cpp
  LINK ${PROJECT_NAME}_frontend_core ${PROJECT_NAME}_icap ${PROJECT_NAME}_recordings)
find_package(PCL REQUIRED COMPONENTS common)
foreach(part common features filters kdtree registration search)
  find_library(PLANECLOUD_SLAM_PCL_${part} pcl_${part})
  target_link_libraries(${PROJECT_NAME}_bench_icap ${PLANECLOUD_SLAM_PCL_${part}})
endforeach()
target_include_directories(${PROJECT_NAME}_bench_icap SYSTEM PRIVATE ${PCL_INCLUDE_DIRS})
planecloud_slam_add_bench(bench_aligned_pair
  LINK ${PROJECT_NAME}_compression ${PROJECT_NAME}_icap ${PROJECT_NAME}_open_recordings
    ${PROJECT_NAME}_command_line)

# --- tracking
planecloud_slam_add_bench(bench_tracking
  SOURCES bench_tracking_ablation.cpp bench_tracking_information.cpp bench_tracking_peer.cpp
    bench_tracking_run.cpp bench_tracking_trials.cpp frame_set.cpp tracking_trial_judge.cpp
    tracking_trials.cpp
  LINK ${PROJECT_NAME}_replay_run opencv_core opencv_rgbd)

# --- backend
planecloud_slam_add_bench(bench_backend
  LINK ${PROJECT_NAME}_backend_core ${PROJECT_NAME}_recordings)
planecloud_slam_add_bench(bench_backend_closures LINK ${PROJECT_NAME}_backend_core)
planecloud_slam_add_bench(bench_backend_symmetry
  LINK ${PROJECT_NAME}_backend_core ${PROJECT_NAME}_replay_run)
