#!/usr/bin/env python3
"""Drives an overlay: draws the tracked points over a camera's picture, into an image file that is replaced with each
frame. overlay.py OUT.ppm WIDTH HEIGHT FX FY CX CY [URL] [PREFIX]; the camera as `pliant record` writes it."""

import os
import pathlib
import sys

import lcm_python

BLUE, YELLOW, RED = (0, 114, 178), (240, 228, 66), (213, 94, 0)


def mover(region):
    """The function p -> R(quat) * p + trans."""
    w, x, y, z = region.quat
    a, b, c = region.trans
    m = (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
         2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
         2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))
    return lambda p: (m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + a, m[3] * p[0] + m[4] * p[1] + m[5] * p[2] + b,
                      m[6] * p[0] + m[7] * p[1] + m[8] * p[2] + c)


class Overlay:
    def __init__(self, file, width, height, camera):
        self.file, self.width, self.height, self.camera = file, width, height, camera
        self.rest = {}
        self.clear()

    def clear(self):
        self.picture = bytearray(3 * self.width * self.height)

    def draw(self, point, colour):
        x, y, z = point
        fx, fy, cx, cy = self.camera
        if z <= 0:
            return
        u, v = round(fx * x / z + cx), round(fy * y / z + cy)
        if 0 <= u < self.width and 0 <= v < self.height:
            at = 3 * (v * self.width + u)
            self.picture[at:at + 3] = bytes(colour)

    def show(self):
        """The frame that is done; the file is never seen half written."""
        with open(self.file + ".part", "wb") as out:
            out.write(b"P6 %d %d 255\n" % (self.width, self.height) + self.picture)
        os.rename(self.file + ".part", self.file)
        self.clear()

    def take(self, kind, message):
        if kind == "MODEL":  # comes in parts, again and again: each is kept
            for i, steps in enumerate(message.position):
                self.rest[message.first_point + i] = [o + message.step * s for o, s in zip(message.origin, steps)]
        elif kind == "REGIONS":  # points of rigid regions lie where their region carries them
            if message.first_point == 0:
                self.show()
            movers = {region.id: mover(region) for region in message.regions}
            for point, label in enumerate(message.labels, message.first_point):
                if label in movers and point in self.rest:
                    self.draw(movers[label](self.rest[point]), BLUE if label == 0 else YELLOW)
        elif kind == "DEFORMED":  # these are sent with their positions
            for place in message.position:
                self.draw(place, RED)


if len(sys.argv) < 8:
    sys.exit(__doc__)
overlay = Overlay(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), [float(word) for word in sys.argv[4:8]])
url = sys.argv[8] if len(sys.argv) > 8 else lcm_python.DEFAULT_URL
wanted = sys.argv[9] if len(sys.argv) > 9 else "PLIANT"
types = lcm_python.Types(pathlib.Path(__file__).resolve().parents[2] / "drivers/lcm/types")
for channel, data in lcm_python.Receiver(url):
    prefix, _, kind = channel.rpartition("_")
    if prefix == wanted and kind in ("MODEL", "REGIONS", "DEFORMED"):
        overlay.take(kind, types.decode(data))
