#!/usr/bin/env python3
"""Follows the object: prints where it is in each frame. follow_pose.py [URL] [PREFIX]"""

import pathlib
import sys

import lcm_python

url = sys.argv[1] if len(sys.argv) > 1 else lcm_python.DEFAULT_URL
prefix = sys.argv[2] if len(sys.argv) > 2 else "PLIANT"
types = lcm_python.Types(pathlib.Path(__file__).resolve().parents[2] / "drivers/lcm/types")
for channel, data in lcm_python.Receiver(url):
    if channel == prefix + "_POSE":
        pose = types.decode(data)
        # A point of the model is in the camera's frame at R(quat) * point + trans; metres.
        print(pose.utime, *(f"{value:.6f}" for value in pose.trans + pose.quat), flush=True)
