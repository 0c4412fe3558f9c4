# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Where things are: the checkout and, when built with ROS, its build, devel and install space."""

import os
import pathlib
import shlex
import subprocess

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


def environment(prefix):
    """The environment of someone who sourced the setup file of a space, and nothing else."""
    wanted = ("HOME", "USER", "LC_ALL", "ROS_HOSTNAME", "ROS_HOME")
    clean = {name: os.environ[name] for name in wanted if name in os.environ}
    clean["PATH"] = "/usr/bin:/bin"
    command = f"source {shlex.quote(str(prefix / 'setup.bash'))} && env -0"
    sourced = subprocess.run(["bash", "-c", command], env=clean, capture_output=True, check=True)
    variables = sourced.stdout.decode().rstrip("\0").split("\0")
    return dict(variable.split("=", 1) for variable in variables)
