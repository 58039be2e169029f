#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Textures a generated room from photographs with faults of real cameras: texture_faults.py BIN_DIR JUDGE WORK_DIR [options].

Makes each data set with BIN_DIR/fresco_scan or fine_room.py unless it is there, keeps every 7th photograph out and prints
a row per fault: PSNR and SSIM after gain of the kept-out views, against the pictures without noise, from the true
cameras; the loss against the run without fault, over all and in the worst view. JUDGE renders a model: JUDGE MODEL.obj --cameras LIST.json
--json OUT.json, as described in docs/measurements/texture.md.
"""
import argparse
import json
import os
import resource
import subprocess

import fine_room
import numpy as np
from PIL import Image
from scipy.ndimage import shift

KEEP_OUT = 7


def beyond_pincushion(height, width):
    """what is beyond the picture where a barrel lens was undistorted and nothing cropped"""
    y, x = np.mgrid[-1:1:height * 1j, -1:1:width * 1j]
    return np.maximum(np.abs(x) + 0.08 * (1 - y * y), np.abs(y) + 0.08 * (1 - x * x)) > 1


def grown(mask):
    out = mask.copy()
    out[1:] |= mask[:-1]
    out[:-1] |= mask[1:]
    out[:, 1:] |= mask[:, :-1]
    out[:, :-1] |= mask[:, 1:]
    return out


def with_border(picture, _):
    """black, and soft by resampling"""
    out = picture.copy()
    out[beyond_pincushion(*picture.shape[:2])] = 0
    out[1:-1, 1:-1] = sum(out[1 + j:out.shape[0] - 1 + j, 1 + i:out.shape[1] - 1 + i]
                          for j in (-1, 0, 1) for i in (-1, 0, 1)) / 9
    return out


def with_alpha(picture, _):
    alpha = np.where(beyond_pincushion(*picture.shape[:2]), 0, 255)
    return np.dstack([picture * (alpha[..., None] > 0), alpha])


def with_fringe(picture, _):
    """chromatic aberration beside what is clipped, 5 pixels of 1280"""
    clipped = picture.min(2) >= 250
    near = clipped
    for _ in range(max(2, picture.shape[1] // 256)):
        near = grown(near)
    out = picture.copy()
    out[near & ~clipped] += [60, 0, 60]
    return np.minimum(out, 255)


def smeared_third(picture, number):
    """every third as by a hand that moves in a random direction; the sensor's noise comes after"""
    if number % 3:
        return picture
    random = np.random.default_rng(number)
    angle, length = random.uniform(0, np.pi), 8
    steps = np.linspace(-0.5, 0.5, 4 * length + 1) * length
    moved = sum(shift(picture, (t * np.sin(angle), t * np.cos(angle), 0), order=1, mode="nearest") for t in steps)
    return (moved / len(steps) + random.normal(0, 1.5, picture.shape) + 0.5).clip(0, 255)


FAULTS = [  # name, options of fresco_scan and of fine_room (None: not there), deviation of the mesh's vertices in metres, what
    # is done to the photographs
    ("none", "", {}, 0, None),
    ("vignetting, corners at 60 %", "-vignetting 0.6", None, 0, None),
    ("exposures x0.5 to x2, clipped", "-exposure 0.75", {"exposure": 2}, 0, None),
    ("somebody stands in every 10th photograph", "-intruder 10", None, 0, None),
    ("cameras off by 3 mm and 0.2 degrees", "-pose_noise 0.003 -turn_noise 0.2", {"shift": 0.003, "turn": 0.2}, 0, None),
    ("blur of 1 pixel", "-blur 1", None, 0, None),
    ("mesh off by 3 mm", "", {}, 0.003, None),
    ("black borders of undistortion", "", {}, 0, with_border),
    ("alpha of undistortion", "", {}, 0, with_alpha),
    ("exposures, violet fringe at what is clipped", "-exposure 0.75", {"exposure": 2}, 0, with_fringe),
    ("every 3rd photograph smeared by 8 pixels", "", {}, 0, smeared_third),
]


