# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Where things are: the checkout and, when built with ROS, its build, devel and install space."""

import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]

COMPONENTS = ("plane_fit", "icap", "frontend_node", "backend_node", "planecloud_msgs", "rosbags")


def space(name):
    """The folder of PLANECLOUD_SLAM_<name>_SPACE, or None in a build without ROS."""
    value = os.environ.get(f"PLANECLOUD_SLAM_{name.upper()}_SPACE")
    return pathlib.Path(value) if value else None


def files(*patterns, folders=COMPONENTS + ("test", "scripts", "launch", "config", ".ci")):
    """Files of the package by name, sorted; hidden folders and build results are not looked at."""
    found = set()
    for folder in folders:
        for pattern in patterns:
            found.update(path for path in (ROOT / folder).rglob(pattern) if path.is_file())
    return sorted(found)


def relative(path):
    return str(path.relative_to(ROOT))
