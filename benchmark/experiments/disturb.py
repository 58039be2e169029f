#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What generated floors lack: disturb.py FLOOR [-people N] [-panes N] [-view DEGREES] [-seed S], in place.

FLOOR: poses.txt and scans/*.pcd (binary, x y z first, scanner at the origin), walls along x and y. In each scan other N people stand
1.2 to 5 m away; what is behind them is lost. Panes are 1.6 m squares of walls, the same for all scans: of their points half are
lost, and one beam in twenty shows the mirror image of what the scan itself has. -view leaves so much of the full turn."""
import argparse
import glob

import numpy as np

RADIUS, TALL = 0.25, 1.75  # of a person, a vertical cylinder
HALF, SKIN, MIRRORED = 0.8, 0.03, 1 / 20  # of a pane: half an edge, and how near a point is one of it; share of beams


def read_pcd(path):
    data = open(path, "rb").read()
    at = data.index(b"DATA binary\n") + len("DATA binary\n")
    count = int(data.split(b"\nPOINTS ")[1].split()[0])
    return data[:at], np.frombuffer(data[at:], "<f4").reshape(count, -1).copy()


def write_pcd(path, header, rows):
    old = header.split(b"\nPOINTS ")[1].split()[0]
    for name in (b"POINTS", b"WIDTH"):
        header = header.replace(b"\n" + name + b" " + old, b"\n" + name + b" %d" % len(rows))
    with open(path, "wb") as file:
        file.write(header + rows.tobytes())


def put_people(points, origin, count, random):
    """Moves what a person hides onto the person; all in the world's frame."""
    flat = np.linalg.norm(points[:, :2] - origin[:2], axis=1)
    floor = points[(points[:, 2] - points[:, 2].min() < 0.1) & (flat > 1.2) & (flat < 5)]
    for foot in random.permutation(floor)[:count]:
        to, ray = foot[:2] - origin[:2], points - origin
        a = (ray[:, :2] ** 2).sum(1)
        b = ray[:, :2] @ to
        inside = b ** 2 - a * (to @ to - RADIUS ** 2)
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (b - np.sqrt(inside)) / a
        z = origin[2] + t * ray[:, 2] - foot[2]
        hit = (inside > 0) & (t > 0) & (t < 1) & (z > 0) & (z < TALL)
        points[hit] = origin + t[hit, None] * ray[hit]


def choose_panes(clouds, count, random):
    """Point and axis of each: where a wall is, at breast height."""
    panes = []
    while len(panes) < count:
        points = clouds[random.integers(len(clouds))]
        centre = points[random.integers(len(points))]
        near = points[np.linalg.norm(points - centre, axis=1) < 0.4]
        spread = near[:, :2].std(0)
        if abs(centre[2] - points[:, 2].min() - 1.3) < 0.4 and len(near) > 20 and spread.min() < 0.02 < 0.1 < spread.max():
            panes.append((centre, int(spread.argmin())))
    return panes


def put_panes(rows, points, origin, panes, random):
    """@return rows and points, those of panes half lost, with mirror images."""
    for centre, axis in panes:
        other = [1 - axis, 2]
        on = (np.abs(points[:, axis] - centre[axis]) < SKIN) & (np.abs(points[:, other] - centre[other]) < HALF).all(1)
        if not on.any():
            continue
        mirrored = points.copy()
        mirrored[:, axis] = 2 * centre[axis] - points[:, axis]
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (centre[axis] - origin[axis]) / (mirrored[:, axis] - origin[axis])
        at = origin + t[:, None] * (mirrored - origin)
        before = (points[:, axis] - centre[axis]) * (origin[axis] - centre[axis]) > SKIN
        seen = before & (np.abs(at[:, other] - centre[other]) < HALF).all(1) & (random.uniform(size=len(points)) < MIRRORED)
        keep = ~on | (random.uniform(size=len(points)) < 0.5)
        rows, points = np.vstack([rows[keep], rows[seen]]), np.vstack([points[keep], mirrored[seen]])
    return rows, points


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("floor")
    parser.add_argument("-people", type=int, default=0)
    parser.add_argument("-panes", type=int, default=0)
    parser.add_argument("-view", type=float, default=360)
    parser.add_argument("-seed", type=int, default=1)
    args = parser.parse_args()
    random = np.random.default_rng(args.seed)
    truth, files = np.loadtxt(args.floor + "/poses.txt").reshape(-1, 4, 4), sorted(glob.glob(args.floor + "/scans/*.pcd"))
    scans = [read_pcd(file) for file in files]
    clouds = [rows[:, :3].astype(float) @ T[:3, :3].T + T[:3, 3] for (_, rows), T in zip(scans, truth)]
    panes = choose_panes(clouds, args.panes, random)
    for file, (header, rows), points, T in zip(files, scans, clouds, truth):
        put_people(points, T[:3, 3], args.people, random)
        rows, points = put_panes(rows, points, T[:3, 3], panes, random)
        rows[:, :3] = (points - T[:3, 3]) @ T[:3, :3]
        turn = np.degrees(np.arctan2(points[:, 1] - T[1, 3], points[:, 0] - T[0, 3])) - random.uniform(0, 360)
        write_pcd(file, header, rows[turn % 360 <= args.view])


if __name__ == "__main__":
    main()
