"""The three examples of one language beside the real tracker: what they print and draw is what the tracker knows."""

import pathlib
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import languages
import subscribers_beside

options = languages.arguments()
URL = subscribers_beside.URL
SOURCE = "simulated:cushion?width=320&height=240&frames=135"
THRESHOLD = 3.0  # millimetres


def camera_of(folder):
    text = (folder / "camera.toml").read_text()
    values = dict(line.split("#")[0].split("=") for line in text.splitlines() if "=" in line.split("#")[0])
    return {key.strip(): value.strip() for key, value in values.items()}


ROOT = pathlib.Path(options.examples).parents[1]


def readme_program():
    """The subscriber that README.md shows."""
    return (ROOT / "README.md").read_text().split("```python\n")[1].split("```")[0]


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        folder = cls.folder = pathlib.Path(cls.temporary.name)
        class_path = None
        if options.language == "java":
            sources = [pathlib.Path(options.examples) / f"{name}.java" for name in languages.JAVA_NAMES.values()]
            (folder / "java").mkdir()
            class_path = languages.compile_java(options, folder / "java", sources)
        subprocess.run([options.pliant, "record", "--source", "simulated:cushion?width=320&height=240&frames=1", "-o",
                        folder / "recording"], check=True, stdout=subprocess.DEVNULL)
        camera = camera_of(folder / "recording")
        words = {"follow_pose": [URL], "list_deformed": [str(THRESHOLD), URL],
                 "overlay": [str(folder / "overlay.ppm"), *(camera[key] for key in
                                                            ("width", "height", "fx", "fy", "cx", "cy")), URL]}
        cls.without_words = {example: subprocess.run(languages.command(options, example, class_path),
                                                     capture_output=True, text=True, timeout=60)
                             for example in ("list_deformed", "overlay")}
        running, outputs = [], {}
        try:
            if options.language == "python":
                outputs["readme"] = open(folder / "readme.txt", "w+")
                running.append(subprocess.Popen([sys.executable, "-B", "-u", "-c", readme_program()],
                                                stdout=outputs["readme"], cwd=ROOT))
            for example, rest in words.items():
                outputs[example] = open(folder / f"{example}.txt", "w+")
                running.append(subprocess.Popen(languages.command(options, example, class_path) + rest,
                                                stdout=outputs[example]))
            subscribers_beside.wait_for_subscribers(len(running))
            time.sleep(0.5)
            run = subprocess.run([options.pliant, "run", "--source", SOURCE, "--pace", "realtime", "--lcm-url", URL,
                                  "--trajectory", folder / "path.txt", "--points", folder / "points"],
                                 capture_output=True, text=True)
            time.sleep(1)
            cls.alive = [process.poll() is None for process in running]
        finally:
            for process in running:
                process.terminate()
                process.wait()
        cls.lines = {}
        for example, file in outputs.items():
            file.seek(0)
            cls.lines[example] = [line.split() for line in file]
            file.close()
        assert run.returncode == 0, run.stderr

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def points(self, frame):
        data = (self.folder / f"points/{frame:06}.ply").read_bytes().partition(b"end_header\n")[2]
        return [struct.unpack_from("<6f2i", data, 39 * i) for i in range(len(data) // 39)]

    def test_all_of_them_keep_running(self):
        self.assertTrue(all(self.alive), self.alive)

    def test_without_words_the_usage_is_told(self):
        for example, ended in self.without_words.items():
            self.assertNotEqual(ended.returncode, 0)
            self.assertIn("[URL] [PREFIX]", ended.stderr, example)
            self.assertNotRegex(ended.stderr, "Traceback|Exception")

    def test_the_path_that_is_followed_is_that_of_the_tracker(self):
        path = [[float(word) for word in line.split()] for line in (self.folder / "path.txt").read_text().splitlines()]
        followed = {round(int(words[0])): [float(word) for word in words[1:]] for words in self.lines["follow_pose"]}
        self.assertGreater(len(followed), 0.8 * len(path))
        found = 0
        for seconds, tx, ty, tz, qx, qy, qz, qw in path:
            if pose := followed.get(round(seconds * 1e6)):
                found += 1
                for a, b in zip(pose, (tx, ty, tz, qw, qx, qy, qz)):
                    self.assertAlmostEqual(a, b, 5)
        self.assertGreater(found, 0.8 * len(path))

    @unittest.skipUnless(options.language == "python", "the README shows Python")
    def test_the_subscriber_of_the_readme_prints_the_same_poses(self):
        self.assertLessEqual(len([line for line in readme_program().splitlines() if line]), 10)
        shown = {int(words[0]) for words in self.lines["readme"]}
        followed = {int(words[0]) for words in self.lines["follow_pose"]}
        self.assertGreater(len(shown & followed), 0.8 * len(followed))

    def test_the_points_listed_moved_more_than_the_threshold(self):
        lines = self.lines["list_deformed"]
        self.assertGreater(len(lines), 50)
        known = {}
        for frame, index, length, *place in lines:
            frame, index = int(frame), int(index)
            self.assertGreaterEqual(float(length), THRESHOLD - 0.005)
            if frame not in known:
                known[frame] = self.points(frame)
            point = known[frame][index]
            self.assertEqual(point[6], -1)
            for a, b in zip(place, point[:3]):
                self.assertAlmostEqual(float(a), b, 5)

    def test_the_overlay_lies_on_the_object(self):
        data = (self.folder / "overlay.ppm").read_bytes()
        head, _, pixels = data.partition(b"\n")
        self.assertEqual(head, b"P6 320 240 255")
        self.assertEqual(len(pixels), 3 * 320 * 240)
        drawn = {divmod(i // 3, 320)[::-1] for i in range(0, len(pixels), 3) if any(pixels[i:i + 3])}
        self.assertGreater(len(drawn), 500)
        # The picture is that of one of the last frames: its pixels are those of the observed points there.
        camera = {key: float(value) for key, value in camera_of(self.folder / "recording").items()
                  if key in ("fx", "fy", "cx", "cy")}
        lines = (self.folder / "path.txt").read_text().splitlines()
        # Simulated frames are a thirtieth of a second apart; where the base is not seen the path has no line.
        poses = {round(float(line.split()[0]) * 30): [float(word) for word in line.split()[1:]] for line in lines}

        def pixel(p):
            return round(camera["fx"] * p[0] / p[2] + camera["cx"]), round(camera["fy"] * p[1] / p[2] + camera["cy"])

        best = 0
        frames = sorted(int(file.stem) for file in (self.folder / "points").iterdir())
        for frame in frames:
            self.assertEqual(any(p[6] == 0 for p in self.points(frame)), frame in poses, frame)
        for frame in [frame for frame in frames if frame in poses][-12:]:
            pose = poses[frame]
            seen = [p for p in self.points(frame) if p[6] != -2 and p[2] > 0]
            # Points of the base stand exactly where its pose puts them; of what bends the files know a little more.
            base = {pixel(moved(pose, p[3:6])) for p in seen if p[6] == 0}
            all_of_them = {pixel(p) for p in seen} | base
            best = max(best, min(len(drawn & base) / max(1, len(base)), share_near(drawn, all_of_them)))
        self.assertGreater(best, 0.93)


def moved(pose, point):
    tx, ty, tz, qx, qy, qz, qw = pose
    x, y, z = point
    cx, cy, cz = qy * z - qz * y + qw * x, qz * x - qx * z + qw * y, qx * y - qy * x + qw * z
    return (x + 2 * (qy * cz - qz * cy) + tx, y + 2 * (qz * cx - qx * cz) + ty, z + 2 * (qx * cy - qy * cx) + tz)


def share_near(pixels, others):
    """The share of pixels that are at most one beside one of the others."""
    near = {(u + du, v + dv) for u, v in others for du in (-1, 0, 1) for dv in (-1, 0, 1)}
    return len(pixels & near) / max(1, len(pixels))


if __name__ == "__main__":
    unittest.main()
