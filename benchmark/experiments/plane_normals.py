#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How calm a surface is on large planes: angles of its faces from planes that are fitted to the points.

POINTS is what fresco_normals wrote, in one frame. Planes of at least AREA m2 are found in it (RANSAC on points thinned to 5 cm,
3 cm from the plane, normals within 25 degrees). A face of a MESH counts if its middle lies within 5 cm of a plane, in a
square of 10 cm whose eight neighbours hold points of the plane, too. Printed: area that counts, the median of the
planes' own medians, median and 90 % of all such area, RMS distance from the plane.
"""
import argparse
import numpy as np

from held_out_points import positions, read_ply
from room_surfaces import read_mesh


def thin(points, normals, cell):
    keys = np.floor(points / cell).astype(np.int64)
    _, first = np.unique(keys, axis=0, return_index=True)
    return points[first], normals[first]


def planes_of(points, normals, area, rng):
    found, left = [], np.ones(len(points), bool)
    for _ in range(60):
        index = np.flatnonzero(left)
        if len(index) < area / 0.0025:
            break
        best, seed = 0, None
        p, n = points[index], normals[index]
        sample = rng.choice(len(index), min(len(index), 20000), replace=False)
        for k in rng.choice(len(index), 400):
            inside = np.count_nonzero((np.abs((p[sample] - p[k]) @ n[k]) < 0.03) & (n[sample] @ n[k] > 0.9))
            if inside > best:
                best, seed = inside, k
        normal, middle = n[seed], p[seed]
        for _ in range(5):
            inside = (np.abs((p - middle) @ normal) < 0.03) & (n @ normal > 0.9)
            middle = p[inside].mean(0)
            fitted = np.linalg.svd(p[inside] - middle, full_matrices=False)[2][2]
            normal = fitted if fitted @ normal > 0 else -fitted
        inside = (np.abs((p - middle) @ normal) < 0.03) & (n @ normal > 0.9)
        if inside.sum() * 0.0025 < area:
            break
        left[index[inside]] = False
        found.append((normal, middle, p[inside]))
    return found


class Calm:
    """Angles, areas and offsets of the faces of a mesh that lie on planes."""

    def __init__(self, path):
        mesh = read_mesh(path)
        v, f = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
        corner = v[f[:, 0]]
        self.cross = np.cross(v[f[:, 1]] - corner, v[f[:, 2]] - corner)
        self.size = np.linalg.norm(self.cross, axis=1)
        self.middle = v[f].mean(1)
        self.medians, self.angles, self.areas, self.offsets = [], [], [], []

    def add(self, normal, origin, inside):
        def squares(points):
            at = np.floor((points - origin) @ axis.T / 0.1).astype(int)
            return at[:, 0] * 1000003 + at[:, 1]

        axis = np.linalg.svd(normal[None])[2][1:]
        cells = np.unique(squares(inside))
        inner = [c for c in cells if np.isin(c + np.add.outer([-1000003, 0, 1000003], [-1, 0, 1]), cells).all()]
        offset = (self.middle - origin) @ normal
        near = np.flatnonzero((np.abs(offset) < 0.05) & (self.cross @ normal > 0.5 * self.size))
        near = near[np.isin(squares(self.middle[near]), inner)]
        if len(near) < 10:
            return
        angle = np.degrees(np.arccos(np.clip(self.cross[near] @ normal / self.size[near], -1, 1)))
        self.medians.append(quantile(angle, self.size[near], 0.5))
        self.angles.append(angle)
        self.areas.append(0.5 * self.size[near])
        self.offsets.append(offset[near])

    def row(self):
        angles, areas, offsets = map(np.concatenate, (self.angles, self.areas, self.offsets))
        rms = 1000 * np.sqrt(np.average(offsets**2, weights=areas))
        middle, most = (quantile(angles, areas, share) for share in (0.5, 0.9))
        return (f"{areas.sum():.1f} m2; median of planes {np.median(self.medians):.2f}, median {middle:.2f}, "
                f"90 % {most:.2f} degrees; RMS {rms:.1f} mm")


def quantile(values, weights, share):
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    return values[order][np.searchsorted(total, share * total[-1])]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("points")
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--area", type=float, default=3)
    options = parser.parse_args()
    vertices = read_ply(options.points)
    normals = np.stack([vertices["n" + axis] for axis in "xyz"], 1).astype(float)
    points, normals = thin(positions(vertices).astype(float), normals, 0.05)
    planes = planes_of(points, normals, options.area, np.random.default_rng(1))
    print(f"{len(planes)} planes, {sum(len(p[2]) for p in planes) * 0.0025:.0f} m2")
    for path in options.meshes:
        calm = Calm(path)
        for plane in planes:
            calm.add(*plane)
        print(f"{path}: {calm.row()}")


if __name__ == "__main__":
    main()
