#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Registers scans without start poses by Open3D's multiway registration.

open3d_multiway.py FOLDER POSES.txt VOXEL: the scans are FOLDER/*.pcd. Every pair by FPFH, RANSAC and point-to-plane ICP
as in Open3D's tutorial; pairs that overlap by 30 % are uncertain edges of a pose graph, optimised with line processes.
Placed are the scans of the largest set that hangs together by the edges it keeps; the others are `none`.
"""
import glob
import sys

import numpy as np
import open3d as o3d

from open3d_registration import align, prepare, registration

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
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    o3d.utility.random.seed(1)
    clouds = [o3d.io.read_point_cloud(path) for path in sorted(glob.glob(sys.argv[1] + "/*.pcd"))]
    poses, placed = multiway(clouds, float(sys.argv[3]))
    with open(sys.argv[2], "w") as file:
        for k, pose in enumerate(poses):
            file.write(" ".join(repr(float(x)) for x in pose.ravel()) + "\n" if k in placed else "none\n")


if __name__ == "__main__":
    main()
