#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Lets running nodes map all they got, exports the map and prints its figures."""

import argparse
import json
import pathlib
import subprocess
import sys
import time

import rosbag
import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from planecloud_slam.srv import ExportMap
from std_srvs.srv import Trigger

BACKEND = "/backend"
SETTLE = 2.5  # [s] until every node has told its new counts
LIMIT = 120.0  # [s] for the backend to catch up


class Diagnostics:
    """The latest values of every status on /diagnostics, by the status's name."""

    def __init__(self):
        self.values = {}
        rospy.Subscriber("/diagnostics", DiagnosticArray, self._receive)

    def _receive(self, message):
        for status in message.status:
            self.values[status.name] = {item.key: item.value for item in status.values}

    def total(self, key, name):
        """Sum over the nodes that have `name` in theirs."""
        return sum(float(values.get(key, 0)) for status, values in list(self.values.items())
                   if name in status)


def services(name):
    """Full names of the services that end in `name`."""
    _, _, offered = rosgraph.Master("/show_figures").getSystemState()
    return sorted(service for service, _ in offered if service.endswith(name))


def finish(diagnostics):
    """Completes the open keyframes and waits until the backend has put everything into the map."""
    for service in services("frontend/finish"):
        rospy.ServiceProxy(service, Trigger)()
    time.sleep(SETTLE)
    deadline = time.monotonic() + LIMIT
    while time.monotonic() < deadline:
        sent, mapped, waiting = (
            diagnostics.total("keyframes", "frontend"), diagnostics.total("keyframes", "backend"),
            diagnostics.total("keyframes waiting", "backend"))
        if mapped >= sent > 0 and waiting == 0:
            return
        time.sleep(0.5)
    print("warning: the backend has not mapped every keyframe", file=sys.stderr)


def export(directory):
    rospy.wait_for_service(f"{BACKEND}/export", timeout=30)
    rospy.ServiceProxy(f"{BACKEND}/optimize", Trigger)()
    response = rospy.ServiceProxy(f"{BACKEND}/export", ExportMap)(str(directory))
    if not response.success:
        sys.exit(f"error: {response.message}")
    return [pathlib.Path(path) for path in response.files]


def write_ground_truth(bag, directory):
    """TUM files of the bag's ground truth: {robot: path}; the robot of `/ground_truth` is None."""
    lines = {}
    with rosbag.Bag(bag) as recording:
        topics = [topic for topic in recording.get_type_and_topic_info().topics
                  if topic.rsplit("/", 1)[-1] == "ground_truth"]
        for topic, message, _ in recording.read_messages(topics=topics or ["/ground_truth"]):
            p, q = message.pose.position, message.pose.orientation
            lines.setdefault(topic.strip("/").rpartition("/")[0] or None, []).append(
                f"{message.header.stamp.to_sec():.9f} {p.x} {p.y} {p.z} {q.x} {q.y} {q.z} {q.w}\n")
    paths = {}
    for robot, text in lines.items():
        paths[robot] = directory / f"{robot or 'robot'}_groundtruth.txt"
        paths[robot].write_text("".join(text), encoding="utf-8")
    return paths


def evaluate(bag, directory, files):
    """What evaluate_trajectory says of all robots under one alignment, or None without truth."""
    truth = write_ground_truth(bag, directory)
    pairs = []
    for path in (path for path in files if path.name.endswith("_keyframes.txt")):
        robot = path.name[:-len("_keyframes.txt")]
        if robot in truth or None in truth:
            pairs += [str(truth.get(robot, truth.get(None))), str(path)]
    if not pairs:
        return None
    result = subprocess.run(["rosrun", "planecloud_slam", "evaluate_trajectory", *pairs, "--json"],
                            text=True, capture_output=True, check=True)
    return json.loads(result.stdout)


def show(diagnostics, accuracy, files):
    keyframes = diagnostics.total("keyframes", "frontend")
    plane_bytes = diagnostics.total("plane and texture bytes", "frontend")
    print(f"frames       {diagnostics.total('frames', 'frontend'):.0f}, "
          f"{diagnostics.total('frames dropped', 'frontend'):.0f} dropped, "
          f"{diagnostics.total('frames lost', 'frontend'):.0f} lost")
    print(f"keyframes    {diagnostics.total('keyframes', 'backend'):.0f} in the map, "
          f"{plane_bytes / max(keyframes, 1):.0f} bytes of planes each")
    print(f"closures     {diagnostics.total('closures within a robot', 'backend'):.0f} within a robot, "
          f"{diagnostics.total('closures between robots', 'backend'):.0f} between robots")
    if accuracy is not None:
        print(f"ATE          {100 * accuracy['ate_rmse_m']:.2f} cm RMSE against ground truth")
    for path in files:
        print(f"written      {path}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bag", required=True, help="what the nodes were given")
    parser.add_argument("--output", required=True, type=pathlib.Path, help="folder for the map")
    arguments = parser.parse_args()
    rospy.init_node("show_figures", anonymous=True, disable_rostime=True, disable_signals=True)
    arguments.output.mkdir(parents=True, exist_ok=True)
    diagnostics = Diagnostics()
    finish(diagnostics)
    files = export(arguments.output.resolve())
    show(diagnostics, evaluate(arguments.bag, arguments.output, files), files)


if __name__ == "__main__":
    main()
