#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A room of boxes with print and grids of millimetres on pale walls, and photographs of it of which 2 to 4 show a place:
what the coarser patterns of fresco_scan forgive shows here. write_room() leaves what fresco_scan leaves: cameras/, images/,
truth_images/, truth.ply."""
import os

import numpy as np
from PIL import Image, ImageDraw, ImageFont

PER_METRE = 500  # texels of the pictures on the surfaces
LOW, HIGH = np.array([0.0, 0, 0]), np.array([6.0, 5, 2.8])
BOXES = [([2.2, 1.9, 0], [3.8, 2.9, 0.75]), ([0, 3.6, 0], [0.5, 5, 1.9]), ([5.5, 0, 0], [6, 1.2, 0.9])]
EDGE = 0.045  # metres, of the mesh


class Surface:
    """A rectangle: `low` to `high`, flat along `axis`, seen from the side of `sign`, with its picture of light"""

    def __init__(self, low, high, axis, sign, seed):
        self.low, self.axis, self.sign = np.array(low, float), axis, sign
        self.u, self.v = [k for k in range(3) if k != axis]
        self.size = np.array(high, float) - self.low
        self.picture = self.albedo(np.random.default_rng(seed)) * self.light()[..., None]

    def albedo(self, random):
        w, h = (int(round(self.size[k] * PER_METRE)) for k in (self.u, self.v))
        floor = self.axis == 2 and self.sign > 0
        base = random.uniform(0.25, 0.5, 3) if floor else random.uniform(0.7, 0.8) + random.uniform(-0.03, 0.03, 3)
        out = np.ones((h, w, 3), np.float32) * base
        for step, contrast in ((1, 0.03), (3, 0.03), (12, 0.02), (300, 0.03)):
            coarse = random.normal(0, 1, (h // step + 2, w // step + 2)).astype(np.float32)
            grain = np.array(Image.fromarray(coarse).resize((w, h), Image.BILINEAR))
            out *= 1 + (2 if floor else 1) * contrast * grain[..., None]
        for _ in range(int(w * h / PER_METRE ** 2 / (1.2 if self.axis == 2 else 0.8))):
            self.print_sheet(out, random)
        return out.clip(0.02, 0.95)

    @staticmethod
    def print_sheet(out, random):
        """lines of letters 24 to 70 mm high, or a grid of lines 6 mm wide, on a sheet of paper"""
        size = random.integers(150, 450, 2)
        if (size + 2 >= out.shape[1::-1]).any():
            return
        x, y = (random.integers(0, out.shape[1 - k] - size[k]) for k in (0, 1))
        sheet = Image.new("RGB", tuple(int(s) for s in size), tuple(random.integers(140, 220, 3).tolist()))
        draw, ink = ImageDraw.Draw(sheet), tuple(random.integers(30, 120, 3).tolist())
        if random.random() < 0.6:
            letters = "".join(chr(c) for c in random.integers(65, 91, 60))
            line = Image.new("L", (400, 11))
            ImageDraw.Draw(line).text((0, 0), letters, 255, ImageFont.load_default())
            height, top = int(random.integers(12, 36)), 6
            while top + height < size[1]:
                text = line.resize((int(36.4 * height), height), Image.BILINEAR)
                sheet.paste(ink, (8 - int(random.integers(0, 40)), top), text)
                top += int(1.4 * height)
        else:
            step = random.uniform(10, 30)
            for k in range(int(size.max() / step)):
                draw.line([(k * step, 0), (k * step, int(size[1]))], ink, 3)
                draw.line([(0, k * step), (int(size[0]), k * step)], ink, 3)
        out[y:y + size[1], x:x + size[0]] = np.asarray(sheet, np.float32) / 255

    def light(self):
        """of two lamps below the ceiling, without shadows, fractions of white"""
        h, w = (int(round(self.size[k] * PER_METRE)) for k in (self.v, self.u))
        at = np.zeros((h, w, 3), np.float32) + self.low
        at[..., self.u] += (np.arange(w) + 0.5) / PER_METRE
        at[..., self.v] += ((np.arange(h) + 0.5) / PER_METRE)[:, None]
        total = np.full((h, w), 0.65, np.float32)
        for lamp in ([1.8, 2.5, 2.6], [4.2, 2.5, 2.6]):
            to = np.array(lamp) - at
            total += 1.3 * np.maximum(0, self.sign * to[..., self.axis]) / (np.square(to).sum(-1) + 0.6) ** 1.2
        return np.minimum(total, 1.2)

    def sample(self, points):
        x = ((points[:, self.u] - self.low[self.u]) * PER_METRE - 0.5).clip(0, self.picture.shape[1] - 1.001)
        y = ((points[:, self.v] - self.low[self.v]) * PER_METRE - 0.5).clip(0, self.picture.shape[0] - 1.001)
        i, j = x.astype(int), y.astype(int)
        a, b = (x - i)[:, None], (y - j)[:, None]
        p = self.picture
        return (1 - b) * ((1 - a) * p[j, i] + a * p[j, i + 1]) + b * ((1 - a) * p[j + 1, i] + a * p[j + 1, i + 1])

    def mesh(self):
        n, m = (max(1, int(round(self.size[k] / EDGE))) for k in (self.u, self.v))
        i, j = np.meshgrid(np.arange(n + 1), np.arange(m + 1), indexing="ij")
        vertices = np.zeros((i.size, 3)) + self.low
        vertices[:, self.u] += i.ravel() * self.size[self.u] / n
        vertices[:, self.v] += j.ravel() * self.size[self.v] / m
        corner = (np.arange(n)[:, None] * (m + 1) + np.arange(m)).ravel()
        faces = np.concatenate([np.stack([corner, corner + m + 1, corner + m + 2], 1),
                                np.stack([corner, corner + m + 2, corner + 1], 1)])
        forward = np.cross(np.eye(3)[self.u], np.eye(3)[self.v])[self.axis] == self.sign
        return vertices, faces if forward else faces[:, ::-1]


def surfaces():
    out = []
    for low, high, inside in [(LOW, HIGH, 1)] + [(np.array(a), np.array(b), 0) for a, b in BOXES]:
        for axis in range(3):
            for top in (0, 1):
                if inside or axis < 2 or top:
                    a, b = np.array(low, float), np.array(high, float)
                    a[axis] = b[axis] = (low, high)[top][axis]
                    outer = np.abs(a[axis] - (LOW[axis], HIGH[axis])[top]) < 1e-6
                    if inside or not outer:
                        out.append(Surface(a, b, axis, (1 if top else -1) * (-1 if inside else 1), len(out)))
    return out


def look_along(yaw, pitch):
    """rows: right, down, forward"""
    forward = np.array([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)])
    right = np.array([np.sin(yaw), -np.cos(yaw), 0])
    return np.stack([right, np.cross(forward, right), forward])


def poses(count, random):
    """(rotation, centre): from the room's sides across it, ever another direction, by turns level, down and up"""
    out = []
    for k in range(count):
        yaw = 2 * np.pi * (k * 0.381966 % 1)
        pitch = np.radians((-8, -40, 14)[k % 3]) + random.normal(0, 0.05)
        back = np.array([np.cos(yaw) * 2.4, np.sin(yaw) * 1.8, 0]) * random.uniform(0.8, 1)
        out.append((look_along(yaw, pitch), np.array([3, 2.5, 1.55]) - back + random.normal(0, 0.1, 3)))
    return out


