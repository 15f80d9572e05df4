"""`pliant snapshot` beside a tracker that publishes, in a network of its own: the picture shows the object and the
depth, and what is missing is said. Arguments: the program."""

import pathlib
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

program = sys.argv[1]
URL = "udpm://239.255.76.67:7667?ttl=0"


def pixels(path):
    """Rows of (red, green, blue) of a PNG of 8 bits a channel."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack_from(">IIBB", data, at + 8)
            assert (depth, colour) == (8, 2)
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, above, rows = zlib.decompress(packed), bytearray(3 * width), []
    for v in range(height):
        start = v * (3 * width + 1)
        kind, row = raw[start], bytearray(raw[start + 1:start + 1 + 3 * width])
        for i, value in enumerate(row):
            left, up = (row[i - 3] if i >= 3 else 0), above[i]
            corner = above[i - 3] if i >= 3 else 0
            guess = left + up - corner
            nearest = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
            row[i] = (value + (0, left, up, (left + up) // 2, nearest)[kind]) & 255
        above = row
        rows.append([tuple(row[i:i + 3]) for i in range(0, 3 * width, 3)])
    return rows


def share(rows, test):
    return sum(test(*pixel) for row in rows for pixel in row) / (len(rows) * len(rows[0]))


def is_base(red, green, blue):
    return blue > 60 and blue > 1.3 * green and blue > 2.5 * red


def is_depth(red, green, blue):
    return red == green == blue and red > 30


class LiveSnapshot(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def track(self, *words):
        tracker = subprocess.Popen([program, "run", "--source", "simulated:cushion?width=320&height=240&frames=100000",
                                    "--pace", "realtime", "--lcm-url", URL, *words], stdout=subprocess.DEVNULL)
        self.addCleanup(tracker.wait)
        self.addCleanup(tracker.terminate)

    def snapshot(self, *words):
        output = self.folder / "now.png"
        return output, subprocess.run([program, "snapshot", "-o", output, "--lcm-url", URL, *words],
                                      capture_output=True, text=True)

    def test_the_picture_shows_the_object_on_the_depth(self):
        self.track("--publish-depth")
        for _ in range(3):  # a busy machine loses datagrams, and with one of them a depth picture
            output, ended = self.snapshot("--wait", "30")
            self.assertEqual(ended.returncode, 0, ended.stderr)
            self.assertRegex(ended.stdout, r"now\.png: frame \d+: tracking")
            rows = pixels(output)
            if len(rows) == 240:
                break
        self.assertEqual((len(rows[0]), len(rows)), (320, 240))
        self.assertGreater(share(rows, is_base), 0.03)
        self.assertGreater(share(rows, is_depth), 0.3)

    def test_without_depth_it_draws_the_object_alone(self):
        self.track()
        output, ended = self.snapshot("--wait", "30")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        rows = pixels(output)
        self.assertEqual((len(rows[0]), len(rows)), (640, 480))
        self.assertGreater(share(rows, is_base), 0.03)
        self.assertLess(share(rows, is_depth), 0.05)

    def test_silence_is_told_within_the_time_given(self):
        begin = time.monotonic()
        output, ended = self.snapshot("--wait", "1", "--prefix", "NOBODY")
        self.assertEqual(ended.returncode, 2)
        self.assertIn("nothing is published on NOBODY_*", ended.stderr)
        self.assertEqual(ended.stderr.count("\n"), 1)
        self.assertLess(time.monotonic() - begin, 10)
        self.assertFalse(output.exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
