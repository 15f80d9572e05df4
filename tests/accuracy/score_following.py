#!/usr/bin/python3
"""Follows the shared sequences with every step and with each left out, and prints what they score as tables.

    tests/accuracy/score_following.py build/release/tests/accuracy/follow_sequence [SEQUENCE...]

Needs ../shared/data and ../shared/evaluate beside the repository (or PLIANT_SHARED) and what evaluate.py needs:
python3-numpy, python3-scipy, python3-pil. Every third tracked frame is scored. Takes some minutes.
"""
import glob
import json
import os
import subprocess
import sys
import tempfile

SHARED = os.environ.get("PLIANT_SHARED", os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../shared"))
SEQUENCES = ["sim_bunny_press", "sim_homer_joints", "sim_cheburashka_limbs", "sim_cushion_occlusion"]
STEPS = [("", "everything"), ("input_filter", "no input filter"), ("temporal_evidence", "no temporal evidence"),
         ("merge_and_split", "no merge and split"), ("robust_weights", "no robust weights")]


def score(sequence, points):
    for number, path in enumerate(sorted(glob.glob(f"{points}/*.ply"))):
        if number % 3:
            os.remove(path)
    result = subprocess.run([sys.executable, os.path.join(SHARED, "evaluate/evaluate.py"), "sequence", sequence, points],
                            check=True, capture_output=True, text=True)
    return json.loads(result.stdout)


def follow(program, sequence, step, out):
    line = subprocess.run([program, sequence, out, *([step] if step else [])], check=True, capture_output=True, text=True)
    return json.loads(line.stdout)


def pair(percentiles):
    if not percentiles or percentiles["median_mm"] is None:
        return "–"
    return f"{percentiles['median_mm']:.1f} / {percentiles['p95_mm']:.1f}"


def share(value):
    return "–" if value is None else f"{value:.3f}"


def main():
    program, sequences = sys.argv[1], sys.argv[2:] or SEQUENCES
    print("| sequence | | base | rigid points, mm | deformed points, mm | wrong | false deformed | F1 | whole "
          "| changes of region a frame | regions came | ms a frame |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    placings = []
    for name in sequences:
        sequence = os.path.join(SHARED, "data", name)
        for step, words in STEPS:
            with tempfile.TemporaryDirectory() as work:
                run = follow(program, sequence, step, work)
                scores = {folder: score(sequence, f"{work}/{folder}")
                          for folder in (("warp", "rigid", "radius") if not step else ("warp",))}
                s = scores["warp"]
                base = "–" if s["rotation_deg_median"] is None else \
                    f"{s['rotation_deg_median']:.2f}° {s['translation_mm_median']:.2f} mm, {s['false_poses']} false"
                print(f"| {name} | {words} | {base} | {pair(s['position_rigid'])} | {pair(s['position_deformed'])} "
                      f"| {share(s['wrong_rigid_share'])} | {share(s['false_deformed_share'])} | {share(s['deformed_f1'])} "
                      f"| {share(s.get('parts_whole_share'))} | {run['region_changes'] / max(1, run['tracked']):.1f} "
                      f"| {run['regions_came']} | {run['frame_us'] / 1000:.2f} |", flush=True)
                if not step:
                    placings.append((name, run, scores))
    print("\n| sequence | | all points, mm | deformed points, mm | hidden points, mm | ms a frame |")
    print("|---|---|---|---|---|---|")
    for name, run, scores in placings:
        for folder, words in (("rigid", "rigid only"), ("radius", "radius search"), ("warp", "warp")):
            # The plain placings stand in for the warp; which rigid point is nearest a tracker would keep in a table.
            s, extra = scores[folder], {"rigid": 0, "radius": run["radius_us"] - run["rigid_us"], "warp": run["warp_us"]}
            took = run["frame_us"] - run["warp_us"] + extra[folder]
            print(f"| {name} | {words} | {pair(s['position_all'])} | {pair(s['position_deformed'])} "
                  f"| {pair(s['position_hidden'])} | {took / 1000:.2f} |")


if __name__ == "__main__":
    main()
