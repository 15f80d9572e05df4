"""Meshes for the scoring scripts."""
import numpy as np


def write_ply(path, vertices, triangles=()):
    with open(path, "w", encoding="ascii") as out:
        out.write(f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\n")
        out.write("".join(f"property float {axis}\n" for axis in "xyz"))
        out.write(f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
        out.writelines("%.7g %.7g %.7g\n" % tuple(vertex) for vertex in vertices)
        out.writelines("3 %d %d %d\n" % tuple(triangle) for triangle in triangles)


def subdivided(points, triangles):
    """Every triangle in four: other vertices to choose from, the same surface."""
    sides = np.sort(np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    edges, at = np.unique(sides, axis=0, return_inverse=True)
    a, b, c = len(points) + at.reshape(3, -1)
    middles = (points[edges[:, 0]] + points[edges[:, 1]]) / 2
    return np.vstack([points, middles]), np.vstack([
        np.stack(t, 1) for t in ((triangles[:, 0], a, c), (triangles[:, 1], b, a), (triangles[:, 2], c, b), (a, b, c))])
