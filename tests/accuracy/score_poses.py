#!/usr/bin/env python3
"""Registers posed clouds of the shared sequences of meshes and prints how much of them lies where it should.

    tests/accuracy/score_poses.py build/release/firmware-app/pliant OUTPUT-FOLDER [SEED]

Each pose is sampled at 9000 points of its surface with 0.5 mm of noise, turned at random. Right is what lies within
3 % of the object's size of where it truly is.
"""
import gzip
import os
import subprocess
import sys

import numpy as np
from scipy.spatial import cKDTree

SHARED = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../shared")
sys.path.insert(0, os.path.join(SHARED, "evaluate"))
from evaluate import read_ply, rigid_fit, xyz  # noqa: E402
from meshes import write_ply  # noqa: E402

SEQUENCES = {"seq_wolf_lbs": 0.4, "seq_cheburashka_lbs": 0.35, "seq_human_samba": 0.6, "seq_cat_poses": 0.4}
SAMPLES, NOISE, RIGHT = 9000, 0.0005, 0.03  # points, metres, of the object's size


def read_mesh(path):
    """Vertices and triangles of a packed OBJ."""
    vertices, triangles = [], []
    for line in gzip.open(path, "rt"):
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            triangles += [[corners[0], corners[k], corners[k + 1]] for k in range(1, len(corners) - 1)]
    return np.array(vertices), np.array(triangles)


def random_rotation(rng):
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


def sampled(rng, rest, posed, triangles):
    """Points of the posed surface, and where they lie on the undeformed one."""
    corners = posed[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chosen = rng.choice(len(triangles), SAMPLES, p=area / area.sum())
    shares = rng.dirichlet([1, 1, 1], SAMPLES)
    return [np.einsum("nk,nkd->nd", shares, mesh[triangles[chosen]]) for mesh in (posed, rest)]


def right_share(result, rest_points, now_points, size):
    vertices, _ = read_ply(result)
    rest, now = xyz(vertices, "rest_"), xyz(vertices)
    tree = cKDTree(rest)
    _, near = tree.query(rest_points)
    _, around = tree.query(rest, k=12)
    turned = {i: rigid_fit(rest[around[i]], now[around[i]])[0] for i in np.unique(near)}
    found = np.array([now[i] + turned[i] @ (point - rest[i]) for i, point in zip(near, rest_points)])
    return np.mean(np.linalg.norm(found - now_points, axis=1) < RIGHT * size)


def main(pliant, folder, seed):
    os.makedirs(folder, exist_ok=True)
    for sequence, size in SEQUENCES.items():
        source = os.path.join(SHARED, "data", sequence)
        rest, triangles = read_mesh(os.path.join(source, "rest.obj.gz"))
        scale = size / np.linalg.norm(np.ptp(rest, axis=0))
        centre = rest.mean(axis=0)
        rest = (rest - centre) * scale
        mesh, model, scene, result = (os.path.join(folder, name) for name in
                                      ("model.ply", sequence + ".model", "scene.ply", "result.ply"))
        write_ply(mesh, rest, triangles)
        subprocess.run([pliant, "model", "build", mesh, "--units", "m", "-o", model], check=True, capture_output=True)
        shares = []
        for number, frame in enumerate(sorted(os.listdir(os.path.join(source, "frames")))):
            rng = np.random.default_rng([seed, number])
            posed = (read_mesh(os.path.join(source, "frames", frame))[0] - centre) * scale
            posed = posed @ random_rotation(rng).T + [0.05, -0.03, 0.7]
            now, where = sampled(rng, rest, posed, triangles)
            write_ply(scene, now + rng.normal(size=now.shape) * NOISE)
            run = subprocess.run([pliant, "register", "--model", model, "--scene", scene, "-o", result],
                                 capture_output=True, check=False)
            shares.append(right_share(result, where, now, size) if run.returncode == 0 else None)
        found = [share for share in shares if share is not None]
        print(f"| {sequence} | {len(found)} of {len(shares)} | {np.mean(found):.2f} | {np.min(found):.2f} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 1)
