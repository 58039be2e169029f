#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Plans of generated floors against the truth: plans.py BIN_DIR WORK_DIR [--seeds N] [--scene NAME] [--storeys N].

Makes each floor with BIN_DIR/fresco_scan unless it is there, draws plans of its exact mesh and of its scans, merged by their
true poses, and prints a line for each: rooms found, largest and mean error of their areas, share of the drawn walls within
1 cm of true ones and of the true ones within 1 cm of drawn ones. The truth are the ceilings of truth.ply: their connected
parts are the rooms, their borders the walls. Of scans only rooms count whose ceiling has points in 98 % of squares of 20 cm:
behind a closed door there may be no station. --model DIR judges DIR/mesh.ply of fresco_model in the frame of the truth.
"""
import argparse
import json
import os
import subprocess

import numpy as np

TYPES = {"float": "f4", "double": "f8", "uchar": "u1", "int": "i4", "uint": "u4"}


def read_mesh(path):
    data = open(path, "rb").read()
    end = data.index(b"end_header\n") + 11
    counts, fields = {}, []
    for line in data[:end].decode().split("\n"):
        words = line.split()
        if words[:1] == ["element"]:
            counts[words[1]] = int(words[2])
        elif words[:1] == ["property"] and words[1] != "list":
            fields.append((words[2], "<" + TYPES[words[1]]))
    vertices = np.frombuffer(data, np.dtype(fields), counts["vertex"], end)
    at = end + vertices.nbytes
    faces = np.frombuffer(data, np.dtype([("n", "u1"), ("v", "<i4", 3)]), counts["face"], at)
    return np.stack([vertices[k] for k in "xyz"], 1).astype(float), faces["v"]


def read_scan(path):
    data = open(path, "rb").read()
    end = data.index(b"DATA binary\n") + 12
    header = dict(line.split(" ", 1) for line in data[:end].decode().split("\n") if " " in line)
    kinds = {"F": "f", "U": "u", "I": "i"}
    fields = [(n, "<" + kinds[t] + s) for n, t, s in zip(header["FIELDS"].split(), header["TYPE"].split(), header["SIZE"].split())]
    points = np.frombuffer(data, np.dtype(fields), int(header["POINTS"]), end)
    return np.stack([points[k] for k in "xyz"], 1).astype(float)


def scanned_rooms(rooms, cloud, height):
    data = open(cloud, "rb").read()
    points = np.frombuffer(data, "<f4", offset=data.index(b"end_header\n") + 11).reshape(-1, 3)
    points = points[abs(points[:, 2] - height) < 0.03]
    cells = {tuple(c) for c in np.unique(np.floor(points[:, :2] / 0.2).astype(int), axis=0)}
    seen = []
    for lines in rooms:
        low, high = np.floor(lines[0].min(0) / 0.2), np.ceil(lines[0].max(0) / 0.2)
        grid = np.stack(np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1])), -1).reshape(-1, 2)
        own = grid[inside(lines, 0.2 * (grid + 0.5))]
        if np.mean([tuple(c) in cells for c in own.astype(int)]) >= 0.98:
            seen.append(lines)
    return seen


def merge_scans(folder, out):
    poses = [np.array(line.split(), float).reshape(4, 4) for line in open(folder + "/poses.txt") if line.strip()]
    parts = [read_scan(f"{folder}/scans/scan_{k:02d}.pcd") @ T[:3, :3].T + T[:3, 3] for k, T in enumerate(poses)]
    points = np.concatenate(parts).astype("<f4")
    points = points[np.isfinite(points).all(1)]
    with open(out, "wb") as file:
        file.write(b"ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
                   b"property float z\nend_header\n" % len(points))
        file.write(points.tobytes())


def loops_of(edges):
    """Closed lines of directed edges (a, b)."""
    following, loops = {}, []
    for a, b in edges:
        following.setdefault(a, []).append(b)
    while following:
        start = at = next(iter(following))
        loop = []
        while at in following:
            loop.append(at)
            after = following[at].pop()
            if not following[at]:
                del following[at]
            at = after
            if at == start:
                break
        loops.append(loop)
    return loops


def area_of(line):
    x, y = np.asarray(line).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def true_rooms(vertices, faces, low, high):
    """Lists of closed lines: the outline and holes larger than 1 square metre, of which the ceiling has none but patios."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    level = -normal[:, 2] > 0.999 * np.linalg.norm(normal, axis=1)
    z = a[:, 2]
    ceiling = level & (z > low) & (z < high)
    main = np.bincount(np.round(z[ceiling] * 1000).astype(int), -normal[ceiling, 2]).argmax() / 1000
    ceiling &= abs(z - main) < 0.001
    names = {}
    weld = np.array([names.setdefault(tuple(np.round(p * 1e4).astype(int)), len(names)) for p in vertices[:, :2]])
    place = {weld[i]: vertices[i, :2] for f in faces[ceiling] for i in f}
    triangles = weld[faces[ceiling]]
    parent = list(range(len(names)))

    def root(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i
    for t in triangles:
        for k in (1, 2):
            parent[root(t[0])] = root(t[k])
    rooms = []  # and the height of their ceilings
    for r in sorted({root(t[0]) for t in triangles}):
        own = [t for t in triangles if root(t[0]) == r]
        edges = {(t[(k + 1) % 3], t[k]) for t in own for k in range(3)}  # seen from above they run the other way
        loops = [np.array([place[i] for i in loop]) for loop in loops_of([e for e in edges if e[::-1] not in edges])]
        loops = [line for line in loops if abs(area_of(line)) > 1]
        if loops:
            rooms.append(sorted(loops, key=lambda line: -abs(area_of(line))))
    return rooms, main


def inside(lines, points):
    found = np.zeros(len(points), bool)
    for line in lines:
        for p, q in zip(line, np.roll(line, -1, 0)):
            cross = (p[1] > points[:, 1]) != (q[1] > points[:, 1])
            if q[1] != p[1]:
                found ^= cross & (points[:, 0] < p[0] + (points[:, 1] - p[1]) / (q[1] - p[1]) * (q[0] - p[0]))
    return found


def segments(lines):
    return np.concatenate([np.stack([line, np.roll(line, -1, 0)], 1) for line in lines])


def spread(parts, step=0.01):
    return np.concatenate([p + (np.arange(n := max(1, round(np.linalg.norm(q - p) / step))) + 0.5)[:, None] / n * (q - p)
                           for p, q in parts])


def distances(points, parts):
    best = np.full(len(points), np.inf)
    for p, q in parts:
        d = q - p
        t = np.clip((points - p) @ d / max(d @ d, 1e-12), 0, 1)
        best = np.minimum(best, np.linalg.norm(points - p - t[:, None] * d, axis=1))
    return best


def drawn_walls(room):
    parts = []
    for wall in room["walls"]:
        if not wall["seen"]:
            continue
        at = wall["from"]
        for opening in wall["openings"]:
            parts.append((at, opening["from"]))
            at = opening["to"]
        parts.append((at, wall["to"]))
    return np.array([part for part in parts if np.linalg.norm(np.subtract(*part)) > 1e-6])


def judge(plan, truth):
    """rooms, found, invented, errors of areas, share of drawn walls, share of true walls within 1 cm"""
    drawn = [[np.array(room["outline"])[:-1]] + [np.array(c)[:-1] for c in room["columns"]] for room in plan["rooms"]]
    errors, used = [], set()
    for lines in truth:
        low, high = lines[0].min(0), lines[0].max(0)
        grid = np.stack(np.meshgrid(np.arange(low[0], high[0], 0.05), np.arange(low[1], high[1], 0.05)), -1).reshape(-1, 2)
        cells = inside(lines, grid)
        for r, outline in enumerate(drawn):
            other = inside(outline, grid)
            area = sum(abs(area_of(line)) * (1 if k == 0 else -1) for k, line in enumerate(lines))
            overlap = (cells & other).sum() / max(1, (cells | other).sum())
            if r not in used and overlap > 0.9 and plan["rooms"][r]["area"] < 1.2 * area:
                used.add(r)
                errors.append(plan["rooms"][r]["area"] / area - 1)
                break
    true_parts = segments([line for lines in truth for line in lines])
    walls = np.concatenate([drawn_walls(plan["rooms"][r]) for r in used])
    outlines = segments([line for r in used for line in drawn[r]])
    return (len(truth), len(errors), len(drawn) - len(used), np.array(errors),
            np.mean(distances(spread(walls), true_parts) < 0.01), np.mean(distances(spread(true_parts), outlines) < 0.01))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("work")
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--scene", default="office", help="office, apartment or conference_room")
    parser.add_argument("--rooms", type=int, default=8)
    parser.add_argument("--storeys", type=int, default=1)
    parser.add_argument("--storey", type=int, default=1, help="that is drawn, from 1")
    parser.add_argument("--stations", type=int, default=12)
    parser.add_argument("--points", type=int, default=200000)
    parser.add_argument("--model", help="folder of fresco_model, in place of the scans")
    options = parser.parse_args()
    print("seed input rooms found invented area_max_% area_mean_% drawn_within_1cm_% true_within_1cm_%")
    for seed in range(1, options.seeds + 1):
        folder = f"{options.work}/{options.scene}_{options.rooms}_{options.storeys}_{seed}"
        if not os.path.exists(folder + "/poses.txt"):
            office = ["-rooms", options.rooms, "-storeys", options.storeys] if options.scene == "office" else []
            command = [options.bin + "/fresco_scan", options.scene, folder, "-seed", seed, "-no_images", "-quiet",
                       "-stations", options.stations, "-points", options.points] + office
            subprocess.run([str(word) for word in command], check=True)
        cloud = folder + "/cloud.ply"
        if not options.model and not os.path.exists(cloud):
            merge_scans(folder, cloud)
        base = 2.9 * (options.storey - 1)
        truth, ceiling = true_rooms(*read_mesh(folder + "/truth.ply"), base + 2, base + 3.2)
        for name, path in (("mesh", folder + "/truth.ply"),
                           ("model", options.model + "/mesh.ply") if options.model else ("scans", cloud)):
            out = f"{folder}/plan_{name}.svg"
            subprocess.run([options.bin + "/fresco_plan", path, out, "-quiet"] +
                           (["-height", str(base + 1.5)] if options.storey > 1 else []), check=True)
            known = scanned_rooms(truth, cloud, ceiling) if name == "scans" else truth
            rooms, found, invented, errors, drawn, true = judge(json.load(open(out[:-4] + ".json")), known)
            print(f"{seed} {name} {rooms} {found} {invented} {100 * abs(errors).max():.3f} {100 * abs(errors).mean():.3f} "
                  f"{100 * drawn:.2f} {100 * true:.2f}", flush=True)


if __name__ == "__main__":
    main()
