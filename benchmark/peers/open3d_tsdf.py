#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Peer: TSDF fusion of Open3D. Reads an RGB-D folder (as fresco_model), writes a PLY mesh."""
import argparse
import glob
import os
import sys


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", help="camera-intrinsics.txt, frame-*.{color.jpg,depth.png,pose.txt}")
    parser.add_argument("output")
    parser.add_argument("--cell", type=float, default=0.01, help="side of a cell, metres; truncation is four cells")
    parser.add_argument("--far", type=float, default=4.0, help="depths beyond are left out, metres")
    arguments = parser.parse_args()

    import cv2
    import numpy as np
    import open3d as o3d

    K = np.loadtxt(os.path.join(arguments.folder, "camera-intrinsics.txt"))
    volume = o3d.pipelines.integration.ScalableTSDFVolume(
        voxel_length=arguments.cell, sdf_trunc=4 * arguments.cell,
        color_type=o3d.pipelines.integration.TSDFVolumeColorType.NoColor)
    for path in sorted(glob.glob(os.path.join(arguments.folder, "frame-*.pose.txt"))):
        pose = np.loadtxt(path)
        depth = cv2.imread(path[:-len("pose.txt")] + "depth.png", cv2.IMREAD_UNCHANGED)
        if depth is None or not np.isfinite(pose).all():
            continue
        depth[depth == 65535] = 0
        height, width = depth.shape
        gray = o3d.geometry.Image(np.zeros((height, width, 3), np.uint8))
        image = o3d.geometry.RGBDImage.create_from_color_and_depth(
            gray, o3d.geometry.Image(depth), depth_scale=1000.0, depth_trunc=arguments.far, convert_rgb_to_intensity=False)
        camera = o3d.camera.PinholeCameraIntrinsic(width, height, K[0, 0], K[1, 1], K[0, 2], K[1, 2])
        volume.integrate(image, camera, np.linalg.inv(pose))
    mesh = volume.extract_triangle_mesh()
    if not len(mesh.triangles) or not o3d.io.write_triangle_mesh(arguments.output, mesh):
        sys.exit(arguments.output + ": no mesh, or it cannot be written")


if __name__ == "__main__":
    main()
