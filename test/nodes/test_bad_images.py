#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whatever a camera sends, the frontend says once what is wrong and how to cure it, lives, and goes
on mapping as soon as the images are good again."""

import signal
import struct
import subprocess
import unittest

import rospy
import rostest
from harness import HEIGHT, WIDTH, Camera, Collector, Node, make_image, slanted_depth, textured_grey
from planecloud_slam.msg import PlaneCloudKeyframe


class BadImages(unittest.TestCase):
    def setUp(self):
        name = self.id().rsplit(".", 1)[-1]
        self.camera = Camera(name)
        self.keyframes = Collector(f"/{name}/keyframes", PlaneCloudKeyframe)
        self.node = Node("frontend_node", f"frontend_{name}",
                         [*self.camera.remappings, f"keyframes:=/{name}/keyframes"],
                         **{"drop_frames": "false", "tf_wait": 0.0})
        self.camera.wait_for_listener()

    def tearDown(self):
        self.assertTrue(self.node.is_alive(), "the frontend died")
        self.node.stop()
        self.keyframes.close()

    def map_good_frames(self, expected):
        """The frontend tracks and sends the keyframe number `expected`, counted from 1."""
        self.camera.run()
        self.assertTrue(self.node.call("finish").success)
        numbers = [message.id for message in self.keyframes.wait_for(expected)]
        self.assertEqual(list(range(expected)), numbers)

    def expect_words(self, *texts):
        """All in one message, which is said once."""
        self.node.wait_for_words(texts[0])
        self.assertEqual(1, len(self.node.said(texts[0])), self.node.log)
        for text in texts:
            self.assertIn(text, self.node.said(texts[0])[0])

    def test_no_camera_info(self):
        self.camera.run(20, info=None)
        self.expect_words("no messages on /test_no_camera_info/rgb/camera_info", "remap")
        self.map_good_frames(1)

    def test_sizes_that_differ(self):
        self.map_good_frames(1)
        self.camera.run(depth=make_image("16UC1", slanted_depth(160, 120), 160, 120))
        self.expect_words("the depth image is 160 x 120", "the colour image is 320 x 240",
                          "depth registration")
        self.map_good_frames(2)

    def test_camera_info_of_another_size(self):
        self.map_good_frames(1)
        self.camera.run(width=640, height=480)
        self.expect_words("camera_info is 640 x 480", "the colour image is 320 x 240")
        self.map_good_frames(2)

    def test_unknown_encoding(self):
        self.map_good_frames(1)
        self.camera.run(color=make_image("yuv422", bytes(2 * WIDTH * HEIGHT)))
        self.expect_words("colour image has encoding 'yuv422'", "must be rgb8")
        self.camera.run(depth=make_image("8UC1", bytes(WIDTH * HEIGHT)))
        self.expect_words("depth image has encoding '8UC1'", "16UC1 (mm) or 32FC1 (m)")
        self.map_good_frames(2)

    def test_truncated_image(self):
        self.map_good_frames(1)
        truncated = make_image("mono8", textured_grey())
        truncated.data = truncated.data[:1000]
        self.camera.run(color=truncated)
        self.expect_words("has 1000 bytes: must be 76800", "truncated")
        self.map_good_frames(2)

    def test_depth_all_zero(self):
        self.map_good_frames(1)
        self.camera.run(depth=make_image("16UC1", bytes(2 * WIDTH * HEIGHT)))
        self.expect_words("the depth image has no valid pixel", "check")
        self.map_good_frames(2)

    def test_depth_all_nan(self):
        self.map_good_frames(1)
        nan = struct.pack("<f", float("nan"))
        self.camera.run(depth=make_image("32FC1", nan * WIDTH * HEIGHT))
        self.expect_words("the depth image has no valid pixel", "check")
        self.map_good_frames(2)

    def test_black_image(self):
        self.map_good_frames(1)
        self.camera.run(color=make_image("mono8", bytes(WIDTH * HEIGHT)))
        self.expect_words("the colour image is blank", "check exposure")
        self.map_good_frames(2)

    def test_image_of_one_colour(self):
        self.map_good_frames(1)
        self.camera.run(color=make_image("rgb8", bytes([90, 120, 150]) * WIDTH * HEIGHT))
        self.expect_words("the colour image is blank", "check exposure")
        self.map_good_frames(2)

    def test_size_that_changes_in_mid_stream(self):
        self.camera.run()
        small = {"color": make_image("mono8", textured_grey(160, 120), 160, 120),
                 "depth": make_image("16UC1", slanted_depth(160, 120), 160, 120)}
        self.camera.run(**small, width=160, height=120)
        self.expect_words("the camera changed to 160 x 120", "a new segment")
        self.assertTrue(self.node.call("finish").success)
        sizes = [message.plane_cloud.width for message in self.keyframes.wait_for(2)]
        self.assertEqual([320, 160], sizes)

    def test_time_that_runs_backwards(self):
        self.camera.run()
        self.camera.stamp -= rospy.Duration(100)
        self.camera.run()
        self.expect_words("time went back", "new segment")
        self.assertTrue(self.node.call("finish").success)
        first, second = self.keyframes.wait_for(2)
        self.assertLess(second.plane_cloud.header.stamp, first.plane_cloud.header.stamp)
        self.assertEqual([], second.edges)

    def test_stamps_that_never_pair(self):
        for _ in range(20):
            self.camera.run(1)
        far = make_image("16UC1", slanted_depth())
        self.camera.run(1)
        self.assertNotIn("never pair up", " ".join(self.node.log))
        for _ in range(60):
            self.camera.stamp += rospy.Duration(0.1)
            color = self.camera.good_color
            color.header.stamp = self.camera.stamp
            far.header.stamp = self.camera.stamp + rospy.Duration(0.05)
            self.camera._color.publish(color)
            self.camera._depth.publish(far)
            rospy.rostime.wallsleep(0.1)
        self.expect_words("never pair up", "s apart", "~exact_sync")


class BadParameters(unittest.TestCase):
    def run_node(self, *arguments):
        return subprocess.run(["rosrun", "planecloud_slam", *arguments], text=True, timeout=20,
                              capture_output=True, check=False)

    def test_out_of_range_refuse_to_start(self):
        frontend = self.run_node("frontend_node", "__name:=bad", "_link/resend_after:=1000")
        self.assertEqual(1, frontend.returncode)
        self.assertIn("link/resend_after = 1000: must be in [0.1, 60]", frontend.stderr)
        backend = self.run_node("backend_node", "__name:=bad", "_ack_period:=0")
        self.assertEqual(1, backend.returncode)
        self.assertIn("ack_period = 0: must be in [0.1, 60]", backend.stderr)

    def test_of_another_type_refuse_to_start(self):
        frontend = self.run_node("frontend_node", "__name:=bad2", "_frame_queue:=many")
        self.assertEqual(1, frontend.returncode)
        self.assertIn("frame_queue = many: must be a whole number", frontend.stderr)

    def test_unknown_ones_are_named_with_the_nearest(self):
        node = subprocess.Popen(
            ["rosrun", "planecloud_slam", "frontend_node", "__name:=misspelt",
             "_link/outbox_byte:=5"], text=True, stderr=subprocess.PIPE)
        lines = []
        while not any("unknown parameter" in line for line in lines):
            lines.append(node.stderr.readline())
            self.assertNotEqual("", lines[-1], "the node ended")
        self.assertIn("/misspelt/link/outbox_byte = 5", lines[-1])
        self.assertIn("is link/outbox_bytes meant?", lines[-1])
        node.send_signal(signal.SIGINT)
        node.communicate(timeout=20)
        self.assertEqual(0, node.returncode)


if __name__ == "__main__":
    rospy.init_node("test_bad_images")
    rostest.rosrun("planecloud_slam", "bad_images", "__main__")
