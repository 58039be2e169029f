#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trimming by support against a quantile of the vertices' density, on a room whose truth is known.

Reconstructs CLOUD with fresco_reconstruct at several -trim_levels and with Open3D, whose vertices below several
quantiles of density are removed. False area: what lies farther than --far from TRUTH. Lost area: what of TRUTH was seen
(a point of CLOUD within --near) and has no mesh within --near; the first row says what the closed mesh lacks already.
"""
import argparse
import os
import subprocess
import tempfile

import numpy as np
import open3d as o3d

import room_surfaces as rooms

HERE = os.path.dirname(os.path.abspath(__file__))
SAMPLES = 300_000


class Judge:
    def __init__(self, options):
        self.options = options
        self.truth = rooms.read_mesh(options.truth)
        points, self.area = rooms.sample(self.truth, SAMPLES)
        cloud = o3d.io.read_point_cloud(options.cloud)
        self.seen = points[rooms.distances_to_cloud(points, cloud) < options.near]
        print(f"truth {self.area * SAMPLES:.1f} m^2, seen {self.area * len(self.seen):.1f} m^2")
        print("| mesh | area, m^2 | false, m^2 | lost, m^2 |\n|---|---|---|---|")

    def judge(self, name, mesh):
        points, area = rooms.sample(mesh, SAMPLES)
        false = area * np.sum(rooms.distances_to_mesh(points, self.truth) > self.options.far)
        lost = self.area * np.sum(rooms.distances_to_mesh(self.seen, mesh) > self.options.near)
        print(f"| {name} | {area * SAMPLES:.1f} | {false:.2f} | {lost:.2f} |", flush=True)


def judge_fresco(judge, options):
    with tempfile.TemporaryDirectory() as folder:
        output = os.path.join(folder, "mesh.ply")
        for levels in options.levels:
            subprocess.run([os.path.join(options.bin, "fresco_reconstruct"), options.cloud, output, "-depth",
                            str(options.depth), "-trim_levels", str(levels), "-quiet"], check=True)
            judge.judge(f"fresco, {levels:g} levels" if levels else "fresco, closed", rooms.read_mesh(output))


def judge_open3d(judge, options):
    cloud = o3d.io.read_point_cloud(options.cloud)
    closed, densities = o3d.geometry.TriangleMesh.create_from_point_cloud_poisson(
        cloud, depth=options.depth, n_threads=options.threads)
    densities = np.asarray(densities)
    for quantile in options.quantiles:
        mesh = o3d.geometry.TriangleMesh(closed)
        mesh.remove_vertices_by_mask(densities < np.quantile(densities, quantile))
        judge.judge(f"Open3D, quantile {quantile:g}" if quantile else "Open3D, as it comes", mesh)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("truth")
    parser.add_argument("cloud", help="PLY points with normals")
    parser.add_argument("--bin", default=os.path.join(HERE, "..", "..", "build", "bin"), help="folder of the programs")
    parser.add_argument("--depth", type=int, default=9)
    parser.add_argument("--threads", type=int, default=2, help="of Open3D")
    parser.add_argument("--levels", type=float, nargs="+", default=[0, 1, 1.5, 2, 2.5, 3, 4])
    parser.add_argument("--quantiles", type=float, nargs="*", default=[0, 0.01, 0.02, 0.05, 0.1, 0.2])
    parser.add_argument("--near", type=float, default=0.03, help="m")
    parser.add_argument("--far", type=float, default=0.05, help="m")
    options = parser.parse_args()
    judge = Judge(options)
    judge_fresco(judge, options)
    if options.quantiles:
        judge_open3d(judge, options)


if __name__ == "__main__":
    main()
