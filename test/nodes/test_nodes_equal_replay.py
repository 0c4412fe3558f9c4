#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""The nodes give what replay gives in one process: the same keyframes at the same places."""

import math
import pathlib
import signal
import subprocess
import tempfile
import unittest

import rospy
import rostest
from harness import Watch, wait_for
from planecloud_slam.srv import ExportMap

HERE = pathlib.Path(__file__).resolve().parent
TOPICS = ["/camera/rgb/image_rect_color", "/camera/rgb/camera_info",
          "/camera/depth_registered/image_raw", "/tf", "/tf_static"]
DURATION = 12  # [s]


def multiply(a, b):
    """Product of quaternions (x, y, z, w)."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def conjugate(q):
    return (-q[0], -q[1], -q[2], q[3])


def rotate(q, v):
    return multiply(multiply(q, (*v, 0.0)), conjugate(q))[:3]


def read_trajectory(path):
    """Poses by stamp [us], relative to the first one: the two maps may have different frames."""
    poses = []
    for line in path.read_text().splitlines():
        if not line.startswith("#"):
            stamp, *numbers = map(float, line.split())
            poses.append((round(stamp * 1e6), tuple(numbers[:3]), tuple(numbers[3:])))
    _, origin, turn = poses[0]
    back = conjugate(turn)
    return {stamp: (rotate(back, [a - b for a, b in zip(position, origin)]),
                    multiply(back, rotation)) for stamp, position, rotation in poses}


def run(*command):
    subprocess.run(command, check=True, timeout=200)


class NodesEqualReplay(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        self.bag = str(self.path / "hallway.bag")
        run("rosrun", "planecloud_slam", "make_hallway_bag", "--output", self.bag, "--seed", "3",
            "--duration", str(DURATION))

    def tearDown(self):
        self.folder.cleanup()

    def replay(self):
        run("rosrun", "planecloud_slam", "replay", self.bag, "--output", str(self.path / "replay"))
        return read_trajectory(next((self.path / "replay").glob("*_keyframes.txt")))

    def run_nodes(self):
        launch = subprocess.Popen(["roslaunch", str(HERE / "offline.launch")])
        try:
            frontend, backend = Watch("/frontend"), Watch("/backend")
            wait_for(lambda: frontend.values and backend.values, "both nodes run", 30)
            run("rosbag", "play", "--clock", "--wait-for-subscribers", "--quiet", self.bag,
                "--topics", *TOPICS)
            self.finish(frontend, backend)
            self.assertEqual("0", frontend.values["frames dropped"])
            self.assertIsNone(launch.poll())
        finally:
            launch.send_signal(signal.SIGINT)
            launch.wait(timeout=30)
        return read_trajectory(next((self.path / "nodes").glob("*_keyframes.txt")))

    def finish(self, frontend, backend):
        frontend.wait_until_steady("frames")
        self.assertTrue(frontend.call("finish").success)
        made = frontend.wait_until_steady("keyframes")
        backend.wait_for_value("keyframes", made, timeout=60)
        self.assertTrue(backend.call("optimize").success)
        export = rospy.ServiceProxy("/backend/export", ExportMap)
        result = export(directory=str(self.path / "nodes"))
        self.assertTrue(result.success, result.message)

    def test_same_keyframes_at_the_same_places(self):
        nodes, replayed = self.run_nodes(), self.replay()
        self.assertGreater(len(replayed), 10)
        self.assertEqual(sorted(replayed), sorted(nodes), "keyframes are missing or differ")
        for stamp, (position, rotation) in nodes.items():
            other_position, other_rotation = replayed[stamp]
            self.assertLess(math.dist(position, other_position), 0.01)
            cosine = abs(sum(a * b for a, b in zip(rotation, other_rotation)))
            self.assertLess(math.degrees(2 * math.acos(min(1.0, cosine))), 0.5)


if __name__ == "__main__":
    rospy.init_node("test_nodes_equal_replay")
    rostest.rosrun("planecloud_slam", "nodes_equal_replay", "__main__")
