# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Who may know whom: the includes of every part keep to the table of the design."""

import re
import unittest

from layout import COMPONENTS, ROOT, files, relative

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
ROS_ONLY_BLOCK = re.compile(
    r"if\(NOT PLANECLOUD_SLAM_CORE_ONLY\)(.*?)^endif\(\)", re.DOTALL | re.MULTILINE)

# First match wins.
LIBRARIES = (
    ("Eigen", re.compile(r"Eigen/|unsupported/Eigen/")),
    ("OpenCV", re.compile(r"opencv2/")),
    ("Ceres", re.compile(r"ceres/")),
    ("nanoflann", re.compile(r"nanoflann\.hpp")),
    ("SIMD", re.compile(r"hwy/")),
    ("SQLite", re.compile(r"sqlite3\.h")),
    ("YAML", re.compile(r"yaml-cpp/")),
    ("JSON", re.compile(r"nlohmann/")),
    ("Boost", re.compile(r"boost/")),
    ("PCL", re.compile(r"pcl")),
    ("rviz", re.compile(r"rviz/")),
    ("image_transport", re.compile(r"image_transport/|cv_bridge/|openni")),
    ("gtest", re.compile(r"gtest/|gmock/|benchmark/")),
    ("ROS", re.compile(
        r"ros/|rosbag/|topic_tools/|tf2\w*/|message_filters/|diagnostic_updater/|\w+_msgs/[A-Z]|std_srvs/|"
        r"dynamic_reconfigure/|planecloud_slam/[A-Z]")),
    ("std", re.compile(r"[a-z_0-9]+$|[a-z_0-9]+\.h$|(sys|linux|arpa|netinet)/\w+\.h$|cxxabi")),
)

CORE = {"std", "Eigen"}
ALLOWED = {  # part: (libraries, components)
    "plane_fit": (CORE | {"SIMD"}, {"plane_fit"}),
    "icap": (CORE | {"nanoflann", "SIMD"}, {"plane_fit", "icap"}),
    "frontend core": (CORE | {"OpenCV", "SIMD"}, {"plane_fit", "frontend_node"}),
    "backend core": (CORE | {"Ceres", "SQLite", "PCL", "OpenCV"},
                     {"plane_fit", "icap", "backend_node"}),
    "planecloud_msgs": (CORE | {"ROS", "Boost"}, {"plane_fit", "planecloud_msgs"}),
    "frontend node": (CORE | {"OpenCV", "ROS", "Boost", "image_transport", "PCL"},
                      {"plane_fit", "frontend_node", "planecloud_msgs"}),
    "backend node": (CORE | {"OpenCV", "ROS", "Boost", "PCL"},
                     {"plane_fit", "icap", "backend_node", "planecloud_msgs"}),
    "rosbags": (CORE | {"OpenCV", "ROS", "Boost", "YAML", "JSON", "PCL", "image_transport"},
                set(COMPONENTS)),
}


def includes(path):
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


def component_of(include):
    match = re.match(r"planecloud_slam/(\w+)/", include)
    return match.group(1) if match and match.group(1) in COMPONENTS else None


def library_of(include):
    return next((name for name, pattern in LIBRARIES if pattern.match(include)), None)


def core_files(folder):
    """What the build without ROS compiles of a folder: its sources and all they include of it."""
    cmake = ROS_ONLY_BLOCK.sub("", (ROOT / folder / "CMakeLists.txt").read_text(encoding="utf-8"))
    pending = [ROOT / folder / name for name in re.findall(r"\b\w+\.(?:cpp|h)\b", cmake)]
    found = set()
    while pending:
        path = pending.pop()
        if path in found or not path.exists():
            continue
        found.add(path)
        pending += [ROOT / folder / include.split("/")[-1] for include in includes(path)
                    if component_of(include) == folder]
        pending.append(path.with_suffix(".h"))
    return found


def parts():
    """Every source file of the components with its part."""
    sides = {"frontend_node": "frontend", "backend_node": "backend"}
    for folder in COMPONENTS:
        core = core_files(folder) if folder in sides else set()
        for path in files("*.h", "*.cpp", folders=(folder,)):
            if folder in sides:
                yield path, f"{sides[folder]} {'core' if path in core else 'node'}"
            else:
                yield path, folder


class Layers(unittest.TestCase):
    def violations(self, is_wrong):
        return sorted(f"{relative(path)} ({part}) includes {include}"
                      for path, part in parts() for include in includes(path)
                      if is_wrong(path, part, include))

    def test_every_part_includes_only_the_components_it_may_know(self):
        self.assertEqual([], self.violations(
            lambda path, part, include: component_of(include) is not None
            and component_of(include) not in ALLOWED[part][1]))

    def test_every_part_includes_only_the_libraries_it_may_know(self):
        self.assertEqual([], self.violations(
            lambda path, part, include: component_of(include) is None
            and library_of(include) not in ALLOWED[part][0]))

    def test_ceres_stays_in_the_sources_of_the_graph(self):
        self.assertEqual([], self.violations(
            lambda path, part, include: library_of(include) == "Ceres" and path.suffix != ".cpp"))

    def test_one_file_knows_how_maps_are_stored_one_how_they_are_exported_and_one_how_jpeg_is_read(self):
        homes = {"SQLite": "map_store.cpp", "PCL": "map_export.cpp",
                 "OpenCV": "keyframe_colors.cpp"}
        self.assertEqual([], self.violations(
            lambda path, part, include: part == "backend core"
            and path.name != homes.get(library_of(include), path.name)))

    def test_own_headers_are_included_by_their_installed_path(self):
        own = {path.name for path in files("*.h", folders=COMPONENTS)}
        self.assertEqual([], self.violations(
            lambda path, part, include: "/" not in include and include in own))

    def test_the_core_of_both_sides_is_found(self):
        for folder in ("frontend_node", "backend_node"):
            self.assertGreater(len(core_files(folder)), 10, folder)


if __name__ == "__main__":
    unittest.main()
