#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What normals do for the surface: scans of the generated conference room with true poses, normals found and smoothed in
several ways, fresco_reconstruct at its defaults, against the true room.

    normals_in_reconstruction.py --build build --noise 0.0025

Samples of the mesh within --near of a point of the cloud count. Distances to the true surface in mm, angles between the
normals of both surfaces in degrees."""
import argparse
import os
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import open3d as o3d
except ImportError:
    sys.exit(f"needs numpy and Open3D (apt-get install python3-open3d): not in {sys.executable}")

import room_surfaces as rooms

SAMPLES = 1_000_000
ROWS = [("plain", ["-plain"]), ("plain, 3 rounds", ["-plain", "-bilateral", "3"]), ("estimateNormals", []),
        ("then 1 round", ["-bilateral", "1"]), ("then 3 rounds", ["-bilateral", "3"]),
        ("then 5 rounds", ["-bilateral", "5"])]


class Room:
    def __init__(self, options, work):
        self.tools, self.work, self.near = os.path.join(options.build, "bin"), work, options.near
        self.run("fresco_scan", options.scene, work, "-no_images", "-stations", "6", "-points", "150000", "-noise",
                 str(options.noise))
        poses = np.loadtxt(os.path.join(work, "poses.txt")).reshape(-1, 4, 4)  # world from scan
        self.poses = {f"scan_{k:02d}.pcd": pose for k, pose in enumerate(poses)}
        for name in self.poses:
            scan = os.path.join(work, "scans", name)
            self.run("fresco_filter", scan, scan, "-veil", "20", "-outliers", "16", "2")
        truth = o3d.t.geometry.TriangleMesh.from_legacy(rooms.read_mesh(os.path.join(work, "truth.ply")))
        self.scene = o3d.t.geometry.RaycastingScene()
        self.scene.add_triangles(truth)

    def run(self, tool, *words):
        subprocess.run([os.path.join(self.tools, tool), *words, "-quiet"], check=True)

    def mesh(self, options):
        cloud, oriented = o3d.geometry.PointCloud(), os.path.join(self.work, "oriented.pcd")
        for name, pose in self.poses.items():
            self.run("fresco_normals", os.path.join(self.work, "scans", name), oriented, *options)
            scan = o3d.io.read_point_cloud(oriented, remove_nan_points=True)
            cloud += scan.select_by_index(np.flatnonzero(np.isfinite(np.asarray(scan.normals)).all(1))).transform(pose)
        points, mesh = (os.path.join(self.work, name) for name in ("points.ply", "mesh.ply"))
        o3d.io.write_point_cloud(points, cloud)
        self.run("fresco_reconstruct", points, mesh)
        return rooms.read_mesh(mesh), cloud

    def row(self, options):
        mesh, cloud = self.mesh(options)
        points, _ = rooms.sample(mesh, SAMPLES)
        points = points[rooms.distances_to_cloud(points, cloud) < self.near].astype(np.float32)
        own = o3d.t.geometry.RaycastingScene()
        own.add_triangles(o3d.t.geometry.TriangleMesh.from_legacy(mesh))
        here, there = (s.compute_closest_points(o3d.core.Tensor(points)) for s in (own, self.scene))
        off = np.linalg.norm(there["points"].numpy() - points, axis=1)
        cosine = np.abs((here["primitive_normals"].numpy() * there["primitive_normals"].numpy()).sum(1))
        angle = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
        return (f" {1000 * off.mean():.2f} / {1000 * np.sqrt((off**2).mean()):.2f} |"
                f" {angle.mean():.2f}, {np.median(angle):.2f}, {100 * np.mean(angle > 20):.1f} % | {len(cloud.points)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build", help="default: %(default)s")
    parser.add_argument("--scene", default="conference_room", help="default: %(default)s")
    parser.add_argument("--noise", type=float, default=0.0025, help="as fresco_scan -noise (default: %(default)s)")
    parser.add_argument("--near", type=float, default=0.03, help="metres (default: %(default)s)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        room = Room(options, work)
        print("| normals | mean / RMS, mm | angle: mean, median, > 20 | points |\n|---|---|---|---|")
        for name, words in ROWS:
            print(f"| {name} |{room.row(words)}", flush=True)


if __name__ == "__main__":
    main()
