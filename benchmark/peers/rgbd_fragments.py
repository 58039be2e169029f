#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Cuts an RGB-D sequence into fragments, each a cloud in a frame of its own, for registration benchmarks.

rgbd_fragments.py FOLDER OUT_DIR FRAMES [-thin M | -points N] [-arbitrary SEED]
FOLDER holds camera-intrinsics.txt and frame-*.{depth.png,pose.txt} (16 bit, millimetres; world from camera).
FRAMES consecutive frames make a fragment. Written are fragment_NN.pcd, truth.txt (world from fragment) and
cameras.txt (centre of the middle camera in the fragment's frame, for posejudge's --centers).
-thin M         edge of the cells that keep one point, metres (default 0.01)
-points N       instead, cells so wide that at most N points are left
-arbitrary SEED each fragment turned and moved (by up to 3 m a coordinate) at random; else the frame of its first camera
"""
import argparse
import glob
import os

import numpy as np
import open3d as o3d

FARTHEST = 6.0  # metres: beyond, depth cameras guess


def frame_points(folder, name, intrinsics):
    depth = np.asarray(o3d.io.read_image(os.path.join(folder, name + ".depth.png"))).astype(float) / 1000.0
    pose = np.loadtxt(os.path.join(folder, name + ".pose.txt"))
    v, u = np.nonzero((depth > 0) & (depth < FARTHEST))
    z = depth[v, u]
    fx, fy, cx, cy = intrinsics[0, 0], intrinsics[1, 1], intrinsics[0, 2], intrinsics[1, 2]
    points = np.stack([(u - cx) / fx * z, (v - cy) / fy * z, z], 1)
    return points @ pose[:3, :3].T + pose[:3, 3], pose


def thin(points, options):
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points))
    edge = options.thin
    thinned = cloud.voxel_down_sample(edge)
    while options.points and len(thinned.points) > options.points:
        edge *= 1.05
        thinned = cloud.voxel_down_sample(edge)
    return np.asarray(thinned.points)


def fragment_frame(poses, random):
    if random is None:
        return poses[0]
    rotation, triangle = np.linalg.qr(random.normal(size=(3, 3)))
    rotation *= np.sign(np.diag(triangle))
    if np.linalg.det(rotation) < 0:
        rotation[:, 0] *= -1
    frame = np.eye(4)
    frame[:3, :3] = rotation
    frame[:3, 3] = poses[0][:3, 3] + random.uniform(-3, 3, 3)
    return frame


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("out")
    parser.add_argument("frames", type=int)
    parser.add_argument("-thin", type=float, default=0.01)
    parser.add_argument("-points", type=int, default=0)
    parser.add_argument("-arbitrary", type=int)
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    random = None if options.arbitrary is None else np.random.default_rng(options.arbitrary)
    intrinsics = np.loadtxt(os.path.join(options.folder, "camera-intrinsics.txt"))
    names = sorted(os.path.basename(f)[:-len(".depth.png")] for f in glob.glob(options.folder + "/frame-*.depth.png"))
    truth, centers = [], []
    for k in range(0, len(names) - options.frames + 1, options.frames):
        parts = [frame_points(options.folder, name, intrinsics) for name in names[k:k + options.frames]]
        poses = [pose for _, pose in parts]
        frame = fragment_frame(poses, random)
        inverse = np.linalg.inv(frame)
        points = thin(np.vstack([p for p, _ in parts]), options) @ inverse[:3, :3].T + inverse[:3, 3]
        cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points))
        o3d.io.write_point_cloud("%s/fragment_%02d.pcd" % (options.out, len(truth)), cloud)
        truth.append(frame.ravel())
        centers.append((inverse @ poses[len(poses) // 2][:, 3])[:3])
    np.savetxt(options.out + "/truth.txt", truth, "%.12g")
    np.savetxt(options.out + "/cameras.txt", centers, "%.9g")
    print("%d fragments" % len(truth))


if __name__ == "__main__":
    main()