def run(*command):
    """Output is dropped. @return seconds of processor time"""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([str(c) for c in command], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def colmap_views(folder):
    """Kept-out views of a COLMAP text model with one pinhole camera, as (name, width, height, fx, fy, cx, cy, pose)."""
    def records(name):
        return [line.split() for line in open(os.path.join(folder, name)) if line.strip() and not line.startswith("#")]
    width, height, *K = map(float, records("cameras.txt")[0][2:])
    images = sorted((r for r in records("images.txt") if len(r) == 10), key=lambda r: r[9])
    for r in images[KEEP_OUT - 1::KEEP_OUT]:
        w, x, y, z = np.array(r[1:5], float) / np.linalg.norm(np.array(r[1:5], float))
        R = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                      [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                      [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = R.T, -R.T @ np.array(r[5:8], float)
        yield r[9], int(width), int(height), K, pose


def write_list(path, cameras, pictures):
    """pixel centres of the judge are whole numbers, COLMAP's lie at a half"""
    views = [dict(image=os.path.join(pictures, os.path.splitext(name)[0] + ".png"), width=width, height=height, fx=K[0],
                  fy=K[1], cx=K[2] - 0.5, cy=K[3] - 0.5, camera_to_world=pose.tolist())
             for name, width, height, K, pose in colmap_views(cameras)]
    json.dump({"views": views}, open(path, "w"))


def write_noisy(mesh, deviation, out):
    """Moves the vertices of a binary PLY file of our own, whose first three properties are x, y, z."""
    data = open(mesh, "rb").read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode()
    types = {"float": "f4", "double": "f8", "uchar": "u1", "int": "i4", "uint": "u4"}
    count, fields, element = 0, [], ""
    for line in header.splitlines():
        word = line.split()
        if word[0] == "element":
            element = word[1]
            count = int(word[2]) if element == "vertex" else count
        elif word[0] == "property" and element == "vertex":
            fields.append((word[2], "<" + types[word[1]]))
    vertices = np.frombuffer(data, np.dtype(fields), count, end).copy()
    random = np.random.default_rng(1)
    for axis in "xyz":
        vertices[axis] += random.normal(0, deviation, count)
    with open(out, "wb") as f:
        f.write(data[:end] + vertices.tobytes() + data[end + vertices.nbytes:])


def change_photographs(folder, change):
    """in place, as PNG files"""
    for number, name in enumerate(sorted(os.listdir(f"{folder}/images"))):
        picture = np.array(Image.open(f"{folder}/images/{name}").convert("RGB")).astype(float)
        os.remove(f"{folder}/images/{name}")
        Image.fromarray(change(picture, number).astype(np.uint8)).save(f"{folder}/images/{os.path.splitext(name)[0]}.png",
                                                               compress_level=1)
    lines = open(f"{folder}/cameras/images.txt").read()
    open(f"{folder}/cameras/images.txt", "w").write(lines.replace(".jpg", ".png"))


def make(args, number):
    """@return folder of the fault's data"""
    name, faults, fine, deviation, change = FAULTS[number]
    folder = os.path.join(args.work, f"data{number if faults or change or fine else 0}")
    if os.path.exists(os.path.join(folder, "poses.txt")):
        return folder
    if args.fine:
        fine_room.write_room(folder, args.views, *map(int, args.images.split("x")), args.seed, **fine)
    else:
        run(f"{args.bin}/fresco_scan", "conference_room", folder, "-stations", 1, "-points", 100, "-views", args.views,
            "-images", args.images, "-truth_images", "-seed", args.seed, "-threads", args.threads, "-quiet", *faults.split())
    if change:
        change_photographs(folder, change)
    return folder


def model_of(args, number):
    """@return what the judge says of the fault's model, seconds"""
    folder, deviation = make(args, number), FAULTS[number][3]
    mesh = os.path.join(folder, "truth.ply")
    if deviation:
        write_noisy(mesh, deviation, mesh := os.path.join(args.work, "noisy.ply"))
    model = os.path.join(args.work, f"model{number}.obj")
    seconds = run(f"{args.bin}/fresco_texture", mesh, f"{folder}/cameras", f"{folder}/images", model, "-keep_out", KEEP_OUT,
                  "-cameras_out", os.path.join(args.work, f"cameras{number}"), "-threads", args.threads, "-quiet",
                  *args.options.split())
    cameras = os.path.join(args.work, "cameras.json")
    write_list(cameras, os.path.join(args.work, "data0", "cameras"), os.path.abspath(os.path.join(folder, "truth_images")))
    verdict = os.path.join(args.work, f"verdict{number}.json")
    run(args.judge, model, "--cameras", "all=" + cameras, "--no-atlas", "--json", verdict,
        *(["--save", os.path.join(args.work, f"pictures{number}"), "--save-diff"] if args.save else []))
    return json.load(open(verdict))["views"]["all"], seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("judge")
    parser.add_argument("work")
    parser.add_argument("--views", type=int, default=35)
    parser.add_argument("--images", default="640x480")
    parser.add_argument("--fine", action="store_true", help="the room of fine_room.py in place of the conference room")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--faults", default="", help="numbers with commas, 0 = none, which is always run; empty = all")
    parser.add_argument("--options", default="", help="of fresco_texture")
    parser.add_argument("--save", action="store_true", help="keep the rendered views")
    args = parser.parse_args()
    os.makedirs(args.work, exist_ok=True)
    chosen = [int(n) for n in args.faults.split(",")] if args.faults else range(len(FAULTS))
    chosen = [n for n in chosen if FAULTS[n][2 if args.fine else 1] is not None]
    print("| fault | PSNR after gain | SSIM after gain | detail | loss | worst view's loss | CPU |\n|---|---|---|---|---|---|---|")
    clean = None
    for number in sorted({0, *chosen}):
        verdict, seconds = model_of(args, number)
        clean = clean or verdict
        worst = max(c["psnr_gain"] - v["psnr_gain"] for c, v in zip(clean["per_view"], verdict["per_view"]))
        print(f"| {FAULTS[number][0]} | {verdict['psnr_gain']:.2f} dB | {verdict['ssim_gain']:.4f} | {verdict['lap_ratio']:.3f} | "
              f"{clean['psnr_gain'] - verdict['psnr_gain']:.2f} dB | {worst:.2f} dB | {seconds:.1f} s |", flush=True)


if __name__ == "__main__":
    main()
