#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Peer: Poisson reconstruction of Open3D. Reads a PLY cloud with normals, writes a PLY mesh."""
import argparse
import sys


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("input")
    parser.add_argument("output")
    parser.add_argument("--depth", type=int, default=8, help="octree depth")
    parser.add_argument("--threads", type=int, default=0, help="0 = all cores")
    arguments = parser.parse_args()

    import open3d as o3d

    cloud = o3d.io.read_point_cloud(arguments.input)
    if not cloud.has_normals():
        sys.exit(arguments.input + ": no points with normals")
    mesh, _ = o3d.geometry.TriangleMesh.create_from_point_cloud_poisson(
        cloud, depth=arguments.depth, n_threads=arguments.threads if arguments.threads > 0 else -1)
    if not o3d.io.write_triangle_mesh(arguments.output, mesh):
        sys.exit(arguments.output + ": cannot be written")


if __name__ == "__main__":
    main()
