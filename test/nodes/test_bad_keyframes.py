#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whatever arrives instead of a keyframe, the backend says once what is wrong, lives, keeps its map
and takes the next good keyframe."""

import copy
import io
import math
import unittest

import rospy
import rostest
from harness import Camera, Collector, Node, wait_for
from planecloud_slam.msg import KeyframeAck, PlaneCloudKeyframe, RelativePoseEdge


def record_keyframe():
    """A keyframe as the frontend makes it."""
    camera = Camera("source")
    keyframes = Collector("/source/keyframes", PlaneCloudKeyframe)
    node = Node("frontend_node", "source_frontend",
                [*camera.remappings, "keyframes:=/source/keyframes"], tf_wait=0.0, robot="ada")
    camera.wait_for_listener()
    camera.run(5)
    node.call("finish")
    keyframe = keyframes.wait_for(1)[0]
    node.stop()
    keyframes.close()
    return keyframe


class RawKeyframe(PlaneCloudKeyframe):
    """Bytes that call themselves a keyframe."""

    raw = b""

    def serialize(self, buff):
        buff.write(self.raw)


class BadKeyframes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.good = record_keyframe()

    def setUp(self):
        name = self.id().rsplit(".", 1)[-1]
        self.publisher = rospy.Publisher(f"/{name}/keyframes", PlaneCloudKeyframe, queue_size=100)
        self.acks = Collector(f"/{name}/keyframe_acks", KeyframeAck)
        self.node = Node("backend_node", f"backend_{name}", robots=name, odom_frame=f"{name}/odom")
        wait_for(self.publisher.get_num_connections, "the backend listens")
        self.next_id = 0
        self.publish_good()
        self.node.wait_for_value("keyframes", 1)

    def tearDown(self):
        self.assertTrue(self.node.is_alive(), "the backend died")
        self.node.stop()
        self.acks.close()
        self.publisher.unregister()

    def make_keyframe(self):
        keyframe = copy.deepcopy(self.good)
        keyframe.id = self.next_id
        keyframe.plane_cloud.header.stamp += rospy.Duration(self.next_id)
        self.next_id += 1
        return keyframe

    def publish_good(self):
        self.publisher.publish(self.make_keyframe())

    def expect_refusal(self, keyframe, *words):
        """One message naming the robot, the id and the reason; the map stays and grows."""
        self.publisher.publish(keyframe)
        self.node.wait_for_words("refused:")
        self.assertEqual(1, len(self.node.said("refused:")), self.node.log)
        for text in (f"keyframe ada/{keyframe.session}/{keyframe.id} refused", *words):
            self.assertIn(text, self.node.said("refused:")[0])
        self.publish_good()
        self.node.wait_for_value("keyframes", 2)
        self.expect_acknowledged(self.next_id - 1)

    def expect_acknowledged(self, number):
        """Refused ones count as received: they must not come again."""
        wait_for(lambda: self.acks.messages[-1].highest_without_gap == number,
                 f"everything up to {number} is acknowledged")

    def test_truncated_planes(self):
        keyframe = self.make_keyframe()
        planes = keyframe.plane_cloud.data
        keyframe.plane_cloud.data = planes[:len(planes) // 2]
        self.expect_refusal(keyframe)

    def test_no_planes_at_all(self):
        keyframe = self.make_keyframe()
        keyframe.plane_cloud.data = b""
        self.expect_refusal(keyframe)

    def test_nan_pose(self):
        keyframe = self.make_keyframe()
        keyframe.translation = [0.0, math.nan, 0.0]
        self.expect_refusal(keyframe, "translation")

    def test_infinite_edge(self):
        self.publisher.publish(self.with_edge(0.1))
        self.node.wait_for_value("keyframes", 2)
        keyframe = self.with_edge(math.inf)
        self.publisher.publish(keyframe)
        self.node.wait_for_words(f"keyframe ada/{keyframe.session}/{keyframe.id} refused")
        self.publish_good()
        self.node.wait_for_value("keyframes", 3)

    def with_edge(self, x):
        keyframe = self.make_keyframe()
        edge = RelativePoseEdge(translation=[x, 0.0, 0.0])
        edge.other.id = 0
        diagonal = [0, 6, 11, 15, 18, 20]
        edge.information = [1e4 if i in diagonal else 0.0 for i in range(21)]
        keyframe.edges = [edge]
        return keyframe

    def test_impossible_count(self):
        keyframe = self.make_keyframe()
        keyframe.plane_cloud.plane_count = 4000000000
        self.expect_refusal(keyframe, "4000000000")

    def test_foreign_version(self):
        keyframe = self.make_keyframe()
        keyframe.plane_cloud.data = bytes([99]) + keyframe.plane_cloud.data[1:]
        self.expect_refusal(keyframe, "version")

    def test_foreign_encoding(self):
        keyframe = self.make_keyframe()
        keyframe.plane_cloud.encoding = 77
        self.expect_refusal(keyframe, "77")

    def test_camera_that_cannot_be(self):
        keyframe = self.make_keyframe()
        keyframe.plane_cloud.fx = -1.0
        self.expect_refusal(keyframe, "fx")

    def test_repeated_id(self):
        for _ in range(3):
            self.next_id = 0
            self.publish_good()
        self.node.wait_for_value("keyframes repeated", 3)
        self.assertEqual("1", self.node.values["keyframes"])
        self.assertEqual(1, len(self.node.said("came again")), self.node.log)
        self.publish_good()
        self.node.wait_for_value("keyframes", 2)

    def test_skipped_ids(self):
        self.next_id = 4
        self.publish_good()
        self.node.wait_for_value("keyframes missing", 3)
        self.node.wait_for_words("came before 3 earlier ones, from 1 on")
        wait_for(lambda: list(self.acks.messages[-1].gaps) == [1, 2, 3], "the gaps are told")
        for self.next_id in (3, 1, 2):
            self.publish_good()
        self.node.wait_for_value("keyframes missing", 0)
        self.node.wait_for_value("keyframes", 5)
        self.expect_acknowledged(4)

    def test_message_that_ends_too_early(self):
        """As bytes on the wire: roscpp itself finds the end missing."""
        buffer = io.BytesIO()
        self.make_keyframe().serialize(buffer)
        truncated = RawKeyframe()
        truncated.raw = buffer.getvalue()[:-20]
        self.publisher.publish(truncated)
        self.node.wait_for_words("deserializing")
        self.next_id = 1
        self.publish_good()
        self.node.wait_for_value("keyframes", 2)

    def test_two_running_frontends_of_one_name(self):
        other = self.make_keyframe()
        other.session += 1
        other.id = 0
        self.publisher.publish(other)
        self.node.wait_for_value("keyframes", 2)
        self.next_id = 5
        self.publish_good()
        self.node.wait_for_words("call themselves")
        self.assertIn("ada", self.node.said("call themselves")[0])
        self.assertEqual("2", self.node.values["keyframes"])

    def test_reset_empties_the_map_and_optimize_keeps_it(self):
        self.assertTrue(self.node.call("optimize").success)
        self.node.wait_for_value("keyframes", 1)
        self.assertTrue(self.node.call("reset").success)
        self.node.wait_for_value("keyframes", 0)
        self.publish_good()
        self.node.wait_for_value("keyframes", 1)


if __name__ == "__main__":
    rospy.init_node("test_bad_keyframes")
    rostest.rosrun("planecloud_slam", "bad_keyframes", "__main__")
