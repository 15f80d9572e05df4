#!/usr/bin/python3
"""score_tracking.py [--draws] PLIANT CAPTURE_MESHES FOLDER OBJECT...: tracks deforming objects, once with the model of the true mesh,
once with the same surface's points chosen anew, and once with a captured model, and prints the errors side by side.

OBJECT: cushion, figure or box of the simulated sensor, as OBJECT@SEED with another seed of its noise, or the folder of a
recording with model.ply (y upwards) and truth.npz. Captures are of a camera that goes round the object, at heights of 20 to
50 degrees. With --draws, the true and the captured surface are each sampled at six spacings more, and the geometric means
are printed: which points happen to be chosen decides much. Only points count that the captured model has, within 3 mm: what no view showed is no error of what was
captured. FOLDER keeps what was made and is gone on from. Needs numpy, scipy and ../shared/evaluate."""
import os
import subprocess
import sys

import numpy as np
from scipy.spatial import cKDTree

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, "../accuracy"), os.path.join(HERE, "../../../shared/evaluate")]
import evaluate
from meshes import subdivided, write_ply

FRAMES = "200"
CAPTURE = "?motion=circled&frames=300"
SIGMA = 0.0051 / 4  # metres: of a reading at 0.6 m
USUAL, KEYPOINTS = 8000, 2048
DRAWS = (0.003, 0.0035, 0.004, 0.0045, 0.0051, 0.006)
NEAR = 0.003     # metres


def run(*words):
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def sequence_of(pliant, thing, folder):
    """The folder of the recording, and which axis of its model points upwards."""
    if os.path.isdir(thing):
        return thing, "y"
    name, _, seed = thing.partition("@")
    sequence = os.path.join(folder, thing)
    if not os.path.exists(os.path.join(sequence, "truth.npz")):
        run(pliant, "record", "--source", "simulated:%s?frames=%s&seed=%s" % (name, FRAMES, seed or "1"), "-o", sequence)
        run("/usr/bin/python3", os.path.join(HERE, "../simulated/make_truth_npz.py"), sequence)
    return sequence, "z"


