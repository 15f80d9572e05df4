#!/usr/bin/env python3
"""subscribers.py PLIANT SUBSCRIBER [PAIRS]: latency and memory of a tracker alone and beside subscribers that are stopped,
killed, or never read, in alternating runs. Prints a table: the median of the runs' medians, of their 99th percentiles,
and of the pairs' ratios. Runs in a network of its own (tests/in_own_network.sh)."""

import pathlib
import statistics
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "examples"))
import subscribers_beside  # noqa: E402

pliant, subscriber = sys.argv[1:3]
pairs = int(sys.argv[3]) if len(sys.argv) > 3 else 10
FRAMES = 150  # five seconds

alone, beside = [], []
for pair in range(pairs):
    # Which comes first alternates too.
    for kind in (alone, beside) if pair % 2 == 0 else (beside, alone):
        if kind is alone:
            kind.append(subscribers_beside.track(pliant, FRAMES, "realtime"))
        else:
            with subscribers_beside.ailing_subscribers(subscriber, kill_after=2.5):
                kind.append(subscribers_beside.track(pliant, FRAMES, "realtime"))


def row(name, value, unit):
    a, b = ([value(figures) for figures in runs] for runs in (alone, beside))
    ratio = statistics.median(y / x for x, y in zip(a, b))
    print(f"| {name} | {statistics.median(a):.0f} {unit} | {statistics.median(b):.0f} {unit} | {ratio:.3f} |")


print(f"{pairs} pairs of runs of {FRAMES} frames at 30 Hz, alternating\n")
print("| | alone | beside them | ratio, median of the pairs |\n|---|---|---|---|")
row("latency, median", lambda f: f["latency_us"]["median_us"], "µs")
row("latency, p99", lambda f: f["latency_us"]["p99_us"], "µs")
row("resident memory", lambda f: f["rss_bytes"] / 1000, "kB")
row("frames tracked", lambda f: f["tracked"], "")
