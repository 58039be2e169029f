#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How far real scans are from a surface that was made without them.

SCANS: files or a folder for fresco_register, or one cloud already in one frame, with vp_x vp_y vp_z. A random tenth of
the points is kept out. The others get normals (fresco_normals) and become surfaces: fresco_reconstruct, then
fresco_optimize, with Open3D's Poisson beside it. Printed are the distances of the points kept out. The rows `floor`
bound them: distances from planes and quadrics, fitted to the other points nearby without regard to a surface. The last
column tells of surface in free space: beams that it stops before they reach their point.
"""
import argparse
import os
import subprocess
import time

import numpy as np
import open3d as o3d

import room_surfaces as rooms

HERE = os.path.dirname(os.path.abspath(__file__))


def read_ply(path):
    """Binary little-endian vertices, all properties float, as a structured array."""
    with open(path, "rb") as file:
        header = []
        while not header or header[-1] != "end_header":
            header.append(file.readline().decode().strip())
        names = [line.split()[2] for line in header if line.startswith("property float ")]
        return np.fromfile(file, [(name, "<f4") for name in names])


def write_ply(path, vertices):
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property float {name}" for name in vertices.dtype.names]
    with open(path, "wb") as file:
        file.write(("\n".join(lines + ["end_header"]) + "\n").encode())
        vertices.tofile(file)


def positions(vertices):
    return np.stack([vertices[axis] for axis in "xyz"], 1)


class Judge:
    def __init__(self, options):
        self.options = options
        self.train = os.path.join(options.out, "points.ply")

    def tool(self, name, *arguments):
        command = [os.path.join(self.options.bin, "fresco_" + name), *arguments, "-threads", str(self.options.threads)]
        subprocess.run([*command, "-quiet"], check=True)

    def prepare(self):
        cloud = self.options.scans[0]
        if len(self.options.scans) > 1 or os.path.isdir(cloud):
            self.tool("register", *self.options.scans, "-o", self.options.out)
            cloud = os.path.join(self.options.out, "registered.pcd")
        all_points, others = (os.path.join(self.options.out, name) for name in ("all.ply", "others.ply"))
        self.tool("normals", cloud, all_points)
        vertices = read_ply(all_points)
        # A scan that names its points twice (lobby) must not have one of them on either side.
        if not self.options.doubled:
            vertices = vertices[np.sort(np.unique(positions(vertices), axis=0, return_index=True)[1])]
        kept_out = np.random.default_rng(self.options.seed).random(len(vertices)) < self.options.share
        self.test, near = near_others(positions(vertices[kept_out]), positions(vertices[~kept_out]))
        self.viewpoints = np.stack([vertices[kept_out][near]["vp_" + axis] for axis in "xyz"], 1)
        far = np.linalg.norm(self.test - self.viewpoints, axis=1) >= self.options.beyond
        self.test, self.viewpoints = self.test[far], self.viewpoints[far]
        write_ply(others, vertices[~kept_out])
        self.tool("normals", others, self.train) # again, without the points kept out
        print(f"{np.sum(~kept_out)} points, {len(self.test)} kept out")
        print("| | mean mm | median mm | RMS mm | within 10 mm | s | beams stopped 0.1 / 0.3 m early |\n" + "|---" * 7 + "|")

    def row(self, name, distances, seconds=None, mesh=None):
        d = 1000 * np.abs(distances)
        took = f"{seconds:.1f}" if seconds else ""
        print(f"| {name} | {np.mean(d):.2f} | {np.median(d):.2f} | {np.sqrt(np.mean(d * d)):.2f} "
              f"| {np.mean(d <= 10):.3f} | {took} | {self.stopped(mesh) if mesh else ''} |", flush=True)

    def stopped(self, mesh):
        """Share of the beams of points kept out that meet the mesh well before their point."""
        gaps = gaps_before(self.viewpoints, self.test, mesh)
        return " / ".join(f"{100 * np.mean(gaps > gap):.2f} %" for gap in (0.1, 0.3))

    def judge(self, name, mesh, seconds):
        mesh = rooms.read_mesh(mesh)
        self.row(name, rooms.distances_to_mesh(self.test, mesh), seconds, mesh)

    def timed(self, *command):
        start = time.time()
        self.tool(*command)
        return time.time() - start

    def judge_fresco(self, depth):
        mesh, optimized = (os.path.join(self.options.out, f"{name}_{depth}.ply") for name in ("volumetric", "optimized"))
        seconds = self.timed("reconstruct", self.train, mesh, "-depth", str(depth))
        self.judge(f"fresco_reconstruct, depth {depth}", mesh, seconds)
        if self.options.free_space:
            free = os.path.join(self.options.out, f"free_{depth}.ply")
            seconds = self.timed("reconstruct", self.train, free, "-depth", str(depth), "-free_space")
            self.judge("with free space", free, seconds)
        if self.options.volumetric_only:
            return
        seconds = self.timed("optimize", mesh, self.train, optimized)
        self.judge("then fresco_optimize", optimized, seconds)

    def judge_open3d(self, depth):
        start = time.time()
        cloud = o3d.io.read_point_cloud(self.train)
        mesh, _ = o3d.geometry.TriangleMesh.create_from_point_cloud_poisson(cloud, depth=depth,
                                                                            n_threads=self.options.threads)
        path = os.path.join(self.options.out, f"open3d_{depth}.ply")
        o3d.io.write_triangle_mesh(path, mesh)
        self.judge(f"Open3D's Poisson, depth {depth}", path, time.time() - start)

    def judge_floor(self, neighbours):
        others = positions(read_ply(self.train))
        search = o3d.core.nns.NearestNeighborSearch(o3d.core.Tensor(others))
        search.knn_index()
        found = search.knn_search(o3d.core.Tensor(self.test), neighbours)[0].numpy()
        offsets = (others[found] - self.test[:, None]).astype(np.float64)
        self.row(f"floor: planes of {neighbours}", heights(offsets, quadratic=False))
        self.row(f"floor: quadrics of {neighbours}", heights(offsets, quadratic=True))


def near_others(points, others):
    """Those with three others within half a metre: fewer make no surface that could be measured."""
    search = o3d.core.nns.NearestNeighborSearch(o3d.core.Tensor(others))
    search.knn_index()
    near = search.knn_search(o3d.core.Tensor(points), 3)[1].numpy()[:, 2] < 0.5**2
    return points[near], near


def gaps_before(origins, ends, mesh):
    """How long before its end each beam meets the mesh, 0 if it does not. Sphere tracing: a step is as long as the
    distance from the mesh, which Open3D finds exactly; its ray casting finds nothing in Debian 12."""
    hit = 1e-3 # m
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(o3d.t.geometry.TriangleMesh.from_legacy(mesh))
    beams = (ends - origins).astype(np.float64)
    lengths = np.linalg.norm(beams, axis=1)
    beams /= lengths[:, None]
    at, running = np.zeros(len(ends)), np.arange(len(ends))
    for _ in range(3000):
        places = origins[running] + at[running, None] * beams[running]
        distances = scene.compute_distance(o3d.core.Tensor(places.astype(np.float32))).numpy()
        at[running] += np.where(distances > hit, distances, 0)
        running = running[(distances > hit) & (at[running] < lengths[running])]
        if len(running) == 0:
            break
    return np.maximum(lengths - at, 0)


def heights(offsets, quadratic):
    """Height at the origin of a plane, or a quadric over that plane, through the points around it; robust weights."""
    weights = np.ones(offsets.shape[:2])
    for _ in range(5):
        w = weights[..., None]
        middle = (w * offsets).sum(1, keepdims=True) / w.sum(1, keepdims=True)
        axes = np.linalg.eigh(np.einsum("nki,nkj,nk->nij", offsets - middle, offsets - middle, weights))[1]
        local = np.einsum("nki,nij->nkj", offsets, axes) # across, along, along
        z, x, y = local[..., 0], local[..., 1], local[..., 2]
        terms = [np.ones_like(x), x, y] + ([x * x, x * y, y * y] if quadratic else [])
        A = np.stack(terms, 2)
        normal = np.einsum("nki,nkj,nk->nij", A, A, weights) + 1e-12 * np.eye(len(terms))
        h = np.linalg.solve(normal, np.einsum("nki,nk,nk->ni", A, z, weights)[..., None])
        rest = z - (A @ h)[..., 0]
        scale = 3 * 1.4826 * np.median(np.abs(rest), axis=1, keepdims=True) + 1e-9
        weights = 1 / (1 + (rest / scale) ** 2) ** 2
    return h[:, 0, 0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scans", nargs="+")
    parser.add_argument("-o", "--out", required=True, help="folder of the output, created")
    parser.add_argument("--bin", default=os.path.join(HERE, "..", "..", "build", "bin"), help="folder of the programs")
    parser.add_argument("--depths", type=int, nargs="+", default=[9, 10])
    parser.add_argument("--neighbours", type=int, nargs="*", default=[12, 24, 48], help="of the floor's fits")
    parser.add_argument("--share", type=float, default=0.1, help="of the points kept out")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--doubled", action="store_true", help="points that the scan names twice may be on both sides")
    parser.add_argument("--no_open3d", action="store_true")
    parser.add_argument("--free_space", action="store_true", help="rows with fresco_reconstruct -free_space, too")
    parser.add_argument("--volumetric_only", action="store_true", help="no rows of fresco_optimize")
    parser.add_argument("--beyond", type=float, default=0, help="m: points kept out count if so far from their scanner")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    judge = Judge(options)
    judge.prepare()
    for depth in options.depths:
        if not options.no_open3d:
            judge.judge_open3d(depth)
        judge.judge_fresco(depth)
    for neighbours in options.neighbours:
        judge.judge_floor(neighbours)


if __name__ == "__main__":
    main()
