#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Budgets hold while the frontend runs, and dynamic_reconfigure changes them."""

import io
import time
import unittest

import rospy
import rostest
from camera_source import rough_depth
from dynamic_reconfigure.client import Client
from harness import Camera, Node, make_image, wait_for
from planecloud_slam.msg import PlaneCloudKeyframe

WINDOW = 5.0  # [s]


def wire_size(message):
    """With the length that TCPROS puts before a message."""
    buffer = io.BytesIO()
    message.serialize(buffer)
    return len(buffer.getvalue()) + 4


class KeyframeMeter:
    """When keyframes came, how large they were, and what of them a byte budget counts."""

    def __init__(self, topic):
        self.arrivals = []  # (monotonic time, message)
        self._subscriber = rospy.Subscriber(topic, PlaneCloudKeyframe, self._add, tcp_nodelay=True)

    def _add(self, message):
        self.arrivals.append((time.monotonic(), message))

    def payloads(self):
        return [len(m.plane_cloud.data) + len(m.texture) for _, m in self.arrivals]

    def fullest_window(self):
        sizes = [(when, wire_size(message)) for when, message in self.arrivals]
        return max(sum(size for other, size in sizes if when - WINDOW < other <= when)
                   for when, _ in sizes)

    def close(self):
        self._subscriber.unregister()


class Budgets(unittest.TestCase):
    def setUp(self):
        name = self.id().rsplit(".", 1)[-1]
        self.camera = Camera(name)
        self.camera.good_depth = make_image("16UC1", rough_depth())
        self.meter = KeyframeMeter(f"/{name}/keyframes")
        self.node = Node("frontend_node", f"frontend_{name}",
                         [*self.camera.remappings, f"keyframes:=/{name}/keyframes",
                          f"keyframe_acks:=/{name}/keyframe_acks"], tf_wait=0.0)
        self.camera.wait_for_listener()

    def tearDown(self):
        self.assertTrue(self.node.is_alive(), "the frontend died")
        self.node.stop()
        self.meter.close()

    def change(self, part, **values):
        client = Client(f"{self.node.name}/{part}", timeout=10)
        changed = client.update_configuration(values)
        client.close()
        return changed

    def send_keyframes(self, count):
        first = len(self.meter.arrivals)
        for _ in range(count):
            self.camera.run(2)
            self.assertTrue(self.node.call("finish").success)
        return first

    def test_bytes_of_a_keyframe(self):
        self.send_keyframes(1)
        wait_for(lambda: len(self.meter.arrivals) == 1, "the first keyframe")
        unlimited = self.meter.payloads()[0]
        for budget in (unlimited // 2, 700):
            self.assertEqual(budget, self.change("codec", byte_budget=budget)["byte_budget"])
            first = self.send_keyframes(1)
            wait_for(lambda: len(self.meter.arrivals) > first, "a keyframe")
            self.assertLessEqual(self.meter.payloads()[-1], budget)
            self.assertGreater(self.meter.arrivals[-1][1].plane_cloud.plane_count, 0)

    def test_bytes_per_second_over_whole_messages(self):
        rate = 3000.0
        self.change("link", bytes_per_second=rate)
        time.sleep(1.5)  # the link looks once a second
        count = 20
        self.send_keyframes(count)
        wait_for(lambda: len(self.meter.arrivals) == count, "all keyframes", timeout=60)
        self.assertEqual(list(range(count)), [m.id for _, m in self.meter.arrivals])
        # Keyframes arrive some milliseconds after they were counted.
        self.assertLessEqual(self.meter.fullest_window(), 1.02 * rate * WINDOW)

    def test_values_out_of_range_are_brought_into_it(self):
        self.assertEqual(64, self.change("codec", byte_budget=7)["byte_budget"])
        self.assertEqual(10.0, self.change("plane_fit", time_budget=99.0)["time_budget"])
        self.assertEqual(100, self.change("texture", quality=1000)["quality"])

    def test_texture(self):
        self.send_keyframes(1)
        self.change("texture", format="none")
        self.send_keyframes(1)
        wait_for(lambda: len(self.meter.arrivals) == 2, "two keyframes")
        self.assertEqual([1, 0], [m.texture_format for _, m in self.meter.arrivals])


if __name__ == "__main__":
    rospy.init_node("test_budgets")
    rostest.rosrun("planecloud_slam", "budgets", "__main__")
