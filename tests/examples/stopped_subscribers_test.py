"""Subscribers that are stopped, killed or never read cost the tracker nothing: what it counts and what it takes is the
same with and without them. (The latency beside them is a benchmark: ./dev bench --subscribers.)"""

import pathlib
import sys
import threading
import unittest

import languages
import subscribers_beside

options = languages.arguments()
sys.path.append(options.examples)
import lcm_python  # noqa: E402

FRAMES = 120
# Pages that a run takes or leaves by its own threads' timing.
MEMORY = 600_000


class LastStatus(threading.Thread):
    """Reads the statuses of one run."""

    def __init__(self):
        super().__init__(daemon=True)
        self.status = None
        types = lcm_python.Types(options.types)
        self.receiver = lcm_python.Receiver(subscribers_beside.URL)
        self.types = types
        self.start()

    def run(self):
        for channel, data in self.receiver:
            if channel == "PLIANT_STATUS":
                self.status = self.types.decode(data)
                if self.status.frame == FRAMES - 1 and self.status.device == 6:  # ended
                    return


class StoppedSubscribers(unittest.TestCase):
    def run_once(self):
        listener = LastStatus()
        figures = subscribers_beside.track(options.pliant, FRAMES, "fast")
        listener.join(10)
        self.assertFalse(listener.is_alive(), "the last status did not come")
        return figures, listener.status

    def test_neither_results_nor_counts_nor_memory_change(self):
        alone, _ = self.run_once()
        with subscribers_beside.ailing_subscribers(f"{options.built}/pliant_subscribe_example", kill_after=0.5):
            beside, status = self.run_once()
        print(f"memory {alone['rss_bytes']} and {beside['rss_bytes']} bytes; tracked {alone['tracked']} and "
              f"{beside['tracked']}")
        self.assertEqual(beside["output_sha256"], alone["output_sha256"])
        self.assertEqual(beside["tracked"], alone["tracked"])
        self.assertGreater(beside["tracked"], FRAMES // 2)
        self.assertEqual((beside["heap_calls_after_start"], beside["page_faults_after_start"]), (0, 0))
        # Nothing waited for them, was given up, or refused.
        self.assertEqual((status.unsent, status.send_failures), (0, 0))
        self.assertLess(abs(beside["rss_bytes"] - alone["rss_bytes"]), MEMORY)


if __name__ == "__main__":
    unittest.main()
