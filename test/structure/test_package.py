# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""package.xml, its table of Debian packages, lint, and the launch files."""

import re
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

from layout import ROOT, environment, files, relative, space

MAX_LAUNCH_LINES = 40


def dependency_keys():
    package = ElementTree.parse(ROOT / "package.xml").getroot()
    return {element.text for element in package if element.tag.endswith("depend")}


def debian_table():
    lines = (ROOT / "scripts" / "debian_packages").read_text(encoding="utf-8").splitlines()
    rows = (line.split() for line in lines if line and not line.startswith("#"))
    return {row[0]: row[1:] for row in rows}


class Package(unittest.TestCase):
    def test_every_dependency_has_its_debian_packages(self):
        table = debian_table()
        self.assertEqual([], sorted(key for key in dependency_keys() if not table.get(key)))

    def test_the_table_names_no_more_than_package_xml(self):
        self.assertEqual([], sorted(set(debian_table()) - dependency_keys()))

    def test_every_catkin_component_is_a_dependency(self):
        cmake = (ROOT / "planecloud_msgs" / "catkin.cmake").read_text(encoding="utf-8")
        components = re.search(r"set\(PLANECLOUD_SLAM_CATKIN_DEPENDS(.*?)\)", cmake, re.DOTALL)
        self.assertEqual([], sorted(set(components.group(1).split()) - dependency_keys()))

    def test_catkin_lint_finds_nothing(self):
        if shutil.which("catkin_lint") is None:
            self.skipTest("catkin_lint is not installed")
        lint = subprocess.run(
            ["catkin_lint", "--offline", "--strict", "-W1", "--text",
             "--ignore", "uninstalled_script",  # scripts/ serves the checkout
             "--ignore", "uninstalled_target",  # benches; test_spaces.py sees what is installed
             str(ROOT)], text=True, capture_output=True, check=False)
        self.assertEqual(0, lint.returncode, lint.stdout + lint.stderr)

    def test_versions_agree(self):
        version = ElementTree.parse(ROOT / "package.xml").getroot().findtext("version")
        self.assertIn(f"VERSION {version} ", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
        self.assertIn(f"{version} ", (ROOT / "CHANGELOG.rst").read_text(encoding="utf-8"))


class LaunchFiles(unittest.TestCase):
    def test_are_short(self):
        launches = files("*.launch", folders=("launch",))
        self.assertTrue(launches)
        for path in launches:
            with self.subTest(relative(path)):
                lines = path.read_text(encoding="utf-8").splitlines()
                self.assertLess(len(lines), MAX_LAUNCH_LINES)

    def test_are_understood_by_roslaunch(self):
        if space("devel") is None:
            self.skipTest("built without ROS")
        devel = environment(space("devel"))
        for path in files("*.launch", folders=("launch",)):
            with self.subTest(relative(path)):
                arguments = [f"{name}:=x" for name in required_arguments(path)]
                check = subprocess.run(["roslaunch", "--nodes", str(path), *arguments], env=devel,
                                       text=True, capture_output=True, check=False)
                self.assertEqual(0, check.returncode, check.stderr)
                self.assertTrue(check.stdout.split(), "starts no node")

    def test_more_has_the_last_word(self):
        if space("devel") is None:
            self.skipTest("built without ROS")
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as more:
            more.write("odom_frame: another\n")
            more.flush()
            for node in ("frontend", "backend"):
                with self.subTest(node):
                    dump = subprocess.run(
                        ["roslaunch", "--dump-params", str(ROOT / "launch" / f"{node}.launch"),
                         f"more:={more.name}"],
                        env=environment(space("devel")), text=True, capture_output=True, check=True)
                    self.assertIn(f"/{node}/odom_frame: another", dump.stdout)


def required_arguments(path):
    """Arguments without default or value at the top of a launch file."""
    root = ElementTree.parse(path).getroot()
    return [argument.get("name") for argument in root.findall("arg")
            if argument.get("default") is None and argument.get("value") is None]


if __name__ == "__main__":
    unittest.main()
