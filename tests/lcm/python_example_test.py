"""The Python example, against the classes that lcm-gen makes. Arguments: folders of the examples, of the types and
of the generated classes."""

import math
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import unittest

examples, type_files, generated = (pathlib.Path(argument) for argument in sys.argv[1:4])
sys.path[:0] = [str(examples), str(generated)]

import bot_core  # noqa: E402
import lcm_python  # noqa: E402
import pliant  # noqa: E402

TYPES = lcm_python.Types(type_files)


def sample_regions():
    message = pliant.regions_t()
    message.utime, message.frame, message.model_id = 1700000000000000, 7, -5
    message.state, message.confidence, message.parts = message.TRACKING, 0.5, 1
    for number in range(2):
        region = pliant.region_t()
        region.id, region.parent, region.points = number, number - 1, 100 + number
        region.rms, region.confidence = 0.25, 0.75
        region.trans, region.quat = (0.1, 0.2, 0.3), (1.0, 0.0, 0.0, 0.0)
        region.joint = (float("nan"),) * 3 if number == 0 else (0.5, 0.25, 0.75)
        message.regions.append(region)
    message.num_regions = 2
    message.labels = [0, 1, -1, -2, 0]
    message.model_points = message.num_labels = 5
    return message


def sample_deformed():
    message = pliant.deformed_t()
    message.num_points = message.num_deformed = 2
    message.parts = 1
    message.index = [3, 9]
    message.position = [(1.0, 2.0, 3.0), (4.0, 5.0, 6.0)]
    message.displacement = [(0.5, 0.25, 0.125), (0.0, 0.0, -1.0)]
    message.strain = [0.125, 0.0]
    return message


def sample_status():
    message = pliant.status_t()
    message.version, message.source, message.last_error = "0.1.0", "simulated:cushion", "é"
    message.rate, message.strain_energy, message.num_stages = 30.0, 0.5, 2
    message.stage = ["surface", "total"]
    message.stage_median, message.stage_p99, message.stage_max = [1, 2], [3, 4], [5, 6]
    return message


class PythonExample(unittest.TestCase):
    def test_fingerprints_are_the_generated_ones(self):
        for name, package in (("rigid_transform_t", bot_core), ("region_t", pliant), ("regions_t", pliant),
                              ("deformed_t", pliant), ("status_t", pliant), ("depth_t", pliant),
                              ("model_t", pliant)):
            expected = getattr(package, name)._get_packed_fingerprint()
            self.assertEqual(TYPES.fingerprint(TYPES.by_name[name]), int.from_bytes(expected, "big"), name)

    def test_decodes_what_the_generated_classes_encode(self):
        pose = bot_core.rigid_transform_t()
        pose.utime, pose.trans, pose.quat = 5, (1.0, 2.0, 3.0), (0.5, 0.5, 0.5, 0.5)
        decoded = TYPES.decode(pose.encode())
        self.assertEqual((decoded.utime, decoded.trans, decoded.quat), (5, pose.trans, pose.quat))

        decoded = TYPES.decode(sample_regions().encode())
        self.assertEqual(decoded.type_name, "regions_t")
        self.assertEqual(decoded.state, decoded.TRACKING)
        self.assertEqual(list(decoded.labels), [0, 1, decoded.DEFORMED, decoded.NOT_OBSERVED, 0])
        self.assertEqual([region.points for region in decoded.regions], [100, 101])
        self.assertEqual(decoded.regions[1].quat, (1.0, 0.0, 0.0, 0.0))
        self.assertEqual(decoded.regions[1].joint, (0.5, 0.25, 0.75))
        self.assertTrue(all(math.isnan(value) for value in decoded.regions[0].joint))

        decoded = TYPES.decode(sample_deformed().encode())
        self.assertEqual(decoded.index, (3, 9))
        self.assertEqual([tuple(point) for point in decoded.position], [(1.0, 2.0, 3.0), (4.0, 5.0, 6.0)])
        self.assertEqual(tuple(decoded.displacement[1]), (0.0, 0.0, -1.0))
        self.assertEqual(decoded.strain, (0.125, 0.0))

        decoded = TYPES.decode(sample_status().encode())
        self.assertEqual((decoded.version, decoded.last_error), ("0.1.0", "é"))
        self.assertEqual(decoded.stage, ["surface", "total"])
        self.assertEqual(decoded.stage_max, (5, 6))
        self.assertEqual(decoded.strain_energy, 0.5)

    def test_refuses_every_cut(self):
        for message in (sample_regions(), sample_deformed(), sample_status()):
            data = message.encode()
            for length in range(len(data)):
                with self.assertRaises(lcm_python.DecodeError):
                    TYPES.decode(data[:length])
            with self.assertRaises(lcm_python.DecodeError):
                TYPES.decode(data + b"\0")

    def test_receives_short_and_fragmented_messages(self):
        receiver = lcm_python.Receiver("udpm://239.255.76.67:17667?ttl=0", timeout=5)
        sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(receiver.close)
        self.addCleanup(sender.close)
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        to = ("239.255.76.67", 17667)
        try:
            sender.sendto(b"LC02" + struct.pack(">I", 0) + b"A_POSE\0body", to)
        except OSError as error:
            self.skipTest(f"no multicast here: {error}")
        self.assertEqual(next(receiver), ("A_POSE", b"body"))
        data = bytes(range(256)) * 8
        for index, offset in enumerate(range(0, len(data), 1000)):
            header = b"LC03" + struct.pack(">IIIHH", 1, len(data), offset, index, 3)
            sender.sendto(header + (b"BIG\0" if index == 0 else b"") + data[offset:offset + 1000], to)
        sender.sendto(b"no LCM at all", to)
        self.assertEqual(next(receiver), ("BIG", data))

    def test_the_program_prints_a_log(self):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "track.log"
            with open(log, "wb") as out:
                for number, (channel, message) in enumerate((("PLIANT_REGIONS", sample_regions()),
                                                             ("PLIANT_DEFORMED", sample_deformed()),
                                                             ("OTHER_STATUS", sample_status()),
                                                             ("PLIANT_STATUS", sample_status()))):
                    data = message.encode()
                    out.write(struct.pack(">IqqII", 0xEDA1DA01, number, 0, len(channel), len(data)))
                    out.write(channel.encode() + data)
            run = subprocess.run([sys.executable, "-B", str(examples / "subscribe.py"), "--log", str(log), "--types",
                                  str(type_files)], capture_output=True, text=True, check=True)
        lines = run.stdout.splitlines()
        self.assertEqual(len(lines), 3, run.stdout)
        self.assertIn("frame 7 tracking", lines[0])
        self.assertIn("1 deformed, 1 not observed", lines[0])
        self.assertIn("[0: 100 points, rms 250.00 mm, 1: 101 points, rms 250.00 mm at +0.500 +0.250 +0.750]", lines[0])
        self.assertIn("moved up to 1000.0 mm, strained up to 12.5 %", lines[1])
        self.assertIn("30.0 frames/s", lines[2])
        self.assertIn("strain energy 0.500", lines[2])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
