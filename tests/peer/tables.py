#!/usr/bin/python3
"""The tables of BENCHMARK.md that stand beside PCL's: tests/peer/tables.py COMPARE_WITH_PCL PLIANT

COMPARE_WITH_PCL and PLIANT are the programs; needs ../shared beside the repository (or PLIANT_SHARED) and
python3-numpy, python3-scipy for the labels.
"""
import json
import os
import subprocess
import sys
import tempfile

SHARED = os.environ.get("PLIANT_SHARED", os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../shared"))
CASES = os.path.join(SHARED, "data/cases")
HEAD = """| case | keypoints, Pliant | PCL | Pliant, ms: normals keypoints descriptors matching grouping chain deformed | PCL, ms: normals keypoints descriptors matching grouping | ratio | pose, Pliant | pose, PCL |
|---|---|---|---|---|---|---|---|"""


def compare(program, case, scene, model, keys, runs, labels=None):
    command = [program, os.path.join(CASES, case), scene, str(model), str(keys), str(runs)]
    done = subprocess.run(command + ([labels] if labels else []), check=True, capture_output=True, text=True)
    return done.stdout.rstrip()


def evaluate(case, result):
    done = subprocess.run([sys.executable, os.path.join(SHARED, "evaluate/evaluate.py"), "case",
                           os.path.join(CASES, case), result], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def labels(score):
    deformed = score["deformed"]
    return f"{100 * score['labels_wrong_share']:.2f} % | {deformed['f1'] or 0:.3f}"


def main():
    program, pliant = sys.argv[1:3]
    print("### The same keypoints\n\n" + HEAD)
    for case, model, keys in (("a_misaligned", 1800, 1870), ("a_misaligned", 4000, 4100), ("d1_pillow", 2067, 2654),
                              ("d2_pillow_clutter", 2425, 2926)):
        print(compare(program, case, "scene.ply", model, keys, 7), flush=True)
    print("\n### Times against the sampling factor (the paper's Fig. 5): seven steps of −20 %\n\n" + HEAD)
    keys = 360.0
    for _ in range(8):
        print(compare(program, "a_misaligned", "scene.ply", int(keys), int(keys), 3), flush=True)
        keys /= 0.64
    print("\n### Wrong labels against noise (the paper's Fig. 7)\n")
    print("| noise, % of the spacing | Pliant: wrong | F1 of deformed | PCL with ICP: wrong | F1 of deformed |\n|---|---|---|---|---|")
    case = "b2_local_clutter_resampled"
    with tempfile.TemporaryDirectory() as work:
        model, ours, theirs = (os.path.join(work, n) for n in ("m.model", "ours.ply", "theirs.ply"))
        subprocess.run([pliant, "model", "build", os.path.join(CASES, case, "model.ply"), "-o", model], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for noise in (0, 10, 18, 30, 50, 100):
            scene = f"scene_n{noise:03}_s0.ply"
            subprocess.run([pliant, "register", "--model", model, "--scene", os.path.join(CASES, case, scene), "-o", ours],
                           check=True, stdout=subprocess.DEVNULL)
            if os.path.exists(theirs):
                os.remove(theirs)
            compare(program, case, scene, 1800, 2000, 1, theirs)
            peer = labels(evaluate(case, theirs)) if os.path.exists(theirs) else "not found | –"
            print(f"| {noise} | {labels(evaluate(case, ours))} | {peer} |", flush=True)


if __name__ == "__main__":
    main()
