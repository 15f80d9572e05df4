#!/usr/bin/python3
"""score_choices.py PLIANT FOLDER SEQUENCE...: follows sequences with eight choices of their models' points and prints the
means, every second frame scored.

Which points of a surface a model happens to have decides much of how a hard sequence goes: one run tells two versions of
the tracker from each other only where they differ by more than that. FOLDER keeps the models. Needs numpy, scipy, PIL and
../shared/evaluate."""
import multiprocessing
import os
import subprocess
import sys
import tempfile
import warnings

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../../../shared/evaluate"))
import evaluate  # noqa: E402
from meshes import subdivided, write_ply  # noqa: E402

SPACINGS = (0.0036, 0.0042, 0.0047, 0.0052, 0.0058, 0.0064)  # metres
COLUMNS = ("base", "rigid points, mm", "deformed points, mm", "hidden points, mm", "wrong", "false deformed", "F1", "whole",
           "false bases")


def models_of(pliant, folder, sequence):
    """Files: of the given vertices, of every triangle in four, and of spacings of those."""
    name = os.path.join(folder, os.path.basename(os.path.normpath(sequence)))
    given, finer = os.path.join(sequence, "model.ply"), name + ".ply"
    vertex, triangles = evaluate.read_ply(given)
    write_ply(finer, *subdivided(evaluate.xyz(vertex), triangles))
    wanted = [(given, []), (finer, [])] + [(finer, ["--spacing", str(s)]) for s in SPACINGS]
    models = []
    for k, (surface, words) in enumerate(wanted):
        models.append(f"{name}.{k}.model")
        subprocess.run([pliant, "model", "build", surface, *words, "-o", models[-1]], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return models


def follow(job):
    pliant, sequence, model = job
    with tempfile.TemporaryDirectory() as scratch:
        points = os.path.join(scratch, "points")
        os.mkdir(points)  # stays empty where nothing is tracked
        subprocess.run([pliant, "run", "--model", model, "--source", "recording:" + sequence, "--pace", "fast", "--lcm-url",
                        "none", "--points", points], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        for file in sorted(os.listdir(points))[1::2]:
            os.remove(os.path.join(points, file))
        return evaluate.score_sequence(sequence, points)


def row(scores):
    def mean(*keys):
        values = [s[keys[0]] if len(keys) == 1 else s[keys[0]][keys[1]] for s in scores]
        values = [v for v in values if v is not None]
        return np.mean(values) if values else None

    def text(form, *values):
        return "–" if None in values else form % values

    def pair(name):
        return text("%.2f / %.1f", mean("position_" + name, "median_mm"), mean("position_" + name, "p95_mm"))

    def share(key):
        return text("%.3f", mean(key))

    for s in scores:
        s.setdefault("parts_whole_share")
    return [text("%.2f° %.2f mm", mean("rotation_deg_median"), mean("translation_mm_median")), pair("rigid"), pair("deformed"),
            pair("hidden"), share("wrong_rigid_share"), share("false_deformed_share"), share("deformed_f1"),
            share("parts_whole_share"), "%.1f" % mean("false_poses")]


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    pliant, folder, sequences = sys.argv[1], sys.argv[2], sys.argv[3:]
    os.makedirs(folder, exist_ok=True)
    warnings.simplefilter("ignore")
    print("| sequence | " + " | ".join(COLUMNS) + " |\n|" + "---|" * (len(COLUMNS) + 1))
    with multiprocessing.Pool() as pool:
        for sequence in sequences:
            jobs = [(pliant, sequence, model) for model in models_of(pliant, folder, sequence)]
            print("| %s | %s |" % (os.path.basename(os.path.normpath(sequence)), " | ".join(row(pool.map(follow, jobs)))),
                  flush=True)


if __name__ == "__main__":
    main()
