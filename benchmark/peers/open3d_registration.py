#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Pairwise registration by Open3D, for the table beside bench_registration.

open3d_registration.py pairs|local TRUTH.txt VOXEL SCAN.pcd SCAN.pcd...
pairs: FPFH + RANSAC + point-to-plane ICP of every pair; overlap at the true pose by points within 2 voxels.
local: point-to-plane ICP of the first two from 0.3 m and 15 degrees off.
"""
import sys
import time

import numpy as np
import open3d as o3d

registration = o3d.pipelines.registration


def error(found, truth, middle):
    difference = np.linalg.inv(truth) @ found
    angle = np.degrees(np.arccos(np.clip((np.trace(difference[:3, :3]) - 1) / 2, -1, 1)))
    return np.linalg.norm((found - truth) @ np.append(middle, 1)), angle


def prepare(cloud, voxel):
    thinned = cloud.voxel_down_sample(voxel)
    thinned.estimate_normals(o3d.geometry.KDTreeSearchParamHybrid(2 * voxel, 30))
    return thinned, registration.compute_fpfh_feature(thinned, o3d.geometry.KDTreeSearchParamHybrid(5 * voxel, 100))


def align(source, target, voxel):
    ransac = registration.registration_ransac_based_on_feature_matching(
        source[0], target[0], source[1], target[1], True, 1.5 * voxel,
        registration.TransformationEstimationPointToPoint(False), 3,
        [registration.CorrespondenceCheckerBasedOnEdgeLength(0.9),
         registration.CorrespondenceCheckerBasedOnDistance(1.5 * voxel)],
        registration.RANSACConvergenceCriteria(100000, 0.999))
    return registration.registration_icp(source[0], target[0], 1.5 * voxel, ransac.transformation,
                                         registration.TransformationEstimationPointToPlane()).transformation


def overlap(source, target, truth, voxel):
    def share(a, b, pose):
        moved = o3d.geometry.PointCloud(a).transform(pose)
        return np.mean(np.asarray(moved.compute_point_cloud_distance(b)) < 1.5 * voxel)
    return max(share(source, target, truth), share(target, source, np.linalg.inv(truth)))


def pairs(clouds, truth, voxel):
    start = time.process_time()
    prepared = [prepare(cloud, voxel) for cloud in clouds]
    print("preparation %.3f s a scan, points %s" % ((time.process_time() - start) / len(clouds),
                                                    [len(p[0].points) for p in prepared]))
    classes, spent, tried = {0.5: [0, 0], 0.3: [0, 0], 0.1: [0, 0], 0.0: [0, 0]}, 0.0, 0
    for a in range(len(clouds)):
        for b in range(a + 1, len(clouds)):
            true = np.linalg.inv(truth[a]) @ truth[b]
            start = time.process_time()
            found = align(prepared[b], prepared[a], voxel)
            spent += time.process_time() - start
            tried += 1
            distance, angle = error(found, true, np.asarray(clouds[b].points).mean(0))
            share = overlap(prepared[b][0], prepared[a][0], true, voxel)
            own = classes[max(least for least in classes if share >= least)]
            own[0] += 1
            own[1] += distance < 0.2 and angle < 6
    for least, (count, right) in classes.items():
        print("> %3.0f %%  %5d pairs  %5d right" % (100 * least, count, right))
    print("processor time %.3f s a pair" % (spent / tried))


def local(clouds, truth, voxel):
    random = np.random.default_rng(1)
    true = np.linalg.inv(truth[0]) @ truth[1]
    for name, clouds_used in (("thinned", [c.voxel_down_sample(voxel) for c in clouds[:2]]), ("all points", clouds[:2])):
        for cloud in clouds_used:
            cloud.estimate_normals(o3d.geometry.KDTreeSearchParamKNN(16))
        spent, good, count = 0.0, 0, 5
        for _ in range(count):
            axis, shift = random.normal(size=3), random.normal(size=3)
            guess = np.eye(4)
            guess[:3, :3] = o3d.geometry.get_rotation_matrix_from_axis_angle(np.radians(15) * axis / np.linalg.norm(axis))
            guess[:3, 3] = 0.3 * shift / np.linalg.norm(shift)
            start = time.time()
            found = registration.registration_icp(
                clouds_used[1], clouds_used[0], 0.5, true @ guess,
                registration.TransformationEstimationPointToPlane(),
                registration.ICPConvergenceCriteria(1e-6, 1e-6, 50)).transformation
            spent += time.time() - start
            distance, angle = error(found, true, np.asarray(clouds[1].points).mean(0))
            good += distance < 0.05 and angle < 1
        print("Open3D ICP point-to-plane (%s) %.3f s, %d of %d right" % (name, spent / count, good, count))


def main():
    if len(sys.argv) < 6 or sys.argv[1] not in ("pairs", "local"):
        sys.exit(__doc__)
    truth = np.loadtxt(sys.argv[2]).reshape(-1, 4, 4)
    clouds = [o3d.io.read_point_cloud(path).remove_non_finite_points() for path in sys.argv[4:]]
    (pairs if sys.argv[1] == "pairs" else local)(clouds, truth, float(sys.argv[3]))


if __name__ == "__main__":
    main()
