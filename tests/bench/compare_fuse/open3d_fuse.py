#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fuses an RGB-D folder with Open3D 0.16 (Debian's python3-open3d): a peer of `pixelsynth fuse`.

tsdf   ScalableTSDFVolume with --leaf metres a voxel, sdf_trunc of four voxels, extract_point_cloud
voxel  every frame lifted and accumulated, then voxel_down_sample at --leaf metres

Prints one JSON object: frames, points, seconds (reading and fusing) and write_seconds.
"""
import argparse
import json
import pathlib
import time

import numpy as np
import open3d as o3d

DEPTH_SCALE = 1000.0
DEPTH_TRUNC = 100.0  # metres: nothing is cut off


def pose_matrix(fields):
    """TUM: tx ty tz qx qy qz qw, camera-to-world."""
    matrix = np.eye(4)
    x, y, z, w = fields[3:]
    matrix[:3, :3] = o3d.geometry.get_rotation_matrix_from_quaternion([w, x, y, z])
    matrix[:3, 3] = fields[:3]
    return matrix


def frames(walk, hold_out):
    """Yields (colour path, depth path, world_from_cam) of the frames that are not held out."""
    lines = (walk / "trajectory.txt").read_text().splitlines()
    rows = [line.split() for line in lines if line and not line.startswith("#")]
    for i, row in enumerate(rows):
        if hold_out and i % hold_out == hold_out // 2:
            continue
        stem = f"{int(row[0]):05d}"
        yield (walk / "color" / f"{stem}.jpg", walk / "depth" / f"{stem}.png",
               pose_matrix([float(value) for value in row[1:]]))


def rgbd_image(color, depth):
    return o3d.geometry.RGBDImage.create_from_color_and_depth(
        o3d.io.read_image(str(color)), o3d.io.read_image(str(depth)), depth_scale=DEPTH_SCALE,
        depth_trunc=DEPTH_TRUNC, convert_rgb_to_intensity=False)


def fuse_tsdf(source, camera, leaf):
    volume = o3d.pipelines.integration.ScalableTSDFVolume(
        voxel_length=leaf, sdf_trunc=4 * leaf,
        color_type=o3d.pipelines.integration.TSDFVolumeColorType.RGB8)
    for color, depth, pose in source:
        volume.integrate(rgbd_image(color, depth), camera, np.linalg.inv(pose))
    return volume.extract_point_cloud()


def fuse_voxel(source, camera, leaf):
    whole = o3d.geometry.PointCloud()
    for color, depth, pose in source:
        whole += o3d.geometry.PointCloud.create_from_rgbd_image(
            rgbd_image(color, depth), camera, np.linalg.inv(pose))
    return whole.voxel_down_sample(leaf)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("method", choices=["tsdf", "voxel"])
    parser.add_argument("walk", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--leaf", type=float, default=0.01, help="metres")
    parser.add_argument("--hold-out", type=int, default=0, metavar="N",
                        help="leave out frames with index %% N == N / 2; 0 = none")
    args = parser.parse_args()

    source = list(frames(args.walk, args.hold_out))
    camera = o3d.io.read_pinhole_camera_intrinsic(str(args.walk / "intrinsics.json"))
    start = time.perf_counter()
    fuse = {"tsdf": fuse_tsdf, "voxel": fuse_voxel}[args.method]
    cloud = fuse(source, camera, args.leaf)
    fused = time.perf_counter()
    if not o3d.io.write_point_cloud(str(args.output), cloud):
        raise SystemExit(f"{args.output}: could not be written")
    print(json.dumps({"method": f"open3d_{args.method}", "leaf": args.leaf, "frames": len(source),
                      "points": len(cloud.points), "seconds": fused - start,
                      "write_seconds": time.perf_counter() - fused}))


if __name__ == "__main__":
    main()
