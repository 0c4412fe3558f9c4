# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Starts nodes, feeds them and listens to what they say."""

import random
import signal
import struct
import subprocess
import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import CameraInfo, Image
from std_srvs.srv import Trigger

WIDTH, HEIGHT = 320, 240
FOCAL_LENGTH = 285.0


def wait_for(condition, what, timeout=15.0):
    """Returns what `condition` returns as soon as that is true; fails after `timeout` seconds with
    `what`, a text or a function that makes it then."""
    deadline = time.monotonic() + timeout
    while time.monotonic() < deadline:
        result = condition()
        if result:
            return result
        time.sleep(0.05)
    raise AssertionError(f"timeout: {what() if callable(what) else what}")


class Watch:
    """What a node logs and diagnoses."""

    def __init__(self, name):
        self.name = name
        self.log = []
        self.values = {}
        self._subscribers = [
            rospy.Subscriber("/rosout", Log, self._on_log),
            rospy.Subscriber("/diagnostics", DiagnosticArray, self._on_diagnostics)]

    def _on_log(self, message):
        if message.name == self.name:
            self.log.append(message.msg)

    def _on_diagnostics(self, message):
        for status in message.status:
            if status.name.startswith(self.name + ":"):
                self.values = {line.key: line.value for line in status.values}

    def said(self, text):
        return [line for line in list(self.log) if text in line]

    def wait_for_words(self, text, timeout=15.0):
        wait_for(lambda: self.said(text),
                 lambda: f"{self.name} says '{text}'; it said {self.log}", timeout)

    def wait_for_value(self, key, value, timeout=15.0):
        wait_for(lambda: self.values.get(key) == str(value),
                 lambda: f"{self.name} has {key} = {value}; it has {self.values}", timeout)

    def wait_until_steady(self, key, seconds=4.0, timeout=120.0):
        """Returns the value once it has not changed for some time."""
        seen = [(time.monotonic(), self.values.get(key))]

        def is_steady():
            now, value = time.monotonic(), self.values.get(key)
            if value != seen[-1][1]:
                seen.append((now, value))
            return now - seen[-1][0] > seconds
        wait_for(is_steady, f"{key} of {self.name} settles", timeout)
        return seen[-1][1]

    def call(self, service):
        return rospy.ServiceProxy(f"{self.name}/{service}", Trigger)()

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()


class Node(Watch):
    """A node of the package in its own process."""

    def __init__(self, kind, name, remappings=(), command=(), is_silent=False, **parameters):
        """`command`: what is put before, such as `ip netns exec NAME`; `is_silent`: it has no
        diagnostics to wait for."""
        super().__init__(f"/{name}")
        arguments = [f"__name:={name}", *remappings]
        arguments += [f"_{key}:={value}" for key, value in parameters.items()]
        self.process = subprocess.Popen(
            [*command, "rosrun", "planecloud_slam", kind, *arguments])
        if not is_silent:
            wait_for(lambda: self.values or not self.is_alive(), f"{name} runs")

    def is_alive(self):
        return self.process.poll() is None

    def stop(self, how=signal.SIGINT):
        self.close()
        if self.is_alive():
            self.process.send_signal(how)
        self.process.wait(timeout=20)


def textured_grey(width=WIDTH, height=HEIGHT, seed=1):
    """Soft random blobs: a scene that a tracker can hold on to."""
    generator = random.Random(seed)
    cells = [[generator.randrange(40, 216) for _ in range(width // 10 + 2)]
             for _ in range(height // 10 + 2)]
    rows = bytearray()
    for y in range(height):
        above, below, v = cells[y // 10], cells[y // 10 + 1], (y % 10) / 10
        edge = [a + v * (b - a) for a, b in zip(above, below)]
        rows += bytes(int(edge[x // 10] + (x % 10) / 10 * (edge[x // 10 + 1] - edge[x // 10]))
                      for x in range(width))
    return bytes(rows)


def slanted_depth(width=WIDTH, height=HEIGHT):
    """A wall from 1.5 m to 2.5 m [mm]."""
    row = struct.pack(f"<{width}H", *(1500 + 1000 * x // width for x in range(width)))
    return row * height


def make_image(encoding, pixels, width=WIDTH, height=HEIGHT):
    image = Image(encoding=encoding, width=width, height=height, data=pixels)
    image.step = len(pixels) // height
    image.header.frame_id = "camera_rgb_optical_frame"
    return image


class Camera:
    """Publishes what a test wants a camera to see."""

    def __init__(self, name="camera"):
        queue = {"queue_size": 100}
        self.color_topic = f"/{name}/rgb/image_rect_color"
        self.depth_topic = f"/{name}/depth_registered/image_rect"
        self._color = rospy.Publisher(self.color_topic, Image, **queue)
        self._depth = rospy.Publisher(self.depth_topic, Image, **queue)
        self._info = rospy.Publisher(f"/{name}/rgb/camera_info", CameraInfo, **queue)
        self.stamp = rospy.Time(1000)
        self.good_color = make_image("mono8", textured_grey())
        self.good_depth = make_image("16UC1", slanted_depth())
        self.remappings = [f"rgb/image_rect_color:={self.color_topic}",
                           f"depth_registered/image_rect:={self.depth_topic}",
                           f"rgb/camera_info:=/{name}/rgb/camera_info"]

    def wait_for_listener(self):
        wait_for(lambda: all(p.get_num_connections() for p in (self._color, self._depth, self._info)),
                 "somebody subscribes to the camera")

    def publish(self, color=None, depth=None, info="good", width=WIDTH, height=HEIGHT):
        """One frame; `info` None: without camera info."""
        self.stamp += rospy.Duration(0.1)
        color, depth = color or self.good_color, depth or self.good_depth
        if info:
            message = CameraInfo(width=width, height=height)
            f = FOCAL_LENGTH * width / WIDTH
            message.K = [f, 0, width / 2 - 0.5, 0, f, height / 2 - 0.5, 0, 0, 1]
            message.P = [f, 0, width / 2 - 0.5, 0, 0, f, height / 2 - 0.5, 0, 0, 0, 1, 0]
            message.header.stamp = self.stamp
            self._info.publish(message)
        color.header.stamp = depth.header.stamp = self.stamp
        self._color.publish(color)
        self._depth.publish(depth)

    def run(self, count=5, **frame):
        for _ in range(count):
            self.publish(**frame)
            time.sleep(0.05)


class Collector:
    """Keeps the messages of a topic."""

    def __init__(self, topic, kind):
        self.messages = []
        self._lock = threading.Lock()
        self._subscriber = rospy.Subscriber(topic, kind, self._add)

    def _add(self, message):
        with self._lock:
            self.messages.append(message)

    def wait_for(self, count, timeout=15.0):
        wait_for(lambda: len(self.messages) >= count,
                 f"{count} messages on {self._subscriber.name}, {len(self.messages)} came", timeout)
        return self.messages

    def close(self):
        self._subscriber.unregister()
