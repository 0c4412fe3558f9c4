# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Included at root scope by the root CMakeLists.txt: catkin's macros set variables there and must
# come before the first target.

set(PLANECLOUD_SLAM_CATKIN_DEPENDS
  diagnostic_msgs dynamic_reconfigure geometry_msgs image_transport message_filters nav_msgs
  pcl_conversions rosbag
  roscpp sensor_msgs std_msgs std_srvs tf2_msgs tf2_ros topic_tools
  visualization_msgs)
find_package(catkin REQUIRED COMPONENTS message_generation ${PLANECLOUD_SLAM_CATKIN_DEPENDS})
include_directories(SYSTEM ${catkin_INCLUDE_DIRS})

catkin_destinations()

# genmsg installs the whole of devel/include/planecloud_slam, the links to the component folders
# included; installed links would lead back into the source. They go before (a folder from an
# earlier installation stands in a link's way) and after, then the root
# CMakeLists.txt installs the headers.
#catkin_lint: ignore env_var
macro(planecloud_slam_uninstall_component_folders)
  foreach(component IN LISTS PLANECLOUD_SLAM_COMPONENTS)
    install(CODE "file(REMOVE_RECURSE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CATKIN_PACKAGE_INCLUDE_DESTINATION}/${component}\")")
  endforeach()
endmacro()

# rosmsg and rossrv look in msg/ and srv/ of the package or of share/planecloud_slam alone.
add_message_files(DIRECTORY msg BASE_DIR ${PROJECT_SOURCE_DIR}/planecloud_msgs/msg
  FILES
    KeyframeAck.msg
    KeyframeReference.msg
    KeyframeSession.msg
    PlaneCloud.msg
    PlaneCloudKeyframe.msg
    RelativePoseEdge.msg)
add_service_files(DIRECTORY planecloud_msgs/srv NOINSTALL FILES ExportMap.srv)
install(FILES planecloud_msgs/srv/ExportMap.srv
  DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/srv)
foreach(kind msg srv)
  file(MAKE_DIRECTORY ${CATKIN_DEVEL_PREFIX}/share/${PROJECT_NAME})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/planecloud_msgs/${kind}
       ${CATKIN_DEVEL_PREFIX}/share/${PROJECT_NAME}/${kind} SYMBOLIC)
endforeach()

# What can be changed while the frontend runs, a file for each part.
generate_dynamic_reconfigure_options(
  config/reconfigure/Codec.cfg
  config/reconfigure/Keyframe.cfg
  config/reconfigure/Link.cfg
  config/reconfigure/PlaneFit.cfg
  config/reconfigure/Texture.cfg)

planecloud_slam_uninstall_component_folders()
generate_messages(DEPENDENCIES std_msgs)
planecloud_slam_uninstall_component_folders()

catkin_package(
  LIBRARIES ${PROJECT_NAME}_conversions ${PROJECT_NAME}_icap ${PROJECT_NAME}_plane_fit
  CATKIN_DEPENDS
    diagnostic_msgs dynamic_reconfigure geometry_msgs message_runtime nav_msgs roscpp sensor_msgs std_msgs std_srvs
    tf2_msgs visualization_msgs
  DEPENDS EIGEN3)
