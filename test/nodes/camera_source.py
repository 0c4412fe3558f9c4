#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""A camera before a rough wall; twice a second it asks /frontend for a keyframe."""

import random
import struct
import time

import rospy
from harness import HEIGHT, WIDTH, Camera, make_image
from std_srvs.srv import Trigger

CELL = 16  # [px]


def rough_depth():
    """Steps of 10 cm from cell to cell: many small planes, keyframes of some ten kilobytes."""
    generator = random.Random(1)
    rows = []
    for _ in range(HEIGHT // CELL):
        cells = [1500 + 100 * generator.randrange(8) for _ in range(WIDTH // CELL)]
        rows.append(struct.pack(f"<{WIDTH}H", *(cells[x // CELL] for x in range(WIDTH))) * CELL)
    return b"".join(rows)


def main():
    rospy.init_node("camera_source")
    camera = Camera()
    camera.good_depth = make_image("16UC1", rough_depth())
    camera.wait_for_listener()
    finish = rospy.ServiceProxy("/frontend/finish", Trigger, persistent=True)
    finish.wait_for_service()
    while not rospy.is_shutdown():
        camera.publish()
        time.sleep(0.25)
        finish()
        time.sleep(0.25)


if __name__ == "__main__":
    main()
