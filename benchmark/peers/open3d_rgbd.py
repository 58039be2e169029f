#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tracks an RGB-D video with Open3D, for the table beside fresco_track.

open3d_rgbd.py FOLDER OUT.txt [-focal F] [-fragment N]
FOLDER holds camera-intrinsics.txt and frame-*.{color.jpg,depth.png}. Written are the poses, world from camera, a line a
frame. The steps are those of Open3D's reconstruction system: odometry by colour and depth (Park, Zhou, Koltun 2017 for the
hybrid Jacobian) between frames and between key frames (every fifth) of a fragment, a pose graph a fragment, FPFH and RANSAC
between fragments, coloured ICP of what overlaps, a pose graph of the fragments.
-focal F     focal length of colour images that are not registered to the depth images; they are resampled as if the cameras
             lay in one place
-fragment N  frames a fragment (default 100)
"""
import argparse
import glob
import os
import time

import numpy as np
import open3d as o3d

registration = o3d.pipelines.registration
odometry = o3d.pipelines.odometry
KEY, VOXEL, FARTHEST = 5, 0.05, 4.0  # frames; metres


def resampled(color, scale):
    """The colour image as the depth camera would see it."""
    height, width = color.shape[:2]
    v, u = np.mgrid[0:height, 0:width]
    x = np.clip(np.rint((u - width / 2) * scale + width / 2), 0, width - 1).astype(int)
    y = np.clip(np.rint((v - height / 2) * scale + height / 2), 0, height - 1).astype(int)
    return np.ascontiguousarray(color[y, x])


def read(folder, name, scale):
    color = o3d.io.read_image(os.path.join(folder, name + ".color.jpg"))
    if scale != 1:
        color = o3d.geometry.Image(resampled(np.asarray(color), scale))
    depth = np.asarray(o3d.io.read_image(os.path.join(folder, name + ".depth.png"))).copy()
    depth[depth == 65535] = 0
    return o3d.geometry.RGBDImage.create_from_color_and_depth(
        color, o3d.geometry.Image(depth), depth_scale=1000, depth_trunc=FARTHEST, convert_rgb_to_intensity=True)


def solve(graph, distance):
    registration.global_optimization(
        graph, registration.GlobalOptimizationLevenbergMarquardt(),
        registration.GlobalOptimizationConvergenceCriteria(),
        registration.GlobalOptimizationOption(max_correspondence_distance=distance, edge_prune_threshold=0.25,
                                              preference_loop_closure=0.1, reference_node=0))


def fragment(images, camera):
    """Poses of the frames in the frame of the first, and their points."""
    option = odometry.OdometryOption()
    graph = registration.PoseGraph()
    graph.nodes.append(registration.PoseGraphNode(np.eye(4)))
    pose = np.eye(4)
    for a in range(len(images)):
        for b in range(a + 1, len(images)):
            if b != a + 1 and (a % KEY or b % KEY):
                continue
            found, motion, information = odometry.compute_rgbd_odometry(
                images[a], images[b], camera, np.eye(4), odometry.RGBDOdometryJacobianFromHybridTerm(), option)
            if b == a + 1:
                pose = motion @ pose
                graph.nodes.append(registration.PoseGraphNode(np.linalg.inv(pose)))
                graph.edges.append(registration.PoseGraphEdge(a, b, motion, information, uncertain=False))
            elif found:
                graph.edges.append(registration.PoseGraphEdge(a, b, motion, information, uncertain=True))
    solve(graph, 0.07)
    poses = [node.pose for node in graph.nodes]
    cloud = o3d.geometry.PointCloud()
    for image, pose in zip(images[::KEY], poses[::KEY]):
        cloud += o3d.geometry.PointCloud.create_from_rgbd_image(image, camera).transform(pose)
    cloud = cloud.voxel_down_sample(VOXEL / 2)
    cloud.estimate_normals(o3d.geometry.KDTreeSearchParamHybrid(VOXEL, 30))
    return poses, cloud


def joined(parts):
    """World from fragment."""
    clouds = [cloud for _, cloud in parts]
    thin = [c.voxel_down_sample(VOXEL) for c in clouds]
    features = [registration.compute_fpfh_feature(c, o3d.geometry.KDTreeSearchParamHybrid(5 * VOXEL, 100)) for c in thin]
    graph = registration.PoseGraph()
    pose = np.eye(4)
    graph.nodes.append(registration.PoseGraphNode(pose))
    for a in range(len(parts)):
        for b in range(a + 1, len(parts)):
            if b == a + 1:
                guess = np.linalg.inv(parts[a][0][-1])
            else:
                guess = registration.registration_ransac_based_on_feature_matching(
                    thin[a], thin[b], features[a], features[b], False, 1.4 * VOXEL,
                    registration.TransformationEstimationPointToPoint(False), 4,
                    [registration.CorrespondenceCheckerBasedOnEdgeLength(0.9),
                     registration.CorrespondenceCheckerBasedOnDistance(1.4 * VOXEL)],
                    registration.RANSACConvergenceCriteria(1000000, 0.999)).transformation
            result = registration.registration_colored_icp(
                clouds[a], clouds[b], 1.4 * VOXEL / 2, guess, registration.TransformationEstimationForColoredICP(),
                registration.ICPConvergenceCriteria(1e-6, 1e-6, 50))
            information = registration.get_information_matrix_from_point_clouds(clouds[a], clouds[b], 0.7 * VOXEL,
                                                                                result.transformation)
            if b == a + 1:
                pose = result.transformation @ pose
                graph.nodes.append(registration.PoseGraphNode(np.linalg.inv(pose)))
                graph.edges.append(registration.PoseGraphEdge(a, b, result.transformation, information, uncertain=False))
            elif result.fitness > 0.3:
                graph.edges.append(registration.PoseGraphEdge(a, b, result.transformation, information, uncertain=True))
    solve(graph, 0.7 * VOXEL)
    return [node.pose for node in graph.nodes]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("out")
    parser.add_argument("-focal", type=float, default=0)
    parser.add_argument("-fragment", type=int, default=100)
    options = parser.parse_args()
    start = time.process_time()
    o3d.utility.random.seed(1)
    K = np.loadtxt(os.path.join(options.folder, "camera-intrinsics.txt"))
    names = sorted(os.path.basename(f)[:-len(".depth.png")] for f in glob.glob(options.folder + "/frame-*.depth.png"))
    height, width = np.asarray(o3d.io.read_image(os.path.join(options.folder, names[0] + ".depth.png"))).shape
    camera = o3d.camera.PinholeCameraIntrinsic(width, height, K[0, 0], K[1, 1], K[0, 2], K[1, 2])
    scale = options.focal / K[0, 0] if options.focal else 1
    parts = []
    for begin in range(0, len(names), options.fragment):  # the first frame of the next is the last of each
        parts.append(fragment([read(options.folder, n, scale) for n in names[begin:begin + options.fragment + 1]], camera))
    poses = []
    for world, (own, _) in zip(joined(parts), parts):
        poses += [world @ pose for pose in own[:options.fragment]]
    np.savetxt(options.out, [pose.ravel() for pose in poses[:len(names)]], "%.9g")
    print("%d frames, %.1f s of processor time" % (len(names), time.process_time() - start))


if __name__ == "__main__":
    main()
