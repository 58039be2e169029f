#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How much of the thin rods of a room (legs of tables and chairs) a reconstruction holds.

Of the surface of the rods in TRUTH (connected parts no thicker than --thickest and at least --shortest long) that was
seen (a point of CLOUD within --seen), the share that has the mesh within --near. Each MESH is measured.
"""
import argparse

import numpy as np
import open3d as o3d

import room_surfaces as rooms


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("truth")
    parser.add_argument("cloud")
    parser.add_argument("mesh", nargs="+")
    parser.add_argument("--thickest", type=float, default=0.065, help="m")
    parser.add_argument("--shortest", type=float, default=0.2, help="m")
    parser.add_argument("--seen", type=float, default=0.01, help="m")
    parser.add_argument("--near", type=float, default=0.02, help="m")
    options = parser.parse_args()

    truth, count = rooms.rods(rooms.read_mesh(options.truth), options.thickest, options.shortest)
    if count == 0:
        raise SystemExit(options.truth + ": no rods")
    points, area = rooms.sample(truth, 100_000)
    points = points[rooms.distances_to_cloud(points, o3d.io.read_point_cloud(options.cloud)) < options.seen]
    print(f"{count} rods, {area * 100_000:.2f} m^2, of which {100 * len(points) / 100_000:.0f} % were seen")
    for path in options.mesh:
        there = rooms.distances_to_mesh(points, rooms.read_mesh(path)) < options.near
        print(f"{path}: {100 * np.mean(there):.1f} % of what was seen is there")


if __name__ == "__main__":
    main()
