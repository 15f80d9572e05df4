#!/usr/bin/env python3
"""make_truth_npz.py FOLDER: gathers the truth of a simulated recording into FOLDER/truth.npz.

Arrays: poses [n, parts, 4, 4] camera <- model, model_vertices_cam [n, V, 3], visible [n, V], present [n],
vertex_part [V] (-1 = deforms). Needs numpy (Debian: python3-numpy).
"""
import os
import sys

import numpy as np

VERTEX = np.dtype([("xyz", "<f4", 3), ("visible", "u1"), ("part", "i1")])


def vertices(path):
    with open(path, "rb") as f:
        count = 0
        for line in f:
            if line.startswith(b"element vertex"):
                count = int(line.split()[2])
            if line.strip() == b"end_header":
                break
        return np.frombuffer(f.read(VERTEX.itemsize * count), VERTEX)


def rotation(q):
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    truth = os.path.join(sys.argv[1], "truth")
    rows = [line.split() for line in open(os.path.join(truth, "poses.txt")) if not line.startswith("#")]
    frames = 1 + max(int(r[1]) for r in rows)
    parts = 1 + max(int(r[3]) for r in rows)
    poses = np.tile(np.eye(4), (frames, parts, 1, 1))
    present = np.zeros(frames, np.uint8)
    for r in rows:
        k, part = int(r[1]), int(r[3])
        present[k] = int(r[2])
        poses[k, part, :3, 3] = [float(x) for x in r[4:7]]
        poses[k, part, :3, :3] = rotation([float(x) for x in r[7:11]])
    each = [vertices(os.path.join(truth, f"{k:06d}.ply")) for k in range(frames)]
    np.savez_compressed(os.path.join(sys.argv[1], "truth.npz"), poses=poses, present=present,
                        model_vertices_cam=np.stack([v["xyz"] for v in each]),
                        visible=np.stack([v["visible"] for v in each]), vertex_part=each[0]["part"])


main()
