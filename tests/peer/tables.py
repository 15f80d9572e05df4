#!/usr/bin/python3
"""The tables, plots and pictures of BENCHMARK.md that stand beside PCL's: tests/peer/tables.py PROGRAMS PLIANT OUT

PROGRAMS is the folder of compare_with_pcl and draw_registration, PLIANT the program; plots and pictures go to OUT. Needs ../shared beside the repository (or PLIANT_SHARED) and
python3-numpy, python3-scipy for the labels.
"""
import json
import os
import re
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


STAGES = ("normals", "keypoints", "descriptors", "matching", "grouping")
COLOURS = ("#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#56b4e9")


def plot(path, title, x_name, y_name, curves, logarithmic):
    """Curves {name: [(x, y), ...]} as an SVG file."""
    import math
    width, height, left, right, top, bottom = 720, 420, 70, 190, 40, 50
    xs = [x for c in curves.values() for x, _ in c]
    ys = [y for c in curves.values() for _, y in c]
    scale = (lambda v: math.log10(max(v, 1e-3))) if logarithmic else (lambda v: v)
    x0, x1 = min(xs), max(xs)
    y0, y1 = (math.floor(scale(min(ys))), math.ceil(scale(max(ys)))) if logarithmic else (0, max(ys) * 1.1)

    def at(x, y):
        return (left + (width - left - right) * (x - x0) / (x1 - x0),
                height - bottom - (height - top - bottom) * (scale(y) - y0) / (y1 - y0))

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
           f'font-size="12"><rect width="100%" height="100%" fill="white"/><text x="{left}" y="22" font-size="15">{title}</text>']
    ticks = [10.0 ** k for k in range(y0, y1 + 1)] if logarithmic else [y1 * k / 5 for k in range(6)]
    for y in ticks:
        _, v = at(x0, y)
        out.append(f'<path d="M{left} {v:.1f}H{width - right}" stroke="#ddd"/><text x="{left - 6}" y="{v + 4:.1f}" '
                   f'text-anchor="end">{y:.3g}</text>')
    for x in sorted(set(xs)):
        u, _ = at(x, ticks[0])
        out.append(f'<text x="{u:.1f}" y="{height - bottom + 18}" text-anchor="middle" font-size="10">{x:g}</text>')
    out.append(f'<text x="{(left + width - right) / 2}" y="{height - 8}" text-anchor="middle">{x_name}</text>'
               f'<text x="12" y="{top - 6}">{y_name}</text>')
    for k, (name, curve) in enumerate(curves.items()):
        colour, dash = COLOURS[k % 6], ' stroke-dasharray="5 3"' if name.startswith("PCL") else ""
        points = " ".join("%.1f,%.1f" % at(x, y) for x, y in curve)
        out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"{dash}/>'
                   f'<path d="M{width - right + 10} {top + 16 * k}h22" stroke="{colour}" stroke-width="2"{dash}/>'
                   f'<text x="{width - right + 38}" y="{top + 4 + 16 * k}">{name}</text>')
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(out) + "\n</svg>\n")


def times(row):
    """Times of the stages of Pliant (the first five) and of PCL from a row of compare_with_pcl."""
    cells = [c.strip() for c in row.split("|")]
    ours, theirs = ([float(x) for x in re.findall(r"[0-9.]+", cells[k].split("=")[0])] for k in (4, 5))
    return ours[:5], theirs[:5]


def main():
    programs, pliant, out = sys.argv[1:4]
    program = os.path.join(programs, "compare_with_pcl")
    print("### The same keypoints\n\n" + HEAD)
    for case, model, keys in (("a_misaligned", 1800, 1870), ("a_misaligned", 4000, 4100), ("d1_pillow", 2067, 2654),
                              ("d2_pillow_clutter", 2425, 2926)):
        print(compare(program, case, "scene.ply", model, keys, 7), flush=True)
    print("\n### Times against the sampling factor (the paper's Fig. 5): seven steps of −20 %\n\n" + HEAD)
    keys = 360.0
    curves = {f"{who}: {stage}": [] for who in ("Pliant", "PCL") for stage in STAGES}
    for _ in range(8):
        row = compare(program, "a_misaligned", "scene.ply", int(keys), int(keys), 3)
        print(row, flush=True)
        for who, each in zip(("Pliant", "PCL"), times(row)):
            for stage, ms in zip(STAGES, each):
                curves[f"{who}: {stage}"].append((int(keys), ms))
        keys /= 0.64
    plot(os.path.join(out, "stage_times.svg"), "Times of the five tasks, a_misaligned", "keypoints of model and scene",
         "ms", curves, True)
    print("\n### The articulated figure (the paper's Fig. 10)\n\n" + HEAD)
    print(compare(program, "c_humanoid", "scene.ply", 2048, 2000, 3), flush=True)
    print("\n### Wrong labels against noise (the paper's Fig. 7)\n")
    print("| noise, % of the spacing | Pliant: wrong | F1 of deformed | PCL with ICP: wrong | F1 of deformed |\n|---|---|---|---|---|")
    case = "b2_local_clutter_resampled"
    wrong = {"Pliant": [], "PCL with ICP": []}
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
            mine = labels(evaluate(case, ours))
            print(f"| {noise} | {mine} | {peer} |", flush=True)
            for who, text in (("Pliant", mine), ("PCL with ICP", peer)):
                if "%" in text:
                    wrong[who].append((noise, float(text.split("%")[0])))
    plot(os.path.join(out, "label_errors.svg"), "Wrong labels against noise, b2_local_clutter_resampled",
         "noise, % of the point spacing", "wrong, %", wrong, False)
    for case, model, keys in (("d1_pillow", 2067, 2654), ("d2_pillow_clutter", 2425, 2926), ("c_humanoid", 2048, 2000)):
        subprocess.run([os.path.join(programs, "draw_registration"), os.path.join(CASES, case), "scene.ply",
                        os.path.join(out, case + ".png"), str(model), str(keys)], check=True)


if __name__ == "__main__":
    main()