def captured_spacing(points, triangles):
    """As pliant model capture spaces a model (captured_spacing() in drivers/model_files)."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    even = lambda count: np.sqrt(2 * area / (np.sqrt(3) * count))
    return min(4 * SIGMA, max(0.8 * even(USUAL), 1.5 * SIGMA), even(KEYPOINTS))


def carried(v, places):
    """What evaluate.carry() puts there, all turns at once."""
    rest, now = evaluate.xyz(v, "rest_"), evaluate.xyz(v)
    tree = cKDTree(rest)
    near, at = np.unique(tree.query(places)[1], return_inverse=True)
    around = tree.query(rest[near], k=min(12, len(rest)))[1]
    a, b = rest[around], now[around]
    a, b = a - a.mean(1, keepdims=True), b - b.mean(1, keepdims=True)
    u, _, vt = np.linalg.svd(np.einsum("nki,nkj->nij", a, b))
    v3 = np.swapaxes(vt, 1, 2).copy()
    v3[:, :, 2] *= np.sign(np.linalg.det(u @ vt))[:, None]
    turns = v3 @ np.swapaxes(u, 1, 2)
    return now[near][at] + np.einsum("nij,nj->ni", turns[at], places - rest[near][at])


class Truth:
    def __init__(self, sequence):
        self.camera, self.files = evaluate.camera(sequence), evaluate.depth_list(sequence)[1]
        truth = np.load(os.path.join(sequence, "truth.npz"))
        self.vertices, self.poses = truth["model_vertices_cam"].astype(float), truth["poses"].astype(float)
        self.visible, self.present = truth["visible"] > 0, truth["present"] > 0
        vertex, self.triangles = evaluate.read_ply(os.path.join(sequence, "model.ply"))
        self.model = evaluate.xyz(vertex)


def errors(truth, points_dir, had):
    """Metres: of all points that are seen and that both models have, of the rigid ones and of the deformed ones."""
    found = {"all": [], "rigid": [], "deformed": []}
    files = evaluate.frame_files(points_dir)
    for k in sorted(files):
        if k >= len(truth.vertices) or not truth.present[k]:
            continue
        now = truth.vertices[k]
        sees = had & truth.visible[k] & evaluate.readable(
            now, evaluate.png(truth.files[k]) / truth.camera["depth_scale"], truth.camera)
        off = np.linalg.norm(np.stack([truth.model @ p[:3, :3].T + p[:3, 3] for p in truth.poses[k].reshape(-1, 4, 4)])
                             - now[None], axis=2).min(0)
        there = carried(evaluate.read_ply(files[k])[0], truth.model[sees])
        error = np.linalg.norm(there - now[sees], axis=1)
        found["all"].append(error)
        found["rigid"].append(error[off[sees] < 0.003])
        found["deformed"].append(error[off[sees] > 0.006])
    return len(files), {name: np.concatenate(e) if e else np.zeros(0) for name, e in found.items()}


def tracked(pliant, sequence, truth, had, at, surface, model, spacing):
    """Frames tracked, and errors()."""
    run(pliant, "model", "build", at(surface + ".ply"), "-o", at(model + ".model"),
        *(["--spacing", str(spacing)] if spacing else []))
    points = at(model + ".points")
    subprocess.run(["rm", "-rf", points], check=True)
    subprocess.run([pliant, "run", "--model", at(model + ".model"), "--source", "recording:" + sequence, "--lcm-url", "none",
                    "--pace", "fast", "--points", points], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                   check=False)  # not tracked in the last frame: told by the table
    return errors(truth, points, had)


def millimetres(e):
    return [np.median(e) * 1e3, np.percentile(e, 95) * 1e3] if len(e) else [np.nan, np.nan]


def print_row(name, model, count, cells):
    print("| %s | %s | %s | %s |" % (name, model, count, " | ".join("%.2f / %.2f mm" % tuple(c) for c in cells)), flush=True)


def main():
    words = [w for w in sys.argv[1:] if w != "--draws"]
    if len(words) < 4:
        sys.exit(__doc__)
    pliant, capture, folder = words[:3]
    os.makedirs(folder, exist_ok=True)
    print("| object | model | tracked | points, median / p95 | on rigid ones | on deformed ones |\n|---|---|---|---|---|---|")
    pooled = {}
    for thing in words[3:]:
        sequence, up = sequence_of(pliant, thing, folder)
        name = os.path.basename(os.path.normpath(thing))
        at = lambda what: os.path.join(folder, name + "." + what)
        truth = Truth(sequence)
        run(capture, os.path.join(sequence, "model.ply"), "0", up, CAPTURE, at("captured.ply"))
        write_ply(at("anew.ply"), *subdivided(truth.model, truth.triangles))
        write_ply(at("true.ply"), truth.model, truth.triangles)
        vertex, triangles = evaluate.read_ply(at("captured.ply"))
        captured = evaluate.xyz(vertex)
        had = cKDTree(captured).query(truth.model)[0] < NEAR
        for model, spacing in (("true", None), ("anew", None), ("captured", captured_spacing(captured, triangles))):
            count, found = tracked(pliant, sequence, truth, had, at, model, model, spacing)
            for kind, e in found.items():
                pooled.setdefault((model, kind), []).append(evaluate.percentiles(e))
            print_row(name, model, "%d of %d" % (count, len(truth.files)), [millimetres(e) for e in found.values()])
        for model in ("anew", "captured") if "--draws" in sys.argv else ():
            each = [tracked(pliant, sequence, truth, had, at, model, "draw", spacing)[1] for spacing in DRAWS]
            print_row(name, model + ", mean of %d spacings" % len(DRAWS), "",
                      np.exp(np.mean(np.log([[millimetres(e) for e in found.values()] for found in each]), axis=0)))
    for model in ("anew", "captured"):
        cells = []
        for kind in ("all", "rigid", "deformed"):
            both = [(a, b) for a, b in zip(pooled[model, kind], pooled["true", kind]) if a["median_mm"] and b["median_mm"]]
            each = [np.exp(np.mean([np.log(a[q] / b[q]) for a, b in both])) if both else np.nan
                    for q in ("median_mm", "p95_mm")]
            cells.append("%.2f / %.2f" % tuple(each))
        print("| all, against true | %s | | %s |" % (model, " | ".join(cells)))


main()
