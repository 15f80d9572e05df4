#!/usr/bin/python3
"""The tables, plots and pictures of BENCHMARK.md that stand beside PCL's: tests/peer/tables.py PROGRAMS PLIANT OUT

PROGRAMS is the folder of compare_with_pcl and draw_registration, PLIANT the program; plots and pictures go to OUT. Needs ../shared beside the repository (or PLIANT_SHARED) and
python3-numpy, python3-scipy for the labels.
"""
import json
import math
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


def number(value):
    return f"{value:,.10g}".replace(",", "\u202f")


class Axis:
    """Values to pixels, on a linear scale from 0 or on a logarithmic one, with round ticks."""

    def __init__(self, values, pixels, logarithmic, steps):
        self.logarithmic, (self.first, self.last) = logarithmic, pixels
        if logarithmic:
            # Ticks at 1, 2 and 5 of each decade, or at the decades alone where that would be many.
            low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
            ticks = [m * 10.0 ** k for k in range(low, high + 1) for m in (1, 2, 5)]
            if sum(min(values) <= t <= max(values) for t in ticks) > steps:
                ticks = [10.0 ** k for k in range(low, high + 1)]
            below, above = [t for t in ticks if t <= min(values)], [t for t in ticks if t >= max(values)]
            self.ticks = [t for t in ticks if below[-1] <= t <= above[0]]
        else:
            step = next(m * 10.0 ** k for k in range(-6, 9) for m in (1, 2, 5) if max(values) <= steps * m * 10.0 ** k)
            self.ticks = [step * k for k in range(math.ceil(max(values) / step) + 1)]
        self.low, self.high = self.scale(self.ticks[0]), self.scale(self.ticks[-1])

    def scale(self, value):
        return math.log10(value) if self.logarithmic else value

    def at(self, value):
        return self.first + (self.last - self.first) * (self.scale(value) - self.low) / (self.high - self.low)


def plot(path, title, x_name, y_name, curves, logarithmic, missing=()):
    """Curves {name: [(x, y), ...]} as an SVG file. A name "WHO: WHAT" has WHAT's colour, and PCL's curves are dashed.
    `missing` [(name, x), ...]: what gave no value, marked at the upper edge."""
    width, height, left, right, top, bottom = 720, 420, 60, 200, 56, 50
    x_axis = Axis([x for c in curves.values() for x, _ in c] + [x for _, x in missing], (left, width - right), logarithmic, 10)
    y_axis = Axis([y for c in curves.values() for _, y in c], (height - bottom, top), logarithmic, 7)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
           f'font-size="12"><rect width="100%" height="100%" fill="white"/><text x="{left}" y="22" font-size="15">{title}</text>'
           f'<text x="{left}" y="{top - 14}">{y_name}</text>']
    for y in y_axis.ticks:
        v = y_axis.at(y)
        out.append(f'<path d="M{left} {v:.1f}H{width - right}" stroke="#ddd"/><text x="{left - 6}" y="{v + 4:.1f}" '
                   f'text-anchor="end">{number(y)}</text>')
    for x in x_axis.ticks:
        u = x_axis.at(x)
        out.append(f'<path d="M{u:.1f} {top}V{height - bottom}" stroke="#eee"/><text x="{u:.1f}" '
                   f'y="{height - bottom + 18}" text-anchor="middle">{number(x)}</text>')
    out.append(f'<text x="{(left + width - right) / 2}" y="{height - 8}" text-anchor="middle">{x_name}</text>')
    kinds = list(dict.fromkeys(name.split(": ")[-1] for name in curves))
    for k, (name, curve) in enumerate(curves.items()):
        colour = COLOURS[kinds.index(name.split(": ")[-1])]
        dash = ' stroke-dasharray="5 3"' if name.startswith("PCL") else ""
        points = [(x_axis.at(x), y_axis.at(y)) for x, y in curve]
        path_points = " ".join(f"{u:.1f},{v:.1f}" for u, v in points)
        out.append(f'<polyline points="{path_points}" fill="none" stroke="{colour}" stroke-width="2"{dash}/>'
                   f'<path d="M{width - right + 20} {top + 16 * k}h22" stroke="{colour}" stroke-width="2"{dash}/>'
                   f'<text x="{width - right + 48}" y="{top + 4 + 16 * k}">{name}</text>')
        out += [f'<circle cx="{u:.1f}" cy="{v:.1f}" r="2.5" fill="{colour}"/>' for u, v in points]
        out += [f'<path d="M{x_axis.at(x) - 5:.1f} {top - 5}l10 10m0 -10l-10 10" stroke="{colour}" stroke-width="2"/>'
                f'<text x="{x_axis.at(x) - 10:.1f}" y="{top + 18}" text-anchor="end">not found</text>'
                for who, x in missing if who == name]
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
    wrong, missing = {"Pliant": [], "PCL with ICP": []}, []
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
                else:
                    missing.append((who, noise))
    plot(os.path.join(out, "label_errors.svg"), "Wrong labels against noise, b2_local_clutter_resampled",
         "noise, % of the point spacing", "wrong, %", wrong, False, missing)
    for case, model, keys in (("d1_pillow", 2067, 2654), ("d2_pillow_clutter", 2425, 2926), ("c_humanoid", 2048, 2000)):
        subprocess.run([os.path.join(programs, "draw_registration"), os.path.join(CASES, case), "scene.ply",
                        os.path.join(out, case + ".png"), str(model), str(keys)], check=True)


if __name__ == "__main__":
    main()
