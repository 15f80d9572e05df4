"""Subscribers that are stopped, killed or never read change neither the tracker's latency nor its memory."""

import json
import pathlib
import signal
import socket
import subprocess
import tempfile
import time
import unittest

import languages

options = languages.arguments()
GROUP, PORT = "239.255.76.67", 7667
URL = f"udpm://{GROUP}:{PORT}?ttl=0"


def track(folder, meanwhile=None):
    """The figures of three seconds of tracking."""
    stats = folder / "stats.json"
    run = subprocess.Popen([options.pliant, "run", "--source", "simulated:box?width=320&height=240&frames=100", "--pace",
                            "realtime", "--lcm-url", URL, "--stats", stats], stdout=subprocess.DEVNULL)
    if meanwhile:
        time.sleep(1)
        meanwhile()
    assert run.wait() == 0
    return json.loads(stats.read_text())


class Silent:
    """A socket that joins the group and never reads."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.bind((GROUP, PORT))
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                               socket.inet_aton(GROUP) + socket.inet_aton("0.0.0.0"))


class StoppedSubscribers(unittest.TestCase):
    def compare(self, folder):
        alone = track(folder)
        subscribers = [subprocess.Popen([f"{options.built}/pliant_subscribe_example", URL], stdout=subprocess.DEVNULL)
                       for _ in range(2)]
        silent = Silent()
        time.sleep(0.5)
        subscribers[0].send_signal(signal.SIGSTOP)
        beside = track(folder, meanwhile=subscribers[1].kill)
        subscribers[0].kill()
        for subscriber in subscribers:
            subscriber.wait()
        silent.socket.close()
        return alone, beside

    def test_neither_latency_nor_memory_change(self):
        with tempfile.TemporaryDirectory() as name:
            # What does not depend on the machine's other work must hold each time; times at least once in three.
            for attempt in range(3):
                alone, beside = self.compare(pathlib.Path(name))
                for figures in (alone, beside):
                    self.assertEqual(figures["heap_calls_after_start"], 0)
                    self.assertGreater(figures["tracked"], 20)
                self.assertLess(beside["rss_bytes"], alone["rss_bytes"] + 1_500_000)
                before, after = (figures["latency_us"]["median_us"] for figures in (alone, beside))
                print(f"latency alone {before} us, beside {after} us; memory {alone['rss_bytes']} and "
                      f"{beside['rss_bytes']} bytes; tracked {alone['tracked']} and {beside['tracked']}")
                if after < 1.2 * before + 500:
                    return
            self.fail("the latency grew each time")


if __name__ == "__main__":
    unittest.main()
