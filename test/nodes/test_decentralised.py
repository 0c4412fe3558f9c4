#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Three robots with a backend each, all of which hear all frontends: each joins the three maps, and
the maps agree."""

import itertools
import math
import pathlib
import tempfile
import unittest

import rospy
import rostest
from harness import Node, Watch, wait_for
from planecloud_slam.srv import ExportMap

ROBOTS = ("robot1", "robot2", "robot3")
DISTANCE = 3.6  # of each robot, the first one twice [m]
SPACING = 0.3  # of keyframes [m]
APART = 1.5  # where one starts after the other [m]


def read_positions(folder):
    """Keyframe positions by robot and stamp."""
    positions = {}
    for path in pathlib.Path(folder).glob("*_keyframes.txt"):
        for line in path.read_text(encoding="utf-8").splitlines():
            if line.startswith("#"):
                continue
            numbers = [float(word) for word in line.split()]
            positions[path.name, numbers[0]] = numbers[1:4]
    return positions


def largest_difference(a, b):
    """Of the distances between keyframes in two maps [m]: each has a frame of its own."""
    return max(abs(math.dist(a[first], a[second]) - math.dist(b[first], b[second]))
               for first, second in itertools.combinations(sorted(a), 2))


def keyframes_in(distance):
    return int(distance / SPACING + 1e-6) + 1


class Decentralised(unittest.TestCase):
    def setUp(self):
        self.backends = [Watch(f"/{robot}/backend") for robot in ROBOTS]
        self.robots = []

    def tearDown(self):
        for robot in self.robots:
            robot.stop()

    def start_robot(self, i, **parameters):
        robot = ROBOTS[i]
        topics = [f"{topic}:=/{robot}/{topic}" for topic in ("keyframes", "keyframe_acks")]
        self.robots.append(Node("synthetic_robot_node", f"synthetic_{robot}", topics,
                                is_silent=True, robot=robot, seed=i + 1, **parameters))

    def wait_for_keyframes(self, count):
        for backend in self.backends:
            backend.wait_for_value("keyframes", count, timeout=120)

    def test_the_maps_agree(self):
        for backend in self.backends:
            wait_for(lambda watch=backend: watch.values, f"{backend.name} runs")
        # robot1 drives the whole way, the others a part each: they meet through it alone.
        self.start_robot(0, distance=2 * DISTANCE)
        count = keyframes_in(2 * DISTANCE)
        self.wait_for_keyframes(count)
        for i in (1, 2):
            self.start_robot(i, start=APART * i, distance=DISTANCE, hint_robot=ROBOTS[0])
            count += keyframes_in(DISTANCE)
        self.wait_for_keyframes(count)
        maps = []
        for robot, backend in zip(ROBOTS, self.backends):
            backend.wait_for_value("components", 1, timeout=30)
            self.assertTrue(backend.call("optimize").success)
            with tempfile.TemporaryDirectory() as folder:
                export = rospy.ServiceProxy(f"/{robot}/backend/export", ExportMap)
                self.assertTrue(export(folder).success)
                maps.append(read_positions(folder))
        self.assertEqual(count, len(maps[0]))
        for other in maps[1:]:
            self.assertEqual(set(maps[0]), set(other))
            self.assertLess(largest_difference(maps[0], other), 0.02)


if __name__ == "__main__":
    rospy.init_node("test_decentralised")
    rostest.rosrun("planecloud_slam", "decentralised", "__main__")
