#!/usr/bin/env python3
"""Lists the points that moved more than a threshold. list_deformed.py MILLIMETRES [URL] [PREFIX]"""

import math
import pathlib
import sys

import lcm_python

if len(sys.argv) < 2:
    sys.exit(__doc__)
threshold = float(sys.argv[1]) / 1000
url = sys.argv[2] if len(sys.argv) > 2 else lcm_python.DEFAULT_URL
prefix = sys.argv[3] if len(sys.argv) > 3 else "PLIANT"
types = lcm_python.Types(pathlib.Path(__file__).resolve().parents[2] / "drivers/lcm/types")
for channel, data in lcm_python.Receiver(url):
    if channel != prefix + "_DEFORMED":
        continue
    message = types.decode(data)  # each part of a frame's points can be used by itself
    for index, place, moved in zip(message.index, message.position, message.displacement):
        length = math.hypot(*moved)
        if length > threshold:
            print(message.frame, index, f"{1000 * length:.2f}", *(f"{value:.6f}" for value in place), flush=True)
