# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the devel and the install space offer to others, and what the two nodes are linked with."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from layout import ROOT, environment, files, space

MESSAGES = [path.stem for path in files("*.msg", folders=("planecloud_msgs",))]
TOOLS = ("make_hallway_bag", "sequence_to_bag", "replay", "compress", "evaluate_trajectory")
FORBIDDEN = {  # program: libraries it must not need
    "frontend_node": ("ceres", "sqlite", "icap"),
    "backend_node": ("image_transport", "cv_bridge", "OpenNI"),
}


def needed(program):
    dynamic = subprocess.run(["readelf", "-d", str(program)], text=True, capture_output=True,
                             check=True).stdout
    return re.findall(r"\(NEEDED\).*\[(.+)\]", dynamic)


def install():
    """Installs what is built, without building."""
    script = space("build") / "cmake_install.cmake"
    subprocess.run(["cmake", "-P", str(script)], check=True, stdout=subprocess.DEVNULL)


@unittest.skipIf(space("devel") is None, "built without ROS")
class Spaces(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        install()
        cls.environments = {name: environment(space(name)) for name in ("devel", "install")}

    def run_in(self, name, *command, **options):
        result = subprocess.run(command, env=self.environments[name], text=True,
                                capture_output=True, check=False, **options)
        self.assertEqual(0, result.returncode, f"{command}: {result.stdout}{result.stderr}")
        return result.stdout

    def test_rosmsg_shows_every_message(self):
        for name in self.environments:
            with self.subTest(name):
                for message in MESSAGES:
                    self.assertTrue(self.run_in(name, "rosmsg", "show", f"planecloud_slam/{message}"))

    def test_rossrv_shows_the_service(self):
        for name in self.environments:
            with self.subTest(name):
                self.assertIn("string directory",
                              self.run_in(name, "rossrv", "show", "planecloud_slam/ExportMap"))

    def test_rosrun_finds_every_program_and_tools_help(self):
        for name in self.environments:
            with self.subTest(name):
                for tool in TOOLS:
                    self.run_in(name, "rosrun", "planecloud_slam", tool, "--help", timeout=60)
                for node in FORBIDDEN:
                    self.run_in(name, "rosrun", "--prefix", "test -x", "planecloud_slam", node)

    def test_launch_files_are_found(self):
        for name in self.environments:
            with self.subTest(name):
                self.run_in(name, "roslaunch", "--files", "planecloud_slam", "backend.launch")

    def test_no_installed_header_is_a_link_into_the_source(self):
        headers = space("install") / "include" / "planecloud_slam"
        self.assertTrue((headers / "plane_fit" / "camera.h").is_file())
        links = [str(path) for path in headers.rglob("*") if path.is_symlink()]
        self.assertEqual([], links)
        self.assertEqual([], [str(path) for path in headers.rglob("*.cpp")])

    def test_a_package_outside_the_tree_uses_core_and_messages(self):
        for name in self.environments:
            with self.subTest(name):
                with tempfile.TemporaryDirectory() as build:
                    self.run_in(name, "cmake", str(ROOT / "test" / "consumer_package"),
                                "-DPYTHON_EXECUTABLE=/usr/bin/python3",
                                "-DPython3_EXECUTABLE=/usr/bin/python3", cwd=build)
                    self.run_in(name, "cmake", "--build", build)
                    program = next(path for path in pathlib.Path(build).rglob("planecloud_consumer")
                                   if path.is_file() and os.access(path, os.X_OK))
                    self.assertIn("1 plane received", self.run_in(name, str(program)))

    def test_the_nodes_need_nothing_of_the_other_side(self):
        for program, forbidden in FORBIDDEN.items():
            libraries = needed(space("devel") / "lib" / "planecloud_slam" / program)
            own = [library for library in libraries if library.startswith("libplanecloud_slam_")]
            for library in own:
                libraries += needed(space("devel") / "lib" / library)
            wrong = [library for library in libraries for word in forbidden if word in library]
            self.assertEqual([], wrong, program)
            self.assertGreater(len(libraries), 3)


if __name__ == "__main__":
    unittest.main()
