#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Registers scans without start poses by fresco and its peers, each as a process of its own, and judges all alike.

registration_table.py BIN_DIR OUT_DIR FLOOR... [options]: FLOOR is a folder with scans/*.pcd and poses.txt, the truth.
Prints a line for each floor and method: placed, false (-distance, -degrees) and worst error of the others after the fit
to the largest set that agrees, as office_floors.py has it, and processor seconds of the whole process.
"""
import argparse
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "experiments"))
from office_floors import FALSE_DEGREES, FALSE_DISTANCE, errors, processor_seconds, read_poses  # noqa: E402


def commands(args, scans, out):
    """Of each method: what writes poses.txt into the folder `out`."""
    poses = out + "/poses.txt"
    pcl = [args.bin + "/fresco_benchmark_peer_pcl_global_registration", scans, poses, "-voxel", str(args.voxel)]
    return {"fresco": [args.bin + "/fresco_register", scans, "-o", out, "-quiet", "-threads", "1"],
            "open3d": ["/usr/bin/python3", HERE + "/open3d_multiway.py", scans, poses, str(args.voxel)],
            "pcl": pcl + ["-graph", "none"], "pcl_lum": pcl, "pcl_elch": pcl + ["-graph", "elch"]}


def judge(found, truth, args):
    placed = [k for k, pose in enumerate(found) if pose is not None]
    shift, turn = errors([found[k] for k in placed], [truth[k] for k in placed], args.distance, args.degrees)
    right = (shift <= args.distance) & (turn <= args.degrees)
    return len(placed), (~right).sum(), 1000 * shift[right].max(), turn[right].max()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("out")
    parser.add_argument("floors", nargs="+")
    parser.add_argument("-methods", default="fresco,open3d,pcl_lum", help="also pcl, without a graph, and pcl_elch")
    parser.add_argument("-voxel", type=float, default=0.1, help="of the peers, metres")
    parser.add_argument("-distance", type=float, default=FALSE_DISTANCE, help="above, a scan is false; metres")
    parser.add_argument("-degrees", type=float, default=FALSE_DEGREES)
    args = parser.parse_args()
    one_thread = {**os.environ, "OMP_NUM_THREADS": "1"}
    print("| floor | method | scans | placed / false | worst of the others | processor, s |\n|---|---|---|---|---|---|")
    for floor in args.floors:
        name, truth = os.path.basename(floor.rstrip("/")), read_poses(floor + "/poses.txt")
        for method in args.methods.split(","):
            out = f"{args.out}/{name}_{method}"
            os.makedirs(out, exist_ok=True)
            seconds = processor_seconds(commands(args, floor + "/scans", out)[method], one_thread)
            placed, false, worst, turn = judge(read_poses(out + "/poses.txt"), truth, args)
            print(f"| {name} | {method} | {len(truth)} | {placed} / {false} | {worst:.1f} mm, {turn:.3f} degrees | "
                  f"{seconds:.0f} |", flush=True)


if __name__ == "__main__":
    main()