def light_of(scene, R, centre, width, height, focal):
    """float32 picture, mean of 2 x 2 rays a pixel"""
    total = np.zeros((width * height, 3), np.float32)
    x, y = np.meshgrid(np.arange(width) - width / 2, np.arange(height) - height / 2)
    for sub in range(4):
        d = np.stack([(x + (sub % 2 + 0.5) / 2) / focal, (y + (sub // 2 + 0.5) / 2) / focal, np.ones_like(x)], -1)
        d = d.reshape(-1, 3) @ R
        nearest, which = np.full(len(d), np.inf), np.full(len(d), -1)
        for k, s in enumerate(scene):
            with np.errstate(divide="ignore", invalid="ignore"):
                t = (s.low[s.axis] - centre[s.axis]) / d[:, s.axis]
                hit = (t > 0) & (t < nearest) & (s.sign * d[:, s.axis] < 0)
                for axis in (s.u, s.v):
                    p = centre[axis] + t * d[:, axis]
                    hit &= (p >= s.low[axis]) & (p <= s.low[axis] + s.size[axis])
            nearest[hit], which[hit] = t[hit], k
        for k, s in enumerate(scene):
            at = which == k
            total[at] += s.sample(centre + nearest[at, None] * d[at])
    return (total / 4).reshape(height, width, 3)


def write_mesh(scene, path):
    vertices, faces, first = [], [], 0
    for s in scene:
        v, f = s.mesh()
        vertices.append(v)
        faces.append(f + first)
        first += len(v)
    vertices, faces = np.concatenate(vertices), np.concatenate(faces)
    unique, number = np.unique(np.round(vertices, 6), axis=0, return_inverse=True)
    faces = number.reshape(-1)[faces]
    records = np.zeros(len(faces), [("n", "u1"), ("v", "<i4", 3)])
    records["n"], records["v"] = 3, faces
    with open(path, "wb") as out:
        out.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {len(unique)}\nproperty float x\nproperty float y\n"
                   f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n").encode())
        out.write(unique.astype("<f4").tobytes() + records.tobytes())


def quaternion(R):
    w, v = np.linalg.eigh(np.array([
        [R[0, 0] - R[1, 1] - R[2, 2], R[0, 1] + R[1, 0], R[0, 2] + R[2, 0], R[2, 1] - R[1, 2]],
        [R[0, 1] + R[1, 0], R[1, 1] - R[0, 0] - R[2, 2], R[1, 2] + R[2, 1], R[0, 2] - R[2, 0]],
        [R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], R[2, 2] - R[0, 0] - R[1, 1], R[1, 0] - R[0, 1]],
        [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], np.trace(R)]]))
    q = v[:, np.argmax(w)]
    return q[[3, 0, 1, 2]]


def turned(R, vector):
    angle = np.linalg.norm(vector)
    if angle == 0:
        return R
    x, y, z = vector / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return (np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K) @ R


def write_room(folder, views, width, height, seed=1, exposure=1.0, shift=0.0, turn=0.0):
    """@param exposure  factors of the photographs lie between 1 / this and this
    @param shift, turn  deviation of the written cameras, metres and degrees"""
    lights = os.path.join(os.path.dirname(folder), "lights")  # of all faults together
    for sub in ("cameras", "images", "truth_images"):
        os.makedirs(f"{folder}/{sub}", exist_ok=True)
    os.makedirs(lights, exist_ok=True)
    focal = 0.8 * width
    places = poses(views, np.random.default_rng(seed))
    random = np.random.default_rng(seed + 1000)
    scene = None
    lines = []
    for k, (R, centre) in enumerate(places):
        name = f"{lights}/{views}_{width}_{seed}_{k:03}.npy"
        if not os.path.exists(name):
            scene = scene or surfaces()
            np.save(name, light_of(scene, R, centre, width, height, focal).astype(np.float16))
        light = np.load(name).astype(np.float32)
        Image.fromarray((255 * light + 0.5).clip(0, 255).astype(np.uint8)).save(f"{folder}/truth_images/view_{k:03}.png",
                                                                              compress_level=1)
        factor = exposure ** random.uniform(-1, 1) * (1 + (0.1 * random.uniform(-1, 1, 3) if exposure > 1 else 0))
        noise = np.random.default_rng(k).normal(0, 1.5, light.shape)
        Image.fromarray((255 * light * factor + noise + 0.5).clip(0, 255).astype(np.uint8)).save(
            f"{folder}/images/view_{k:03}.jpg", quality=95, subsampling=0)
        moved = centre + random.normal(0, shift, 3) if shift else centre
        R = turned(R, np.radians(random.normal(0, turn, 3))) if turn else R
        t = -R @ moved
        lines.append(f"{k + 1} " + " ".join(f"{x:.12g}" for x in (*quaternion(R), *t)) + f" 1 view_{k:03}.jpg\n\n")
    open(f"{folder}/cameras/cameras.txt", "w").write(f"1 PINHOLE {width} {height} {focal} {focal} {width / 2} {height / 2}\n")
    open(f"{folder}/cameras/images.txt", "w").writelines(lines)
    open(f"{folder}/cameras/points3D.txt", "w").write("# none\n")
    write_mesh(scene or surfaces(), f"{folder}/truth.ply")
    open(f"{folder}/poses.txt", "w").close()
