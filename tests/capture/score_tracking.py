#!/usr/bin/python3
"""score_tracking.py PLIANT OBJECT FOLDER [FRAMES]: tracks the simulated OBJECT (cushion, figure, box) while it is
handled, once with the model of its true mesh and once with one captured on a simulated turntable, and prints the
errors of both side by side. FOLDER is made. Needs numpy, scipy and ../shared/evaluate."""
import json
import os
import subprocess
import sys

import numpy as np
from scipy.spatial import cKDTree

HERE = os.path.dirname(os.path.abspath(__file__))
EVALUATE = os.path.join(HERE, "../../../shared/evaluate")
sys.path.insert(0, EVALUATE)
import evaluate


def write_ply(path, points, triangles):
    with open(path, "wb") as f:
        f.write(("ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
                 "property float z\nelement face %d\nproperty list uchar int vertex_indices\nend_header\n"
                 % (len(points), len(triangles))).encode())
        f.write(points.astype("<f4").tobytes())
        faces = np.empty(len(triangles), np.dtype([("n", "u1"), ("i", "<i4", 3)]))
        faces["n"], faces["i"] = 3, triangles
        f.write(faces.tobytes())


def fit(points, truth, normals):
    """The rigid motion of the captured points onto the true surface: turns about the upright axis are tried, the best is
    refined by point-to-plane ICP."""
    tree = cKDTree(truth)
    sample = points[:: max(1, len(points) // 6000)]
    best = None
    for turn in np.arange(0, 360, 20):
        c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
        r = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        t = 0.5 * (truth.min(0) + truth.max(0)) - 0.5 * ((sample @ r.T).min(0) + (sample @ r.T).max(0))
        for _ in range(30):
            moved = sample @ r.T + t
            dist, near = tree.query(moved)
            off = np.einsum("ij,ij->i", normals[near], moved - truth[near])
            used = np.abs(off) <= np.quantile(np.abs(off), 0.9)
            n, m = normals[near][used], moved[used]
            rows = np.hstack([np.cross(m, n), n])
            x = np.linalg.lstsq(rows, -off[used], rcond=None)[0]
            turned = np.eye(3) + np.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])
            u, _, vt = np.linalg.svd(turned)
            r, t = (u @ vt) @ r, (u @ vt) @ t + x[3:]
        error = np.mean(np.abs(off[used]))
        if best is None or error < best[0]:
            best = (error, r, t)
    return best[1], best[2]


def run(*words):
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def main():
    pliant, thing, folder = sys.argv[1:4]
    frames = sys.argv[4] if len(sys.argv) > 4 else "300"
    os.makedirs(folder)
    at = lambda name: os.path.join(folder, name)
    run(pliant, "record", "--source", "simulated:%s?frames=%s" % (thing, frames), "-o", at("sequence"))
    run("/usr/bin/python3", os.path.join(HERE, "../simulated/make_truth_npz.py"), at("sequence"))
    run(pliant, "model", "capture", "--source", "simulated:%s?motion=turned&frames=300" % thing, "-o", at("first.model"),
        "--ply", at("first.ply"))
    vertex, triangles = evaluate.read_ply(at("first.ply"))
    true_vertex = evaluate.read_ply(at("sequence/model.ply"))[0]
    r, t = fit(evaluate.xyz(vertex), evaluate.xyz(true_vertex), evaluate.xyz(true_vertex, "n"))
    write_ply(at("captured.ply"), evaluate.xyz(vertex) @ r.T + t, triangles)
    rows = {}
    for name, mesh in (("true", at("sequence/model.ply")), ("captured", at("captured.ply"))):
        run(pliant, "model", "build", mesh, "-o", at(name + ".model"))
        run(pliant, "run", "--model", at(name + ".model"), "--source", "recording:" + at("sequence"), "--lcm-url", "none",
            "--pace", "fast", "--points", at(name))
        rows[name] = evaluate.score_sequence(at("sequence"), at(name))
    print(json.dumps(rows, indent=1))


main()
