"""What `pliant export` makes of a log that the real lcm-logger wrote, and of its replay by lcm-logplayer, in a network
of the test's own. Arguments: the program, lcm-logger, lcm-logplayer, the examples' folder, the types' folder."""

import base64
import csv
import json
import math
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

SKIPPED = 77
URL = "udpm://239.255.76.67:7667?ttl=0"


def enter_network():
    """Runs this script again in a network of its own whose loopback carries multicast."""
    if os.environ.get("PLIANT_TEST_NETWORK") == "own":
        subprocess.run("ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo",
                       shell=True, check=True)
        return
    unshare = ["unshare", "--net"] if os.geteuid() == 0 else ["unshare", "--user", "--map-root-user", "--net"]
    if subprocess.run(unshare + ["ip", "link", "set", "lo", "up"], stderr=subprocess.DEVNULL).returncode != 0:
        print("no network of the test's own is permitted here")
        sys.exit(SKIPPED)
    os.environ["PLIANT_TEST_NETWORK"] = "own"
    os.execvp("unshare", unshare + [sys.executable, "-B"] + sys.argv)


enter_network()
program, logger, player, examples, types = sys.argv[1:6]
del sys.argv[1:]
sys.path.insert(0, examples)

import lcm_python  # noqa: E402
from mcap_reader import Mcap  # noqa: E402


class Logger:
    """lcm-logger at work on a file."""

    def __init__(self, path):
        self.path = path
        self.process = subprocess.Popen([logger, "--quiet", f"--lcm-url={URL}&recv_buf_size=2097152", str(path)])
        deadline = time.monotonic() + 20
        while not path.exists():  # made when the logger's self test is done
            assert time.monotonic() < deadline, "lcm-logger does not start"
            time.sleep(0.05)
        time.sleep(0.3)

    def stop(self):
        time.sleep(0.5)
        self.process.send_signal(signal.SIGINT)
        self.process.wait(20)


