"""Subscribers that ail, beside a tracker: one stopped, one killed on the way, one that never reads."""

import contextlib
import json
import pathlib
import signal
import socket
import subprocess
import tempfile
import threading
import time

GROUP, PORT = "239.255.76.67", 7667
URL = f"udpm://{GROUP}:{PORT}?ttl=0"


def wait_for_subscribers(count):
    """Until as many sockets as that listen on the port: a busy machine starts programs late."""
    end = time.monotonic() + 120
    while True:
        tables = [pathlib.Path(f"/proc/net/{name}") for name in ("udp", "udp6")]
        lines = [line for table in tables if table.exists() for line in table.read_text().splitlines()[1:]]
        if sum(line.split()[1].endswith(f":{PORT:04X}") for line in lines) >= count:
            return
        assert time.monotonic() < end, f"there are not {count} subscribers"
        time.sleep(0.05)


def joined_socket():
    """A socket in the group that nobody reads."""
    silent = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    silent.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    silent.bind((GROUP, PORT))
    silent.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + socket.inet_aton("0.0.0.0"))
    return silent


@contextlib.contextmanager
def ailing_subscribers(program, kill_after):
    """`program` is a subscriber that takes the URL; one of two is stopped at once, the other killed after some seconds."""
    running = [subprocess.Popen([program, URL], stdout=subprocess.DEVNULL) for _ in range(2)]
    wait_for_subscribers(2)
    silent = joined_socket()
    time.sleep(0.5)
    running[0].send_signal(signal.SIGSTOP)
    timer = threading.Timer(kill_after, running[1].kill)
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        for subscriber in running:
            subscriber.kill()
            subscriber.wait()
        silent.close()


def track(pliant, frames, pace):
    """The figures of a run."""
    with tempfile.TemporaryDirectory() as folder:
        stats = pathlib.Path(folder) / "stats.json"
        subprocess.run([pliant, "run", "--source", f"simulated:cushion?width=320&height=240&frames={frames}", "--pace", pace,
                        "--lcm-url", URL, "--stats", stats], stdout=subprocess.DEVNULL, check=True)
        return json.loads(stats.read_text())
