#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Surface optimisation as the thesis has it (Pitzer, "Automatic Reconstruction of Textured 3D Models", eq. 4.10):

    E = E_fit + kappa1 E_smooth + kappa2 E_topology

minimised by non-linear conjugate gradients (Polak & Ribiere; Shewchuk 1994). The excerpt that is known names the terms, not
their formulas; these are a reading of it, with lengths in mean edge lengths:

    E_fit      = sum over data of a rho(distance to the mesh),   rho(d) = 9 d^2 / (9 + d^2), a: area that a datum stands for
    E_smooth   = sum over edges of length psi(|n_l - n_r|),      psi(t) = (t^2 + 0.01)^(1/4)  (Diebel et al. 2006)
    E_topology = sum over vertices of |vertex - mean of its neighbours - the same at the start|^2

kappa2 is halved each time the vertices rest, down to a 64th.
"""
import argparse

import numpy as np
import open3d as o3d


def add_at(rows, values, count):
    return np.stack([np.bincount(rows, v, count) for v in values.T], axis=1)


class Energy:
    def __init__(self, x, faces, data, kappa1, kappa2):
        self.faces, self.data, self.kappa1, self.kappa2 = faces, data, kappa1, kappa2
        sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        self.edges, inverse, count = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True, return_counts=True)
        order = np.argsort(inverse.ravel(), kind="stable") % len(faces)
        first = np.concatenate([[0], np.cumsum(count)[:-1]])
        self.inner = np.flatnonzero(count == 2)
        self.left, self.right = order[first[self.inner]], order[first[self.inner] + 1]
        self.degree = np.maximum(1, np.bincount(self.edges.ravel(), minlength=len(x)))[:, None]
        self.rings = self.ring_offsets(x)
        normals = self.normals(x)[0]
        self.area = 0.5 * np.linalg.norm(normals, axis=1).sum() / len(data)

    def neighbour_sums(self, x):
        a, b = self.edges.T
        return add_at(np.r_[a, b], np.r_[x[b], x[a]], len(x))

    def ring_offsets(self, x):
        return x - self.neighbour_sums(x) / self.degree

    def normals(self, x):
        """Area vectors, their softened lengths (needles have no direction to speak of) and unit normals."""
        a, b, c = x[self.faces.T]
        vectors = np.cross(b - a, c - a)
        lengths = np.sqrt((vectors**2).sum(1) + 1e-4)[:, None]
        return vectors, lengths, vectors / lengths

    def match(self, x):
        scene = o3d.t.geometry.RaycastingScene()
        scene.add_triangles(o3d.core.Tensor(x.astype(np.float32)), o3d.core.Tensor(self.faces.astype(np.uint32)))
        found = scene.compute_closest_points(o3d.core.Tensor(self.data.astype(np.float32)))
        uv = found["primitive_uvs"].numpy().astype(float)
        self.weights = np.c_[1 - uv.sum(1), uv]
        self.corners = self.faces[found["primitive_ids"].numpy().astype(np.int64)]

    def evaluate(self, x):
        """Value and gradient. The foot of a datum is where the distance is least, so its own motion does not count."""
        offset = (self.weights[:, :, None] * x[self.corners]).sum(1) - self.data
        squared = (offset**2).sum(1)
        share = 9 / (9 + squared)
        value = self.area * (squared * share).sum()
        pull = 2 * self.area * (share**2)[:, None] * offset
        gradient = add_at(self.corners.ravel(), (self.weights[:, :, None] * pull[:, None]).reshape(-1, 3), len(x))

        _, lengths, normals = self.normals(x)
        difference = normals[self.left] - normals[self.right]
        t2 = (difference**2).sum(1)
        a, b = self.edges[self.inner].T
        side = x[a] - x[b]
        length = np.maximum(np.linalg.norm(side, axis=1), 1e-12)
        potential = (t2 + 0.01) ** 0.25 - 0.01**0.25
        value += self.kappa1 * (length * potential).sum()
        along = (self.kappa1 * potential / length)[:, None] * side
        gradient += add_at(np.r_[a, b], np.r_[along, -along], len(x))
        bend = (length * 0.5 * (t2 + 0.01) ** -0.75)[:, None] * difference
        pull = add_at(np.r_[self.left, self.right], np.r_[bend, -bend], len(self.faces))
        pull = self.kappa1 * (pull - normals * (normals * pull).sum(1)[:, None]) / lengths
        for k in range(3):
            opposite = x[self.faces[:, (k + 1) % 3]] - x[self.faces[:, (k + 2) % 3]]
            gradient += add_at(self.faces[:, k], np.cross(opposite, pull), len(x))

        rings = self.ring_offsets(x) - self.rings
        value += self.kappa2 * (rings**2).sum()
        return value, gradient + 2 * self.kappa2 * (rings - self.neighbour_sums(rings / self.degree))


def line_search(energy, x, direction, value, slope, step):
    """The step where the slope vanishes by two secants (Shewchuk B5), shortened until the value falls."""
    for _ in range(2):
        other = (energy.evaluate(x + step * direction)[1] * direction).sum()
        step = step * slope / (slope - other) if slope < other else 2 * step
    while step > 1e-9 and energy.evaluate(x + step * direction)[0] > value + 1e-4 * step * slope:
        step /= 2
    return step if step > 1e-9 else 0.0


def minimize(energy, x, iterations, tolerance):
    direction, last, least, step = np.zeros_like(x), None, energy.kappa2 / 64, 0.1
    for i in range(iterations):
        energy.match(x)
        value, gradient = energy.evaluate(x)
        beta = 0 if last is None or i % 50 == 0 else max(0, (gradient * (gradient - last)).sum() / (last**2).sum())
        direction = beta * direction - gradient
        if (direction * gradient).sum() >= 0:
            direction = -gradient
        first = 0.1 / max(1e-12, np.linalg.norm(direction, axis=1).max())
        step = line_search(energy, x, direction, value, (direction * gradient).sum(), first)
        x, last = x + step * direction, gradient
        if np.sqrt(((step * direction) ** 2).sum(1).mean()) < tolerance:
            if energy.kappa2 <= least:
                break
            energy.kappa2, last = energy.kappa2 / 2, None
    return x, i + 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("cloud")
    parser.add_argument("out")
    parser.add_argument("--iterations", type=int, default=200)
    parser.add_argument("--kappa1", type=float, default=0.1)
    parser.add_argument("--kappa2", type=float, default=0.1)
    parser.add_argument("--tolerance", type=float, default=1e-4, help="RMS move of the vertices, mean edge lengths")
    options = parser.parse_args()
    mesh = o3d.io.read_triangle_mesh(options.mesh)
    data = np.asarray(o3d.io.read_point_cloud(options.cloud).points)
    x, faces = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    if len(faces) == 0 or len(data) == 0:
        raise SystemExit(f"{options.mesh} has {len(faces)} faces, {options.cloud} {len(data)} points")
    unit = np.linalg.norm(x[faces] - x[faces[:, [1, 2, 0]]], axis=2).mean()
    energy = Energy(x / unit, faces, data / unit, options.kappa1, options.kappa2)
    x, steps = minimize(energy, x / unit, options.iterations, options.tolerance)
    mesh.vertices = o3d.utility.Vector3dVector(x * unit)
    o3d.io.write_triangle_mesh(options.out, mesh)
    print(f"{options.out}: {steps} iterations")


if __name__ == "__main__":
    main()
