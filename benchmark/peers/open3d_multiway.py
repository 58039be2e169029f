#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Registers whole floors by Open3D's multiway registration, judged as office_floors.py does.

open3d_multiway.py VOXEL FLOOR...: FLOOR is a folder with scans/*.pcd and poses.txt. Every pair by FPFH, RANSAC and
point-to-plane ICP as in Open3D's tutorial; pairs that overlap by 30 % are uncertain edges of a pose graph, optimised
with line processes. Placed are the scans of the largest set that hangs together by the edges it keeps.
"""
import glob
import os
import sys
import time

import numpy as np
import open3d as o3d

from open3d_registration import align, prepare, registration

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "experiments"))
from office_floors import FALSE_DEGREES, FALSE_DISTANCE, errors, read_poses  # noqa: E402

CERTAIN_OVERLAP = 0.3


def pair_edges(clouds, voxel):
    prepared = [prepare(cloud, voxel) for cloud in clouds]
    edges = []
    for a in range(len(clouds)):
        for b in range(a + 1, len(clouds)):
            T = align(prepared[b], prepared[a], voxel, True)
            share = registration.evaluate_registration(prepared[b][0], prepared[a][0], 1.5 * voxel, T).fitness
            if share > CERTAIN_OVERLAP:
                information = registration.get_information_matrix_from_point_clouds(
                    prepared[b][0], prepared[a][0], 1.5 * voxel, T)
                edges.append((share, a, b, T, information))
    return sorted(edges, key=lambda edge: -edge[0])


def start_poses(count, edges):
    """A tree of the best edges; scans that it does not reach stay at the origin."""
    poses, group = [np.eye(4) for _ in range(count)], list(range(count))
    for _, a, b, T, _ in edges:
        if group[a] != group[b]:
            move, old = poses[a] @ T @ np.linalg.inv(poses[b]), group[b]
            for k in range(count):
                if group[k] == old:
                    poses[k], group[k] = move @ poses[k], group[a]
    return poses


def largest_group(count, edges):
    group = list(range(count))
    for edge in edges:
        old, new = group[edge.source_node_id], group[edge.target_node_id]
        group = [new if g == old else g for g in group]
    return [k for k in range(count) if group[k] == max(set(group), key=group.count)]


def multiway(clouds, voxel):
    edges = pair_edges(clouds, voxel)
    graph = registration.PoseGraph()
    for pose in start_poses(len(clouds), edges):
        graph.nodes.append(registration.PoseGraphNode(pose))
    for _, a, b, T, information in edges:
        graph.edges.append(registration.PoseGraphEdge(b, a, T, information, uncertain=True))
    registration.global_optimization(
        graph, registration.GlobalOptimizationLevenbergMarquardt(),
        registration.GlobalOptimizationConvergenceCriteria(),
        registration.GlobalOptimizationOption(max_correspondence_distance=1.5 * voxel, edge_prune_threshold=0.25))
    return [node.pose for node in graph.nodes], largest_group(len(clouds), graph.edges)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    o3d.utility.random.seed(1)
    print("| floor | stations | placed / false | worst of the others, mm | processor, s |\n|---|---|---|---|---|")
    for folder in sys.argv[2:]:
        clouds = [o3d.io.read_point_cloud(path) for path in sorted(glob.glob(folder + "/scans/*.pcd"))]
        truth, start = read_poses(folder + "/poses.txt"), time.process_time()
        poses, placed = multiway(clouds, float(sys.argv[1]))
        spent = time.process_time() - start
        shift, turn = errors([poses[k] for k in placed], [truth[k] for k in placed])
        wrong = (shift > FALSE_DISTANCE) | (turn > FALSE_DEGREES)
        print(f"| {os.path.basename(folder.rstrip('/'))} | {len(clouds)} | {len(placed)} / {wrong.sum()} | "
              f"{1000 * shift[~wrong].max():.0f} | {spent:.0f} |", flush=True)


if __name__ == "__main__":
    main()
