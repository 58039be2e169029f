#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Scans of a floor of equal rooms: equal_rooms.py OUT_DIR [-rooms N] [-kinds K] [-stations N] [-points N] [-seed S].

Rooms lie on both sides of a corridor. Each has one of K furnishings, so with -kinds 1 all are equal; only the corridor's
things differ. One station a room, the others spread over rooms and corridor. Boxes and rays, nothing of fresco's scanner:
writes OUT_DIR/scans/scan_NN.pcd, each in a frame turned about the vertical, and OUT_DIR/poses.txt (world from scan)."""
import argparse
import os

import numpy as np

HEIGHT, WALL, DOOR, DOOR_HEIGHT, CORRIDOR = 2.7, 0.12, 0.9, 2.05, 2.2


def furnish(kind_seed, width, depth):
    """Boxes of one room in its own frame: x along the corridor's wall, y into the room."""
    random = np.random.default_rng(kind_seed)
    boxes = []
    for x in np.arange(0.9, width - 0.7, 1.7):
        y = depth - random.uniform(0.5, 0.8)
        boxes.append([x - 0.7, y - 0.35, 0.68, x + 0.7, y + 0.35, 0.74])        # top of a desk
        boxes.append([x - 0.65, y - 0.3, 0, x - 0.35, y + 0.3, 0.68])           # its drawers
        boxes.append([x - 0.2, y + 0.05, 0.74, x + 0.25, y + 0.12, 1.15])       # a screen
        cx, cy = x + random.uniform(-0.2, 0.2), y - random.uniform(0.6, 1.0)
        boxes.append([cx - 0.22, cy - 0.22, 0.42, cx + 0.22, cy + 0.22, 0.5])   # a chair
        boxes.append([cx - 0.22, cy - 0.26, 0.5, cx + 0.22, cy - 0.2, 0.95])
    side = random.uniform(1.2, depth - 1.8)
    boxes.append([0, side, 0, 0.4, side + random.uniform(0.8, 1.4), random.uniform(1.2, 2.1)])  # a cupboard
    side = random.uniform(1.0, depth - 1.6)
    boxes.append([width - 0.3, side, 0, width, side + 0.9, random.uniform(0.8, 2.2)])           # shelves
    return boxes


def row_wall(start, width, door, y0, y1):
    """A room's wall to the corridor, with its door."""
    return [[start, y0, 0, start + door, y1, HEIGHT], [start + door + DOOR, y0, 0, start + width, y1, HEIGHT],
            [start + door, y0, DOOR_HEIGHT, start + door + DOOR, y1, HEIGHT]]


