#!/usr/bin/python3
"""Registers the shared cases with the program and prints their scores as a table.

    tests/accuracy/score_cases.py build/release/firmware-app/pliant [CASE...]

Needs ../shared/data and ../shared/evaluate beside the repository (or PLIANT_SHARED) and what evaluate.py needs:
python3-numpy, python3-scipy. Every line of the table stands against its bound; exit 1 when one is missed.
"""
import json
import os
import subprocess
import sys
import tempfile

SHARED = os.environ.get("PLIANT_SHARED", os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../shared"))
CASES = os.path.join(SHARED, "data/cases")
# Folder, scene, keypoints of model and scene (those of the paper where it names them).
RUNS = [("a_misaligned", "scene", "1800,1870"), ("a_misaligned", "scene", "4000,4100"),
        *[("b2_local_clutter_resampled", f"scene_n{n:03}_s0", "2048,2000") for n in (0, 10, 18, 30, 50, 100)],
        *[("b_local_clutter", f"scene_n{n:03}_s0", "2048,2000") for n in (0, 30, 100)],
        ("c_humanoid", "scene", "2048,2000"),
        ("d1_pillow", "scene", "2067,2654"), ("d2_pillow_clutter", "scene", "2425,2926")]


def register(pliant, folder, scene, keypoints, work):
    model, result, report = (os.path.join(work, name) for name in (f"{folder}.model", "result.ply", "report.json"))
    case = os.path.join(CASES, folder)
    if not os.path.exists(model):
        subprocess.run([pliant, "model", "build", f"{case}/model.ply", "-o", model], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    subprocess.run([pliant, "register", "--model", model, "--scene", f"{case}/{scene}.ply", "-o", result,
                    "--report", report, "--keypoints", keypoints], check=True, stdout=subprocess.DEVNULL)
    score = subprocess.run([sys.executable, os.path.join(SHARED, "evaluate/evaluate.py"), "case", case, result],
                           check=True, capture_output=True, text=True)
    return json.loads(score.stdout), json.load(open(report))


def faults(folder, scene, score):
    """What misses the bounds that this project sets itself."""
    pose, noise = score["pose"], int(scene[7:10]) if scene.startswith("scene_n") else 0
    out = []

    def bound(name, value, most):
        if value is None or value > most:
            out.append(f"{name} {value} over {most}")

    if folder == "a_misaligned":
        bound("rotation", pose["rotation_deg"], 0.3)
        bound("translation", pose["translation_mm"], 0.3)
    elif folder == "b2_local_clutter_resampled":
        deformed, wrong = score["deformed"], score["labels_wrong_share"]
        if noise <= 30:
            bound("wrong labels", wrong, 0.004)
            bound("1 - precision", 1 - deformed["precision"], 0.05)
            bound("1 - recall", 1 - deformed["recall"], 0.15)
        elif noise <= 50:
            bound("wrong labels", wrong, 0.008)
            bound("1 - F1", 1 - deformed["f1"], 0.2)
        bound("rotation", pose["rotation_deg"], 1)
        bound("translation", pose["translation_mm"], 1.5)
    elif folder == "c_humanoid":
        bound("parts missing", 3 - score["parts_found"], 0)
        for part in score["parts"].values():
            bound("1 - share", 1 - part["share"], 0.15)
            bound("rotation", part.get("rotation_deg"), 1.5)
            bound("translation", part.get("translation_mm"), 2)
    elif folder.startswith("d"):
        bound("rotation", pose["rotation_deg"], 1)
        bound("translation", pose["translation_mm"], 2)
        bound("1 - F1", 1 - score["deformed"]["f1"], 0.1)
    return out


def main():
    pliant, wanted = sys.argv[1], sys.argv[2:]
    missed = 0
    print("| case | keypoints | pose | wrong labels | precision / recall / F1 of deformed | parts: share, pose | ms |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as work:
        for folder, scene, keypoints in RUNS:
            if wanted and folder not in wanted or not os.path.exists(os.path.join(CASES, folder)):
                continue
            score, report = register(pliant, folder, scene, keypoints, work)
            pose, deformed = score["pose"], score.get("deformed") or {}
            labels = f"{100 * score['labels_wrong_share']:.2f} %" if "labels_wrong_share" in score else "–"
            share = " / ".join("–" if deformed.get(k) is None else f"{deformed[k]:.3f}" for k in ("precision", "recall", "f1"))
            parts = "; ".join(f"{100 * p['share']:.1f} %, {p.get('rotation_deg', 99):.2f}° {p.get('translation_mm', 99):.2f} mm"
                              for p in score.get("parts", {}).values()) or "–"
            name = f"{folder} {scene[6:]}".strip()
            print(f"| {name} | {report['keypoints']['model']} × {report['keypoints']['scene']} | {pose['rotation_deg']:.2f}° "
                  f"{pose['translation_mm']:.2f} mm | {labels} | {share} | {parts} | {report['timing_ms']['total']:.0f} |")
            for fault in faults(folder, scene, score):
                print(f"{name}: {fault}", file=sys.stderr)
                missed += 1
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
