#!/usr/bin/env python3
"""Prints what a tracker publishes: python3 subscribe.py [--url URL] [--prefix PLIANT] [--types FOLDER] [--log FILE]"""

import argparse
import math
import pathlib

import lcm_python


def hangs_at(joint):
    """Empty for the base and where a region does not touch its parent: the joint is not a number there."""
    return "" if any(map(math.isnan, joint)) else " at " + " ".join(f"{value:+.3f}" for value in joint)


def describe(kind, message):
    if kind == "POSE":
        x, y, z = message.trans
        return f"pose      x {x:+.4f}  y {y:+.4f}  z {z:+.4f} m   quaternion " + " ".join(
            f"{q:+.4f}" for q in message.quat)
    if kind == "REGIONS":
        state = {message.SEARCHING: "searching", message.TRACKING: "tracking", message.LOST: "lost"}[message.state]
        parts = ", ".join(f"{region.id}: {region.points} points, rms {1000 * region.rms:.2f} mm{hangs_at(region.joint)}"
                          for region in message.regions)
        deformed = sum(label == message.DEFORMED for label in message.labels)
        hidden = sum(label == message.NOT_OBSERVED for label in message.labels)
        return f"regions   frame {message.frame} {state}  [{parts}]  {deformed} deformed, {hidden} not observed"
    if kind == "DEFORMED":
        lengths = [(dx * dx + dy * dy + dz * dz) ** 0.5 for dx, dy, dz in message.displacement]
        most = 1000 * max(lengths, default=0)
        strain = 100 * max(message.strain, default=0)
        return (f"deformed  {message.num_points} of {message.num_deformed} points, moved up to {most:.1f} mm, "
                f"strained up to {strain:.1f} %")
    if kind == "STATUS":
        return (f"status    {message.rate:.1f} frames/s, latency {message.latency_median / 1000:.1f} ms, "
                f"{message.tracked} tracked, {message.lost} lost, {message.dropped} dropped, "
                f"strain energy {message.strain_energy:.3f} {message.last_error}")
    return f"{kind.lower()}"


def main():
    parser = argparse.ArgumentParser(description="Prints what a tracker publishes over LCM.")
    parser.add_argument("--url", default=lcm_python.DEFAULT_URL)
    parser.add_argument("--prefix", default="PLIANT")
    parser.add_argument("--types", default=pathlib.Path(__file__).resolve().parents[2] / "drivers/lcm/types")
    parser.add_argument("--log", help="read a log of lcm-logger instead of the network")
    options = parser.parse_args()

    known = lcm_python.Types(options.types)
    if options.log:
        messages = ((channel, data) for _, channel, data in lcm_python.read_log(options.log))
    else:
        messages = lcm_python.Receiver(options.url)
    try:
        for channel, data in messages:
            prefix, _, kind = channel.rpartition("_")
            if prefix != options.prefix:
                continue
            try:
                print(describe(kind, known.decode(data)), flush=True)
            except lcm_python.DecodeError as error:
                print(f"{channel}: {error}", flush=True)
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
