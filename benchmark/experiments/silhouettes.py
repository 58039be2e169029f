#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How far the silhouettes of a mesh lie from those in the photographs: silhouettes.py SCAN_DIR MESH.ply [--every N].

SCAN_DIR is what `fresco_scan conference_room` leaves: its truth.ply is what the photographs show, so that its depth edges are
theirs. Both meshes are rendered by rays through the pixels' centres; a depth edge is where the depth jumps by more than 3 cm off
both surfaces beside it. Of the true edges ("found") and those of the mesh ("true") the share is told that has one of the other
within 1 and 2 pixels, and the median of the distances; by object by which thing of the truth stands before. Needs numpy, scipy,
and the module fresco.
"""
import argparse
import os

import fresco
import numpy as np
from scipy.ndimage import distance_transform_edt
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

JUMP = 0.03  # metres
OBJECTS = ["other", "table", "chairs", "laptops"]
PARTS = {2192: 1, 482: 2, 72: 2, 82: 2, 152: 2, 40: 3, 24: 3}  # object by number of places of a part of the virtual room
AROUND_TABLE = np.array([[-3.0, -1.7, -0.1], [3.0, 1.7, 1.1]])


def object_of_face(truth):
    """number in OBJECTS, by connected parts"""
    places, number = np.unique(np.round(truth.vertices, 5), axis=0, return_inverse=True)
    faces = number.reshape(-1)[truth.faces]
    links = coo_matrix((np.ones(faces.size), (faces.ravel(), np.roll(faces, 1, 1).ravel())), shape=(len(places),) * 2)
    count, part = connected_components(links, directed=False)
    out = np.zeros(count, int)
    for k, size in enumerate(np.bincount(part)):
        if size in PARTS:
            at = places[part == k]
            out[k] = PARTS[size] if (at > AROUND_TABLE[0]).all() and (at < AROUND_TABLE[1]).all() else 0
    return out[part[faces[:, 0]]]


def shown(mesh, view):
    """1 / depth along the axis (0 = nothing), and the faces"""
    c, T = view.camera, np.asarray(view.T_camera_world).reshape(4, 4)
    x, y = np.meshgrid((np.arange(c.width) + 0.5 - c.cx) / c.fx, (np.arange(c.height) + 0.5 - c.cy) / c.fy)
    rays = np.stack([x, y, np.ones_like(x)], -1).reshape(-1, 3)
    hits = fresco.cast_rays(mesh, np.broadcast_to(-T[:3, :3].T @ T[:3, 3], rays.shape), rays @ T[:3, :3])
    depth = (hits.points @ T[2, :3] + T[2, 3]).reshape(x.shape)
    faces = np.asarray(hits.faces).reshape(x.shape)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(faces >= 0, 1 / depth, 0), faces


def edges(inverse):
    """Pixels before a jump. The inverse depth of a plane changes evenly from pixel to pixel."""
    out = np.zeros(inverse.shape, bool)
    for w, mark in ((inverse, out), (inverse.T, out.T)):
        a, b, c, d = w[:, :-3], w[:, 1:-2], w[:, 2:-1], w[:, 3:]
        jump = np.minimum(np.minimum(np.abs(2 * b - a - c), np.abs(2 * c - d - b)), np.abs(b - c))
        is_edge = jump > JUMP * np.maximum(b, c) * np.minimum(b, c)  # a change of depth by 3 cm
        mark[:, 1:-2] |= is_edge & (b > c)
        mark[:, 2:-1] |= is_edge & (c > b)
    return out


def line(name, found, true):
    def shares(d):
        return [f"{100 * np.mean(d <= limit):.0f} %" for limit in (1, 2)] + [f"{np.median(d):.1f}"] if d.size else ["-"] * 3
    print("| " + " | ".join([name, str(len(found)), *shares(found), str(len(true)), *shares(true)]) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scan")
    parser.add_argument("mesh")
    parser.add_argument("--every", type=int, default=1, help="of the photographs only each so manieth")
    args = parser.parse_args()
    truth, mesh = fresco.read_mesh(os.path.join(args.scan, "truth.ply")), fresco.read_mesh(args.mesh)
    objects = object_of_face(truth)
    print("| photograph | true edges, pixels | found within 1 | within 2 | median | the mesh's | true within 1 | within 2 | median |")
    print("|" + "---|" * 9)
    all_found, all_true, labels = [], [], []
    for view in fresco.read_views(os.path.join(args.scan, "cameras"), os.path.join(args.scan, "images"))[::args.every]:
        inverse, faces = shown(truth, view)
        wanted, made = edges(inverse), edges(shown(mesh, view)[0])
        found, true = distance_transform_edt(~made)[wanted], distance_transform_edt(~wanted)[made]
        line(os.path.basename(view.image or view.path), found, true)
        all_found.append(found)
        all_true.append(true)
        labels.append(objects[faces[wanted]])
    label, found = np.concatenate(labels), np.concatenate(all_found)
    for k, name in enumerate(OBJECTS):
        line(name, found[label == k], np.empty(0))
    line("all", found, np.concatenate(all_true))


if __name__ == "__main__":
    main()
