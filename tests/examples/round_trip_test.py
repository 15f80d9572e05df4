"""Every message type, as the real publisher sends it, decoded and encoded again in one language: the same bytes."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import languages

options = languages.arguments()
sys.path.insert(0, options.examples)
import lcm_python  # noqa: E402

# As the bot_core message package has it.
ORIGINAL_POSE = """package bot_core;
struct rigid_transform_t
{
  int64_t utime;
  double trans[3];
  double quat[4]; // w, x, y, z
}
"""


class RoundTrip(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        (cls.folder / "depth.toml").write_text("[lcm]\npublish_depth = true\n")
        cls.log = cls.folder / "run.log"
        subprocess.run([options.pliant, "run", "--config", cls.folder / "depth.toml", "--source",
                        "simulated:cushion?width=320&height=240&frames=60", "--lcm-url", f"file://{cls.log}?mode=w"],
                       check=True, stdout=subprocess.DEVNULL)
        cls.events = [(channel, data) for _, channel, data in lcm_python.read_log(cls.log)]
        cls.counts = {}
        for channel, _ in cls.events:
            cls.counts[channel] = cls.counts.get(channel, 0) + 1

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_every_type_is_there_and_small(self):
        self.assertEqual(set(self.counts), {f"PLIANT_{kind}" for kind in
                                            ("POSE", "REGIONS", "DEFORMED", "STATUS", "DEPTH", "MODEL")})
        for channel, data in self.events:
            self.assertLessEqual(len(data), 60000 if channel == "PLIANT_DEPTH" else 16000, channel)

    def test_every_message_comes_back_to_the_byte(self):
        getattr(self, "round_trip_" + options.language)()

    def told(self, words):
        run = subprocess.run(words, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertEqual({line.split()[0]: int(line.split()[1]) for line in run.stdout.splitlines()}, self.counts)

    def round_trip_cpp(self):
        self.told([options.round_trip, self.log])

    def round_trip_java(self):
        classes = self.folder / "java"
        classes.mkdir()
        path = languages.compile_java(options, classes, [pathlib.Path(__file__).parent / "RoundTrip.java"])
        self.told([options.java, "-cp", path, "RoundTrip", str(self.log)])

    def round_trip_python(self):
        generated = self.folder / "python"
        generated.mkdir()
        languages.generate(options, "python", generated)
        sys.path.insert(0, str(generated))
        import bot_core
        import pliant
        kinds = {"POSE": bot_core.rigid_transform_t, "REGIONS": pliant.regions_t, "DEFORMED": pliant.deformed_t,
                 "STATUS": pliant.status_t, "DEPTH": pliant.depth_t, "MODEL": pliant.model_t}
        known = lcm_python.Types(options.types)
        for channel, data in self.events:
            kind = kinds[channel.removeprefix("PLIANT_")]
            self.assertEqual(kind.decode(data).encode(), data, channel)
            # The examples' own decoder reads the same.
            ours, theirs = known.decode(data), kind.decode(data)
            for field in kind.__slots__:
                if field != "regions":
                    mine, other = getattr(ours, field), getattr(theirs, field)
                    self.assertEqual(list(map(str, mine)) if isinstance(mine, (list, tuple)) else mine,
                                     list(map(str, other)) if isinstance(other, (list, tuple)) else other,
                                     f"{channel} {field}")

    @unittest.skipUnless(options.language == "python", "once is enough")
    def test_poses_decode_with_the_original_definition(self):
        folder = self.folder / "original"
        folder.mkdir()
        (folder / "rigid_transform_t.lcm").write_text(ORIGINAL_POSE)
        original = lcm_python.Types(folder)
        ours = lcm_python.Types(options.types)
        poses = [data for channel, data in self.events if channel == "PLIANT_POSE"]
        self.assertGreater(len(poses), 50)
        for data in poses:
            decoded = original.decode(data)
            self.assertEqual((decoded.utime, decoded.trans, decoded.quat),
                             (lambda m: (m.utime, m.trans, m.quat))(ours.decode(data)))
        script = ("import sys; sys.path.insert(0, sys.argv[1]); import bot_core; "
                  "print(bot_core.rigid_transform_t.decode(open(sys.argv[2], 'rb').read()).quat[0])")
        subprocess.run([options.lcm_gen, "--python", "--ppath", str(folder), str(folder / "rigid_transform_t.lcm")],
                       check=True)
        (folder / "pose").write_bytes(poses[-1])
        run = subprocess.run([sys.executable, "-B", "-c", script, folder, folder / "pose"], capture_output=True, text=True)
        self.assertEqual(run.stdout.strip(), str(ours.decode(poses[-1]).quat[0]), run.stderr)


if __name__ == "__main__":
    unittest.main()