def make_floor(args, random):
    """Boxes, and places where a station may stand: of each room two, then of the corridor."""
    kinds = [(random.uniform(3.4, 5.2), random.uniform(4.0, 5.2), random.integers(1 << 30)) for _ in range(args.kinds)]
    doors = [random.uniform(0.4, width - DOOR - 0.4) for width, _, _ in kinds]
    boxes, rooms, length = [], [], 0.0
    for side in (1, -1):
        x = 0.0 if side == 1 else random.uniform(0.3, 1.5)
        for k in range((args.rooms + (side == 1)) // 2):
            kind = int(random.integers(args.kinds))
            width, depth, seed = kinds[kind]
            place = lambda b: b if side == 1 else [2 * x + width - b[3], -b[4] - CORRIDOR, b[2],
                                                   2 * x + width - b[0], -b[1] - CORRIDOR, b[5]]
            own = [[x + b[0], b[1], b[2], x + b[3], b[4], b[5]] for b in furnish(seed, width, depth)]
            own += row_wall(x, width, doors[kind], -WALL, 0)
            own += [[x - WALL, -WALL, 0, x, depth + WALL, HEIGHT], [x + width, -WALL, 0, x + width + WALL, depth + WALL, HEIGHT],
                    [x - WALL, depth, 0, x + width + WALL, depth + WALL, HEIGHT]]
            boxes += [place(b) for b in own]
            centre = lambda fx, fy: (x + (fx if side == 1 else 1 - fx) * width,
                                     fy * depth if side == 1 else -CORRIDOR - fy * depth)
            rooms.append([centre(random.uniform(0.3, 0.7), random.uniform(0.3, 0.55)),
                          centre(random.uniform(0.3, 0.7), random.uniform(0.12, 0.5))])
            x += width + WALL
        length = max(length, x)
    low, high = -1.0, length + 1.0
    boxes += [[low, -CORRIDOR - 9, -0.2, high, 9, 0], [low, -CORRIDOR - 9, HEIGHT, high, 9, HEIGHT + 0.2],
              [low - WALL, -CORRIDOR, 0, low, 0, HEIGHT], [high, -CORRIDOR, 0, high + WALL, 0, HEIGHT]]
    corridor = [(cx, -CORRIDOR / 2 + random.uniform(-0.3, 0.3)) for cx in np.arange(1.5, length, 4.5)]
    for cx in np.arange(0.5, length, 3.0):
        if random.uniform() < 0.5:
            y = 0 - WALL - 0.35 if random.uniform() < 0.5 else -CORRIDOR + WALL
            x = cx + random.uniform(-0.8, 0.8)
            boxes.append([x, y, 0, x + random.uniform(0.3, 1.0), y + 0.35, random.uniform(0.4, 2.0)])
    first = [room[0] for room in rooms]
    rest = [room[1] for room in rooms] + corridor
    random.shuffle(rest)
    return np.array(boxes), (corridor[:: 2] + first + [p for p in rest if p not in corridor[:: 2]])[: args.stations]


def ranges_along(boxes, origin, directions):
    """Distance to the first box along each ray (slabs), infinity without any."""
    nearest = np.full(len(directions), np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        for box in boxes:
            a, b = (box[:3] - origin) / directions, (box[3:] - origin) / directions
            enter, leave = np.minimum(a, b).max(1), np.maximum(a, b).min(1)
            hit = (enter < leave) & (enter > 0)
            nearest[hit] = np.minimum(nearest[hit], enter[hit])
    return nearest


def scan(boxes, place, args, random):
    """Points of one station in the frame of its scanner, and its pose."""
    z = random.uniform(-0.95, 1, args.points)
    turn = random.uniform(0, 2 * np.pi, args.points)
    r = np.sqrt(1 - z * z)
    directions = np.stack([r * np.cos(turn), r * np.sin(turn), z], 1)
    pose = np.eye(4)
    yaw = random.uniform(0, 2 * np.pi)
    pose[:2, :2] = [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]
    pose[:3, 3] = [place[0], place[1], random.uniform(1.45, 1.65)]
    ranges = ranges_along(boxes, pose[:3, 3], directions)
    ranges += random.normal(0, args.noise, len(ranges))
    keep = np.isfinite(ranges) & (ranges < 30)
    return (directions[keep] * ranges[keep, None]) @ pose[:3, :3], pose


def write_pcd(path, points):
    header = ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {0}\nHEIGHT 1\n"
              "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n").format(len(points))
    with open(path, "wb") as file:
        file.write(header.encode() + points.astype("<f4").tobytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out")
    parser.add_argument("-rooms", type=int, default=8)
    parser.add_argument("-kinds", type=int, default=1)
    parser.add_argument("-stations", type=int, default=16)
    parser.add_argument("-points", type=int, default=20000)
    parser.add_argument("-noise", type=float, default=0.002)
    parser.add_argument("-seed", type=int, default=1)
    args = parser.parse_args()
    random = np.random.default_rng(args.seed)
    boxes, places = make_floor(args, random)
    os.makedirs(args.out + "/scans", exist_ok=True)
    poses = []
    for k, place in enumerate(places):
        points, pose = scan(boxes, place, args, random)
        write_pcd(f"{args.out}/scans/scan_{k:02d}.pcd", points)
        poses.append(" ".join(repr(float(v)) for v in pose.ravel()))
    with open(args.out + "/poses.txt", "w") as file:
        file.write("\n".join(poses) + "\n")


if __name__ == "__main__":
    main()
