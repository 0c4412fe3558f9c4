#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Robots that come late, start again, lose their way or fall silent lose no keyframe, and what they
saw together joins their maps."""

import os
import signal
import time
import unittest

import rospy
import rostest
from harness import Node, wait_for

# How long a robot is silent [s].
SILENCE = float(os.environ.get("PLANECLOUD_SLAM_SILENCE", "60"))
ROUND = 25.9  # of the hall [m]
SPACING = 0.3  # of keyframes [m]


def keyframes_in(distance):
    return int(distance / SPACING + 1e-6) + 1


class Robots(unittest.TestCase):
    def setUp(self):
        self.name = self.id().rsplit(".", 1)[-1]
        self.nodes = []

    def tearDown(self):
        for node in reversed(self.nodes):
            node.stop()

    def start_backend(self, robots, **parameters):
        name_spaces = " ".join(f"/{self.name}/{robot}" for robot in robots)
        node = Node("backend_node", f"backend_{self.name}", robots=name_spaces, **parameters)
        self.nodes.append(node)
        return node

    def start_robot(self, robot, run=1, **parameters):
        """Robots say nothing about themselves, so nobody waits for their diagnostics."""
        topics = [f"{topic}:=/{self.name}/{robot}/{topic}" for topic in ("keyframes", "keyframe_acks")]
        node = Node("synthetic_robot_node", f"{robot}_{run}_{self.name}", topics, is_silent=True,
                    robot=robot, session=run, **parameters)
        self.nodes.append(node)
        return node

    def test_a_backend_that_starts_after_a_thousand_keyframes(self):
        self.start_robot("ada", distance=SPACING * 999 + 0.01, period=0.0)
        time.sleep(5.0)
        backend = self.start_backend(["ada"], **{"loop_closure/enabled": "false"})
        backend.wait_for_value("keyframes", 1000, timeout=90)
        backend.wait_for_value("keyframes missing", 0)
        backend.wait_for_value("components", 1)

    def test_a_robot_that_joins_late(self):
        backend = self.start_backend(["ada", "bob"])
        self.start_robot("ada", distance=9.0)
        backend.wait_for_value("keyframes", keyframes_in(9.0), timeout=60)
        self.start_robot("bob", start=1.5, distance=6.0, seed=2, hint_robot="ada", period=0.0)
        backend.wait_for_value("keyframes", keyframes_in(9.0) + keyframes_in(6.0), timeout=60)
        backend.wait_for_value("components", 1, timeout=30)
        self.assertGreater(int(backend.values["closures between robots"]), 0)

    def test_a_robot_that_starts_again(self):
        backend = self.start_backend(["ada"])
        first = self.start_robot("ada", distance=6.0)
        backend.wait_for_value("keyframes", keyframes_in(6.0), timeout=60)
        first.stop()
        self.start_robot("ada", run=2, start=1.5, distance=4.5, seed=2, hint_robot="ada")
        backend.wait_for_value("keyframes", keyframes_in(6.0) + keyframes_in(4.5), timeout=60)
        backend.wait_for_value("keyframes refused", 0)
        backend.wait_for_value("components", 1, timeout=30)

    def test_a_segment_of_unknown_relation_is_joined_when_the_robot_comes_round(self):
        backend = self.start_backend(["ada"])
        distance = ROUND + 5.0
        self.start_robot("ada", distance=distance, lost_at=50, hint_robot="ada", period=0.05)
        wait_for(lambda: backend.values.get("components") == "2", "the lost segment stays apart", 60)
        backend.wait_for_value("keyframes", keyframes_in(distance), timeout=120)
        backend.wait_for_value("components", 1, timeout=30)

    def test_a_robot_that_is_silent_for_a_minute(self):
        backend = self.start_backend(["ada"], **{"loop_closure/enabled": "false"})
        robot = self.start_robot("ada", distance=9.0, period=0.5)
        wait_for(lambda: int(backend.values.get("keyframes", "0")) > 5, "the robot is heard", 30)
        robot.process.send_signal(signal.SIGSTOP)
        self.addCleanup(robot.process.send_signal, signal.SIGCONT)
        time.sleep(SILENCE)
        self.assertLess(int(backend.values["keyframes"]), keyframes_in(9.0))
        robot.process.send_signal(signal.SIGCONT)
        backend.wait_for_value("keyframes", keyframes_in(9.0), timeout=60)
        backend.wait_for_value("keyframes missing", 0)
        backend.wait_for_value("components", 1)


if __name__ == "__main__":
    rospy.init_node("test_robots")
    rostest.rosrun("planecloud_slam", "robots", "__main__")
