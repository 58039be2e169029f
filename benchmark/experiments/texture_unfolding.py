#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How much less charts could show at their borders if neighbours were laid out together.

usage: texture_unfolding.py MODEL.obj

Colours to both sides of the edges between charts, one texel away, and inside of charts; then the same if neighbouring
charts were joined along straight borders wherever a rigid motion lays one beside the other, borders of the largest
difference first, as long as no circle closes. Overlaps are forgiven, so no layout of these charts by rigid motions can
do better. One atlas; needs numpy, scipy and OpenCV."""
import sys
from collections import defaultdict

import cv2
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

SAME = 1e-6      # texture coordinates that are one
STRAIGHT = 1.5   # texels by which the borders of two charts may miss each other
SCALE = 2.0      # of two charts, at most: the coarser one would be drawn finer


def read_model(path):
    """-> vertices (V,3), faces (F,3), texture coordinates of the corners in texels, y down (F,3,2), image (H,W,3)"""
    vertices, texcoords, faces, corners = [], [], [], []
    for line in open(path):
        word, *rest = line.split() or [""]
        if word == "v":
            vertices.append([float(x) for x in rest[:3]])
        elif word == "vt":
            texcoords.append([float(x) for x in rest[:2]])
        elif word == "f":
            pairs = [corner.split("/") for corner in rest]
            faces.append([int(p[0]) - 1 for p in pairs])
            corners.append([int(p[1]) - 1 for p in pairs])
    image = cv2.imread(path.rsplit(".", 1)[0] + ".png")
    if image is None:
        sys.exit(f"{path}: one atlas beside it is needed, NAME.png")
    height, width = image.shape[:2]
    places = np.array(texcoords)[np.array(corners)]
    places = np.stack([places[..., 0] * width, (1 - places[..., 1]) * height], -1)
    return np.array(vertices), np.array(faces), places, image.astype(np.float32)


def color_at(image, places):
    """bilinear, (N,2) -> (N,3)"""
    x, y = (np.clip(places[:, k] - 0.5, 0, image.shape[1 - k] - 1.001) for k in (0, 1))
    i, j = x.astype(int), y.astype(int)
    a, b = (x - i)[:, None], (y - j)[:, None]
    above = image[j, i] * (1 - a) + image[j, i + 1] * a
    return above * (1 - b) + (image[j + 1, i] * (1 - a) + image[j + 1, i + 1] * a) * b


class Edges:
    """Edges between two faces: length, ends in the texels of both, the difference of colour across."""

    def __init__(self, vertices, faces, places, image):
        corner = np.tile(np.arange(3), len(faces))
        face = np.repeat(np.arange(len(faces)), 3)
        start, end = faces[face, corner], faces[face, (corner + 1) % 3]
        key = np.minimum(start, end) * len(vertices) + np.maximum(start, end)
        order = np.argsort(key, kind="stable")
        _, first, count = np.unique(key[order], return_index=True, return_counts=True)
        one, other = order[first[count == 2]], order[first[count == 2] + 1]
        opposite = start[one] == end[other]  # consistent faces
        one, other = one[opposite], other[opposite]
        self.faces = face[one], face[other]
        self.ends = [places[face[one], corner[one]], places[face[one], (corner[one] + 1) % 3],
                     places[face[other], (corner[other] + 1) % 3], places[face[other], corner[other]]]
        self.length = np.linalg.norm(vertices[end[one]] - vertices[start[one]], axis=1)
        self.joined = sum(np.abs(self.ends[k] - self.ends[k + 2]).max(1) > SAME * len(image) for k in (0, 1)) == 0
        tips = [places[face[one], (corner[one] + 2) % 3], places[face[other], (corner[other] + 2) % 3]]
        self.difference = np.mean([self.across(image, tips, share) for share in (0.2, 0.5, 0.8)], 0)

    def across(self, image, tips, share):
        colors = []
        for k, tip in enumerate(tips):
            a, b = self.ends[2 * k], self.ends[2 * k + 1]
            along, on = b - a, a + share * (b - a)
            height = np.abs(along[:, 0] * (tip - a)[:, 1] - along[:, 1] * (tip - a)[:, 0])
            height /= np.maximum(np.linalg.norm(along, axis=1), 1e-9)
            colors.append(color_at(image, on + (tip - on) * np.minimum(1 / np.maximum(height, 1e-9), 0.5)[:, None]))
        return np.abs(colors[0] - colors[1]).mean(1)

    def mean(self, which):
        return (self.difference[which] * self.length[which]).sum() / self.length[which].sum()


def straight_borders(edges, chart):
    """Borders of two charts that one rigid motion (and a scale) brings together: (weight, charts, edges)"""
    groups = defaultdict(list)
    a, b, c, d = (e @ [1, 1j] for e in edges.ends)
    for i in np.nonzero(~edges.joined)[0]:
        pair = chart[edges.faces[0][i]], chart[edges.faces[1][i]]
        if pair[0] == pair[1] or abs(b[i] - a[i]) < 0.3 or abs(d[i] - c[i]) < 0.3:
            continue
        from_to = (a[i], b[i], c[i], d[i]) if pair[0] < pair[1] else (c[i], d[i], a[i], b[i])
        groups[tuple(sorted(pair))].append((i, *from_to))
    for pair, rows in groups.items():
        index = np.array([row[0] for row in rows])
        p, q, r, s = np.array([row[1:] for row in rows]).T
        weight = edges.length[index] * edges.difference[index]
        left = np.ones(len(rows), bool)
        while left.any():
            best = np.argmax(np.where(left, weight, -1))
            turn = (q[best] - p[best]) / (s[best] - r[best])
            move = p[best] - turn * r[best]
            fits = left & (abs(turn * r + move - p) < STRAIGHT) & (abs(turn * s + move - q) < STRAIGHT)
            fits[best] = True
            left &= ~fits
            if 1 / SCALE < abs(turn) < SCALE:
                yield weight[fits].sum(), pair, index[fits]


def unfold(edges, chart):
    """-> which edges lie inside of charts after joining them"""
    parent = list(range(chart.max() + 1))

    def root(x):
        while parent[x] != x:
            parent[x] = parent[parent[x]]
            x = parent[x]
        return x

    joined = edges.joined.copy()
    for _, pair, index in sorted(straight_borders(edges, chart), key=lambda border: -border[0]):
        one, other = root(pair[0]), root(pair[1])
        if one != other:
            parent[one] = other
            joined[index] = True
    return joined


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    vertices, faces, places, image = read_model(sys.argv[1])
    edges = Edges(vertices, faces, places, image)
    one, other = (f[edges.joined] for f in edges.faces)
    count, chart = connected_components(coo_matrix((np.ones(len(one), bool), (one, other)), (len(faces),) * 2))
    print(f"{'':28}{'borders, m':>12}{'across':>9}{'inside':>9}{'excess':>9}   (grey levels)")
    for name, inside in ((f"{count} charts", edges.joined), ("joined where they can be", unfold(edges, chart))):
        across, within = edges.mean(~inside), edges.mean(inside)
        print(f"{name:28}{edges.length[~inside].sum():12.0f}{across:9.2f}{within:9.2f}{across - within:9.2f}")


if __name__ == "__main__":
    main()
