#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Three robots with a backend each, all of which hear all frontends: each joins the three maps, and
the maps agree."""

import pathlib
import tempfile
import unittest

import numpy
import rospy
import rostest
from harness import Node, Watch, wait_for
from planecloud_slam.srv import ExportMap

ROBOTS = ("robot1", "robot2", "robot3")
DISTANCE = 6.0  # of each robot [m]
APART = 2.4  # where one starts after the other [m]


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
    """Of two sets of positions [m], once the one is moved rigidly onto the other."""
    keys = sorted(a)
    left, right = (numpy.array([side[key] for key in keys]) for side in (a, b))
    left, right = left - left.mean(axis=0), right - right.mean(axis=0)
    u, _, v = numpy.linalg.svd(left.T @ right)
    flip = numpy.diag([1.0, 1.0, numpy.sign(numpy.linalg.det(u @ v))])
    return numpy.abs(left @ u @ flip @ v - right).max()


class Decentralised(unittest.TestCase):
    def setUp(self):
        self.backends = [Watch(f"/{robot}/backend") for robot in ROBOTS]
        self.robots = []

    def tearDown(self):
        for robot in self.robots:
            robot.stop()

    def test_the_maps_agree(self):
        for backend in self.backends:
            wait_for(lambda watch=backend: watch.values, f"{backend.name} runs")
        for i, robot in enumerate(ROBOTS):
            topics = [f"{topic}:=/{robot}/{topic}" for topic in ("keyframes", "keyframe_acks")]
            hints = {"hint_robot": ROBOTS[0]} if i else {}
            # robot1 drives the whole way, the others a part each: they meet through it alone.
            self.robots.append(Node("synthetic_robot_node", f"synthetic_{robot}", topics,
                                    is_silent=True, robot=robot, seed=i + 1, start=APART * i,
                                    distance=DISTANCE * (2 if i == 0 else 1), **hints))
        count = int(2 * DISTANCE / 0.3 + 1e-6) + 1 + 2 * (int(DISTANCE / 0.3 + 1e-6) + 1)
        maps = []
        for robot, backend in zip(ROBOTS, self.backends):
            backend.wait_for_value("keyframes", count, timeout=90)
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
