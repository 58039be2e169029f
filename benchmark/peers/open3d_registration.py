#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Pairwise registration by Open3D, for the table beside fresco_benchmark_registration.

open3d_registration.py pairs|pairs-one-way|local TRUTH.txt VOXEL SCAN.pcd SCAN.pcd... [OVERLAPS.txt]
pairs: FPFH + RANSAC + point-to-plane ICP of every pair; overlap at the true pose by points within 1.5 voxels, or as in
       OVERLAPS.txt, which fresco_benchmark_registration writes. A pair is held certain if its overlap is above 30 % as found.
       Features must choose each other; with pairs-one-way they need not.
local: point-to-plane ICP of the first two, from 0.3 m and 15 degrees off and from 5 cm and 3 degrees off.
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
    thinned.orient_normals_towards_camera_location(np.zeros(3))
    return thinned, registration.compute_fpfh_feature(thinned, o3d.geometry.KDTreeSearchParamHybrid(5 * voxel, 100))


def align(source, target, voxel, mutual):
    ransac = registration.registration_ransac_based_on_feature_matching(
        source[0], target[0], source[1], target[1], mutual, 1.5 * voxel,
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


def given_overlaps(path):
    return {(int(a), int(b)): share for a, b, share in np.loadtxt(path)} if path else {}


def pairs(clouds, truth, voxel, overlaps, mutual):
    o3d.utility.random.seed(1)
    start = time.process_time()
    prepared = [prepare(cloud, voxel) for cloud in clouds]
    print("preparation %.3f s a scan" % ((time.process_time() - start) / len(clouds)))
    classes, spent, tried = {0.5: [0] * 4, 0.3: [0] * 4, 0.1: [0] * 4, 0.0: [0] * 4}, 0.0, 0
    for a in range(len(clouds)):
        for b in range(a + 1, len(clouds)):
            true = np.linalg.inv(truth[a]) @ truth[b]
            start = time.process_time()
            found = align(prepared[b], prepared[a], voxel, mutual)
            spent += time.process_time() - start
            tried += 1
            distance, angle = error(found, true, np.asarray(clouds[b].points).mean(0))
            share = overlaps.get((a, b), overlap(prepared[b][0], prepared[a][0], true, voxel))
            own = classes[max(least for least in classes if share >= least)]
            right = distance < 0.2 and angle < 6
            certain = overlap(prepared[b][0], prepared[a][0], found, voxel) > 0.3
            for k, counts in enumerate((True, right, right and certain, not right and certain)):
                own[k] += counts
    print("overlap  pairs  right  held certain: right  wrong")
    for least, (count, right, certain_right, certain_wrong) in classes.items():
        print("> %3.0f %%  %5d  %5d  %19d  %5d" % (100 * least, count, right, certain_right, certain_wrong))
    print("processor time %.3f s a pair" % (spent / tried))


def disturbance(random, distance, degrees):
    axis, shift = random.normal(size=3), random.normal(size=3)
    guess = np.eye(4)
    guess[:3, :3] = o3d.geometry.get_rotation_matrix_from_axis_angle(np.radians(degrees) * axis / np.linalg.norm(axis))
    guess[:3, 3] = distance * shift / np.linalg.norm(shift)
    return guess


def local(clouds, truth, voxel):
    true = np.linalg.inv(truth[0]) @ truth[1]
    middle = np.asarray(clouds[1].points).mean(0)
    for distance, degrees, reach in ((0.3, 15, 0.5), (0.05, 3, 0.2)):
        print("from %g m and %g degrees off; processor seconds, errors of those that ended right" % (distance, degrees))
        for name in ("thinned", "all points"):
            start = time.process_time()
            used = [c.voxel_down_sample(voxel) if name == "thinned" else o3d.geometry.PointCloud(c) for c in clouds[:2]]
            for cloud in used:
                cloud.estimate_normals(o3d.geometry.KDTreeSearchParamKNN(16))
            preparation = time.process_time() - start
            random, spent, right, count = np.random.default_rng(1), 0.0, [], 5
            for _ in range(count):
                guess = true @ disturbance(random, distance, degrees)
                start = time.process_time()
                found = registration.registration_icp(used[1], used[0], reach, guess,
                                                      registration.TransformationEstimationPointToPlane(),
                                                      registration.ICPConvergenceCriteria(1e-6, 1e-6, 50)).transformation
                spent += time.process_time() - start
                off, angle = error(found, true, middle)
                if off < 0.05 and angle < 1:
                    right.append(off)
            print("Open3D ICP point-to-plane, %s: prepare %.3f, align %.3f, total %.3f, %d of %d right, mean %.2f mm" % (
                name, preparation, spent / count, preparation + spent / count, len(right), count,
                1000 * np.mean(right) if right else np.nan))


def main():
    if len(sys.argv) < 6 or sys.argv[1] not in ("pairs", "pairs-one-way", "local"):
        sys.exit(__doc__)
    overlap_file = sys.argv.pop() if sys.argv[-1].endswith(".txt") else ""
    truth = np.loadtxt(sys.argv[2]).reshape(-1, 4, 4)
    clouds = [o3d.io.read_point_cloud(path).remove_non_finite_points() for path in sys.argv[4:]]
    if sys.argv[1] == "local":
        local(clouds, truth, float(sys.argv[3]))
    else:
        pairs(clouds, truth, float(sys.argv[3]), given_overlaps(overlap_file), sys.argv[1] == "pairs")


if __name__ == "__main__":
    main()