def read_points(path):
    data = path.read_bytes()
    header, _, body = data.partition(b"end_header\n")
    count = int(header.split(b"element vertex ")[1].split()[0])
    assert len(body) == count * 39
    return [struct.unpack_from("<6f2if3B", body, 39 * i) for i in range(count)]


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class Export(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        config = cls.config()
        # The network may lose what a busy machine has no time for; then once more.
        for _ in range(4):
            recorder = Logger(cls.folder / "run.log")
            cls.run_result = subprocess.run(
                [program, "run", "--source", "simulated:cushion?frames=75&width=320&height=240", "--pace", "realtime",
                 "--lcm-url", URL, "--trajectory", cls.folder / "path.txt", "--points", cls.folder / "points",
                 "--config", config], capture_output=True, text=True)
            recorder.stop()
            if cls.run_result.returncode != 0 or cls.has_every_frame(cls.folder / "run.log"):
                break
            for path in (cls.folder / "run.log", cls.folder / "path.txt"):
                path.unlink()
            shutil.rmtree(cls.folder / "points")
        cls.exported = cls.export("run.log", "first")

    @classmethod
    def has_every_frame(cls, log):
        """Whether the log holds as many frames and poses as the last status counts, and that status."""
        known = lcm_python.Types(types)
        events = [(channel, data) for _, channel, data in lcm_python.read_log(log)]
        statuses = [known.decode(data) for channel, data in events if channel == "PLIANT_STATUS"]
        if not statuses or statuses[-1].device != statuses[-1].DEVICE_ENDED:
            return False
        frames = {known.decode(data).frame for channel, data in events if channel == "PLIANT_REGIONS"}
        poses = sum(channel == "PLIANT_POSE" for channel, _ in events)
        last = statuses[-1]
        return len(frames) == last.tracked + last.searching + last.lost and poses == last.tracked

    @classmethod
    def config(cls):
        path = cls.folder / "depth.toml"
        path.write_text("[lcm]\npublish_depth = true\n")
        return path

    @classmethod
    def export(cls, log, name):
        out = cls.folder / name
        out.mkdir()
        return subprocess.run([program, "export", cls.folder / log, "--tum", out / "path.txt", "--ply", out / "ply",
                               "--csv", out / "csv", "--mcap", out / "all.mcap"], capture_output=True, text=True)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_run_and_export_end_well(self):
        self.assertEqual(self.run_result.returncode, 0, self.run_result.stderr)
        self.assertEqual(self.exported.returncode, 0, self.exported.stderr)
        self.assertEqual(self.exported.stderr, "")

    def test_the_path_is_that_of_the_run_to_the_last_digit(self):
        self.assertEqual((self.folder / "first/path.txt").read_text(), (self.folder / "path.txt").read_text())

    def test_points_lie_where_the_run_says(self):
        ours = sorted(path.name for path in (self.folder / "first/ply").iterdir())
        self.assertEqual(ours, sorted(path.name for path in (self.folder / "points").iterdir()))
        self.assertGreater(len(ours), 10)
        deformed = 0
        for name in ours[::10] + [ours[-1]]:
            mine, run = (read_points(self.folder / folder / name) for folder in ("first/ply", "points"))
            self.assertEqual(len(mine), len(run))
            for a, b in zip(mine, run):
                self.assertEqual(a[6], b[6])
                self.assertEqual(a[9:], b[9:])
                self.assertLess(max(abs(p - q) for p, q in zip(a[3:6], b[3:6])), 1e-5)
                self.assertNotEqual(a[8], a[8], "the residual is not published")
                if a[6] == -1:
                    deformed += 1
                    self.assertEqual(a[:3], b[:3])
        self.assertGreater(deformed, 0)

    def test_tables_hold_what_the_messages_say(self):
        known = lcm_python.Types(types)
        poses, regions, statuses, deformed = [], {}, [], []
        for _, channel, data in lcm_python.read_log(self.folder / "run.log"):
            if not channel.startswith("PLIANT_"):
                continue
            message = known.decode(data)
            if channel == "PLIANT_POSE":
                poses.append(message)
            elif channel == "PLIANT_REGIONS":
                regions[message.frame] = message
            elif channel == "PLIANT_STATUS":
                statuses.append(message)
            elif channel == "PLIANT_DEFORMED":
                deformed += message.strain
        frames = table(self.folder / "first/csv/frames.csv")
        self.assertEqual(len(frames), len(regions))
        energies = [float(row["strain_energy"]) for row in table(self.folder / "first/csv/status.csv")]
        self.assertEqual(len(energies), len(statuses))
        for energy, status in zip(energies, statuses):
            self.assertAlmostEqual(energy, status.strain_energy, delta=1e-5 * status.strain_energy)
        self.assertGreater(max(energies), 0, "the cushion is pressed")
        strains = [float(row["strain"]) for row in table(self.folder / "first/csv/deformed.csv")]
        self.assertEqual(len(strains), len(deformed))
        for strain, told in zip(strains, deformed):
            self.assertAlmostEqual(strain, told, delta=1e-5 * told)
        self.assertGreater(max(strains), 0)
        rows = table(self.folder / "first/csv/regions.csv")
        all_regions = [region for message in regions.values() for region in message.regions]
        self.assertEqual(len(rows), len(all_regions))
        for row, region in zip(rows, all_regions):
            for axis, told in zip("xyz", region.joint):
                self.assert_same_or_none(row["joint_" + axis], told)
        tracked = [row for row in frames if row["tx"]]
        self.assertEqual(len(tracked), len(poses))
        for row, pose in zip(tracked, poses):
            self.assertEqual(int(row["utime"]), pose.utime)
            self.assertAlmostEqual(float(row["tz"]), pose.trans[2], 8)
            self.assertAlmostEqual(float(row["qw"]), pose.quat[0], 8)

    def assert_same_or_none(self, written, told):
        if math.isnan(told):
            self.assertEqual(written, "")
        else:
            self.assertAlmostEqual(float(written), told, 5)

    def test_mcap_is_whole_and_holds_the_points_and_pictures(self):
        mcap = Mcap(self.folder / "first/all.mcap")
        self.assertEqual(mcap.schema_of("/pliant/points")[0], "foxglove.PointCloud")
        for name, encoding, text in mcap.schemas.values():
            self.assertEqual(encoding, "jsonschema")
            self.assertEqual(json.loads(text)["title"], name)
        clouds = [json.loads(data) for _, data in mcap.on("/pliant/points")]
        files = sorted((self.folder / "first/ply").iterdir())
        self.assertEqual(len(clouds), len(files))
        strained = 0
        for cloud, file in list(zip(clouds, files))[::20]:
            points = read_points(file)
            data = base64.b64decode(cloud["data"])
            self.assertEqual(len(data), cloud["point_stride"] * len(points))
            offsets = {field["name"]: field["offset"] for field in cloud["fields"]}
            for i, point in enumerate(points):
                at = i * cloud["point_stride"]
                self.assertEqual(struct.unpack_from("<3f", data, at + offsets["x"]), point[:3])
                self.assertEqual(struct.unpack_from("<b", data, at + offsets["region"])[0], point[6])
                self.assertEqual(tuple(data[at + offsets["red"]:at + offsets["blue"] + 1]), point[9:])
                strain = struct.unpack_from("<f", data, at + offsets["strain"])[0]
                strained += strain > 0
                self.assertTrue(strain == 0 or point[6] == -1, "only deformed points are strained")
        self.assertGreater(strained, 0)
        frames = [json.loads(data) for _, data in mcap.on("/pliant/frame")]
        base = next(frame for frame in frames if frame["regions"])["regions"][0]
        self.assertIsNone(base["joint"], "the base hangs on nothing")
        statuses = [json.loads(data) for _, data in mcap.on("/pliant/status")]
        self.assertGreater(max(status["strain_energy"] for status in statuses), 0)
        transforms = [json.loads(data) for _, data in mcap.on("/tf")]
        self.assertEqual(len(transforms), len(table(self.folder / "first/csv/regions.csv")))
        pictures = [json.loads(data) for _, data in mcap.on("/pliant/depth")]
        self.assertGreater(len(pictures), 10)
        readings = base64.b64decode(pictures[-1]["data"])
        self.assertEqual(len(readings), 320 * 240 * 2)
        middle = struct.unpack_from("<H", readings, 2 * (120 * 320 + 160))[0]
        self.assertTrue(300 < middle < 5000, middle)
        self.assertEqual(len(mcap.on("/pliant/camera")), len(pictures))

    def test_a_replay_by_lcm_logplayer_holds_the_same(self):
        def bodies(name):
            return [(channel, data) for _, channel, data in lcm_python.read_log(self.folder / name)
                    if channel.startswith("PLIANT_")]

        recorded = bodies("run.log")
        # The network may lose what a busy machine has no time for; then once more, slower.
        for speed in ("1", "0.3", "0.1", "0.05"):
            recorder = Logger(self.folder / "replay.log")
            subprocess.run([player, f"--speed={speed}", f"--lcm-url={URL}", self.folder / "run.log"], check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            recorder.stop()
            replayed = bodies("replay.log")
            if replayed == recorded:
                break
            (self.folder / "replay.log").unlink()
        self.assertTrue(replayed == recorded, f"{len(recorded)} messages were recorded, {len(replayed)} replayed")
        self.assertEqual(self.export("replay.log", "second").returncode, 0)
        for name in ("path.txt", "csv/frames.csv", "csv/regions.csv", "csv/deformed.csv", "csv/status.csv",
                     "csv/stages.csv"):
            self.assertEqual((self.folder / "first" / name).read_bytes(),
                             (self.folder / "second" / name).read_bytes(), name)

    def refused(self, *words):
        ended = subprocess.run([program, "export", *words], capture_output=True, text=True)
        self.assertEqual(ended.returncode, 2, ended.stderr)
        self.assertEqual(ended.stderr.count("\n"), 1, ended.stderr)
        return ended.stderr

    def test_what_cannot_be_exported_is_refused_in_one_line(self):
        log, out = self.folder / "run.log", self.folder / "refused"
        self.assertIn("--mcap", self.refused(log))
        self.assertIn("not an LCM log", self.refused(self.folder / "path.txt", "--tum", out))
        self.assertIn("--prefix PLIANT", self.refused(log, "--prefix", "OTHER", "--tum", out))
        self.assertIn("already holds", self.refused(log, "--ply", self.folder / "points"))
        self.assertFalse(out.exists())

    def test_a_log_cut_short_gives_what_is_whole(self):
        data = (self.folder / "run.log").read_bytes()
        cut = self.folder / "cut.log"
        cut.write_bytes(data[:len(data) // 2])
        ended = subprocess.run([program, "export", cut, "--tum", self.folder / "cut.txt"], capture_output=True,
                               text=True)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertIn("1 damaged stretch", ended.stderr)
        self.assertTrue((self.folder / "path.txt").read_text().startswith((self.folder / "cut.txt").read_text()))

    def test_what_follows_damage_in_a_log_is_exported(self):
        data = bytearray((self.folder / "run.log").read_bytes())
        middle = data.index(b"PLIANT_POSE", len(data) // 2)
        data[middle - 8:middle - 4] = b"\x7f\xff\xff\xff"  # the length of the channel's name
        (self.folder / "damaged.log").write_bytes(data)
        ended = subprocess.run([program, "export", self.folder / "damaged.log", "--tum", self.folder / "damaged.txt"],
                               capture_output=True, text=True)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertIn("1 damaged stretch", ended.stderr)
        all_lines = (self.folder / "path.txt").read_text().splitlines()
        lines = (self.folder / "damaged.txt").read_text().splitlines()
        self.assertEqual(len(lines), len(all_lines) - 1)
        self.assertEqual(lines[-1], all_lines[-1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
