#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Registers generated office floors and compares with the truth: office_floors.py BIN_DIR WORK_DIR [options].

Makes each floor with BIN_DIR/fresco_scan unless it is there, registers it, without start poses unless -disturbed, and
prints a line: placed, false (more than 5 cm or 1 degree off), worst error of the others, groups, processor seconds; at the
end how errors compare with their deviations.
"""
import argparse
import json
import os
import re
import resource
import subprocess

import numpy as np

FALSE_DISTANCE, FALSE_DEGREES = 0.05, 1.0


def read_poses(path):
    lines = [line for line in open(path) if line.strip() and not line.startswith("#")]
    return [None if line.startswith("none") else np.array(line.split(), float).reshape(4, 4) for line in lines]


def degrees(R):
    return np.degrees(np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1)))


def fit(found, truth):
    """Rigid motion that brings the truth onto what was found: of stations and of points 1 m away from them."""
    local = np.array([[0, 0, 0, 1], [1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1]], float).T
    a = np.hstack([T @ local for T in truth])[:3]
    b = np.hstack([T @ local for T in found])[:3]
    U, _, Vt = np.linalg.svd((b - b.mean(1, keepdims=True)) @ (a - a.mean(1, keepdims=True)).T)
    R = U @ np.diag([1, 1, np.linalg.det(U @ Vt)]) @ Vt
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, b.mean(1) - R @ a.mean(1)
    return T


def errors(found, truth, distance=FALSE_DISTANCE, angle=FALSE_DEGREES):
    """Translation (m) and rotation (degrees) of each scan after the fit to the largest set that agrees."""
    def off(T):
        differences = [np.linalg.inv(T @ t) @ f for f, t in zip(found, truth)]
        return (np.array([np.linalg.norm(D[:3, 3]) for D in differences]),
                np.array([degrees(D[:3, :3]) for D in differences]))
    best = None
    for f, t in zip(found, truth):
        shift, turn = off(f @ np.linalg.inv(t))
        good = (shift < distance) & (turn < angle)
        if best is None or good.sum() > best.sum():
            best = good
    keep = [k for k in range(len(found)) if best[k]]
    return off(fit([found[k] for k in keep], [truth[k] for k in keep]))


def degrees_about(axis, angle):
    """Rotation about a unit vector by degrees (Rodrigues)."""
    K = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(np.radians(angle)) * K + (1 - np.cos(np.radians(angle))) * K @ K


def write_disturbed(path, truth, seed, off):
    """Start poses off the truth by so many metres, and 5 degrees for each: what comes of them without the search."""
    random = np.random.default_rng(seed)
    with open(path, "w") as file:
        for T in truth:
            shift, axis = (v / np.linalg.norm(v) for v in random.normal(size=(2, 3)))
            D = np.eye(4)
            D[:3, :3], D[:3, 3] = degrees_about(axis, 5 * off), off * shift
            file.write(" ".join(repr(float(x)) for x in (T @ D).ravel()) + "\n")


def deviation_ratios(report, found, truth):
    """Errors over their deviations, relative to the first scan, which holds the frame; translations and rotations."""
    frame = found[0][1] @ np.linalg.inv(truth[found[0][0]])
    ratios = []
    for k, T in found[1:]:
        D, scan = np.linalg.inv(frame @ truth[k]) @ T, report["scans"][k]
        ratios += [np.linalg.norm(D[:3, 3]) / max(scan["translation_deviation"], 1e-9),
                   degrees(D[:3, :3]) / max(scan["rotation_deviation_deg"], 1e-9)]
    return ratios


def processor_seconds(command, env=None):
    """Runs a command; user and system time of it and its children."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, env=env)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def run(args, seed):
    rooms, stations = args.rooms or 6 + seed % 5, args.stations or 8 + 2 * (3 * seed % 5)
    folder = f"{args.work}/floor_{seed}_{rooms}_{stations}_{args.points}" + re.sub(r"\W+", "_", args.scan)
    if not os.path.exists(folder + "/poses.txt"):
        subprocess.run([args.bin + "/fresco_scan", "office", folder, "-quiet", "-no_images", "-edge", "0.4", "-seed",
                        str(seed), "-rooms", str(rooms), "-stations", str(stations), "-points",
                        str(args.points)] + args.scan.split(), check=True)
    command = [args.bin + "/fresco_register", folder + "/scans", "-o", folder + "/registered", "-quiet"]
    if args.disturbed is not None:
        write_disturbed(folder + "/start.txt", read_poses(folder + "/poses.txt"), seed, args.disturbed)
        command += ["-poses", folder + "/start.txt"]
    seconds = processor_seconds(command + args.register.split())
    report = json.load(open(folder + "/registered/registration.json"))
    truth, found = read_poses(folder + "/poses.txt"), read_poses(folder + "/registered/poses.txt")
    placed = [k for k in range(len(found)) if found[k] is not None]
    shift, turn = errors([found[k] for k in placed], [truth[k] for k in placed])
    wrong = (shift > FALSE_DISTANCE) | (turn > FALSE_DEGREES)
    right = ~wrong
    ratios = deviation_ratios(report, [(k, found[k]) for k in placed], truth)
    worst = 1000 * shift[right].max() if right.any() else 0
    sizes = np.bincount([s["group"] for s in report["scans"] if s["group"] >= 0])
    print(f"| {seed} | {len(found)} | {len(placed)} | {wrong.sum()} | {worst:.2f} | {turn[right].max():.3f} | "
          f"{', '.join(str(n) for n in sorted(sizes, reverse=True) if n > 1)} | {seconds:.1f} |", flush=True)
    return len(found), len(placed), int(wrong.sum()), ratios


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bin")
    parser.add_argument("work")
    parser.add_argument("-seeds", default="1-6", help="FIRST-LAST")
    parser.add_argument("-rooms", type=int, default=0, help="0 = 6 to 10")
    parser.add_argument("-stations", type=int, default=0, help="0 = 8 to 16")
    parser.add_argument("-points", type=int, default=20000)
    parser.add_argument("-scan", default="", help='further options of fresco_scan: -scan="-storeys 2" or -scan=-turned')
    parser.add_argument("-disturbed", type=float, help="start so many metres off the true poses, and 5 degrees for each")
    parser.add_argument("-register", default="", help="options of fresco_register")
    args = parser.parse_args()
    first, last = map(int, re.fullmatch(r"(\d+)-(\d+)", args.seeds).groups())
    print("| seed | stations | placed | false | worst, mm | worst, degrees | groups | CPU s |\n|---|---|---|---|---|---|---|---|")
    results = [run(args, seed) for seed in range(first, last + 1)]
    print("stations {}, placed {}, false {}".format(*(sum(r[k] for r in results) for k in range(3))))
    ratios = np.concatenate([r[3] for r in results])
    counts, edges = np.histogram(ratios, [0, 0.5, 1, 1.5, 2, 3, 5, 10, np.inf])
    print("error / deviation:", ", ".join(f"{a:g}-{b:g}: {n}" for a, b, n in zip(edges, edges[1:], counts)))


if __name__ == "__main__":
    main()
