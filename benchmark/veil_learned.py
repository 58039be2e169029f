#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How many veil points a classifier finds that was shown the truth of other scans, beside `fresco_filter -veil`.

    fresco_scan conference_room room -labels -no_images -stations 6 -points 1000000
    fresco_scan apartment flat -labels -no_images -stations 6 -points 1000000
    veil_learned.py --train room/scans/scan_0[0-3].pcd flat/scans/*.pcd --test room/scans/scan_0[45].pcd

Boosted trees get, for each beam, the ranges of about 100 beams around it, and where lines and planes through those
would meet it. Recall counts points with label 2 (veil), precision points with label 1 or 2 (beams that met several
surfaces), as docs/filters.md does; label 1 is left out of the training. Whoever sees the truth of the same furniture
from other stations is hard to beat by a rule without; it is no strict bound. Scans must be those of fresco_scan: beams
in rows from 60 degrees below the horizon to the zenith."""
import argparse
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from sklearn.ensemble import HistGradientBoostingClassifier
except ImportError:
    sys.exit(f"veil_learned.py needs numpy and scikit-learn (apt-get install python3-sklearn): not in {sys.executable}")

LOWEST, HIGHEST = -np.pi / 3, np.pi / 2  # elevations of fresco_scan
CHUNK = 200_000  # beams at a time
AROUND = [(dy, dx) for dy in range(-4, 5) for dx in range(-4, 5) if (dy, dx) != (0, 0)]
WIDE = [(k * dy, k * dx) for k in (6, 9, 14) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if (dy, dx) != (0, 0)]
BESIDE = [(dy, dx) for dy in (-1, 0, 1) for dx in range(-3, 4) if (dy, dx) != (0, 0)]
DIRECTIONS = [(0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1)]
SURFACE, MIXED, VEIL = 0, 1, 2


def read_pcd(path):
    """binary PCD of fields of one count -> structured array"""
    with open(path, "rb") as file:
        header = {}
        while "DATA" not in header:
            line = file.readline()
            if not line:
                sys.exit(f"{path}: not a PCD file")
            words = line.decode("ascii", "replace").split()
            header[words[0]] = words[1:]
        if header["DATA"] != ["binary"]:
            sys.exit(f"{path}: not a binary PCD file")
        kinds = [t.lower() + s for t, s in zip(header["TYPE"], header["SIZE"])]
        return np.fromfile(file, np.dtype(list(zip(header["FIELDS"], kinds))), int(header["POINTS"][0]))


def keys(points):
    x, y, z = (np.ascontiguousarray(points[name]).view(np.uint32).astype(np.uint64) for name in "xyz")
    return (x * np.uint64(0x9E3779B97F4A7C15)) ^ (y * np.uint64(0xC2B2AE3D27D4EB4F)) ^ (
        z * np.uint64(0x165667B19E3779F9))


def taken_by_filter(program, path):
    with tempfile.NamedTemporaryFile(suffix=".pcd") as kept:
        subprocess.run([program, path, kept.name, "-veil", "20", "-quiet"], check=True)
        return ~np.isin(keys(read_pcd(path)), keys(read_pcd(kept.name)))


class Scan:
    """The ranges as an image of rows of equal elevation; NaN where no beam came back."""

    def __init__(self, path):
        points = read_pcd(path)
        if "label" not in points.dtype.names:
            sys.exit(f"{path}: no labels (fresco_scan -labels)")
        self.label = points["label"].astype(np.int8)
        xyz = np.stack([points[name].astype(np.float64) for name in "xyz"], 1)
        self.range = np.linalg.norm(xyz, axis=1)
        elevation, azimuth = np.arcsin(xyz[:, 2] / self.range), np.arctan2(xyz[:, 1], xyz[:, 0])
        steps = np.diff(elevation)
        rows = int(round((HIGHEST - LOWEST) * np.count_nonzero(steps > 1e-5) / (elevation[-1] - elevation[0])))
        level = np.abs(elevation) < 1
        guess = int(round(rows * 2 * np.pi / (HIGHEST - LOWEST)))
        columns = min(range(guess - 3, guess + 4), key=lambda n: off_grid(azimuth[level] * n / (2 * np.pi)))
        places = (elevation - LOWEST) / (HIGHEST - LOWEST) * rows - 0.5
        if max(off_grid(places), off_grid(azimuth[level] * columns / (2 * np.pi))) > 0.05:
            sys.exit(f"{path}: beams are not in the rows of fresco_scan")
        self.row = np.rint(places).astype(np.int32)
        self.column = np.rint(azimuth * columns / (2 * np.pi)).astype(np.int32) % columns
        self.image = np.full((rows, columns), np.nan, np.float32)
        self.image[self.row, self.column] = self.range
        self.cosines = np.cos(LOWEST + (HIGHEST - LOWEST) * (np.arange(rows) + 0.5) / rows)
        self.step = (HIGHEST - LOWEST) / rows  # radians

    def around(self, beams, offsets, by_angle=True):
        """-> ranges (N,K); across the beam by angle, or beam by beam; and places (N,K,2) in the tangent plane"""
        ranges = np.empty((len(beams), len(offsets)), np.float32)
        places = np.empty((len(beams), len(offsets), 2), np.float32)
        rows, columns = self.image.shape
        for k, (dy, dx) in enumerate(offsets):
            row = self.row[beams] + dy
            inside = np.clip(row, 0, rows - 1)
            cosine = self.cosines[inside]
            shift = np.rint(dx / cosine).astype(np.int64) if by_angle else dx
            ranges[:, k] = np.where(row == inside, self.image[inside, (self.column[beams] + shift) % columns], np.nan)
            places[:, k, 0], places[:, k, 1] = shift * cosine * self.step, dy * self.step
        return ranges, places


def off_grid(places):
    return np.mean(np.abs(places - np.rint(places)))


def plane_at_beam(ranges, places, members, noise):
    """Least squares of one over the depth, twice more without what lies off -> range at which the plane meets the beam,
    deviation of the members"""
    places = places[:, members] / np.max(np.abs(places), axis=(1, 2), keepdims=True)
    there = np.isfinite(ranges[:, members])
    height = np.where(there, 1 / ranges[:, members], 0).astype(np.float64)
    rows = np.concatenate([np.ones_like(places[..., :1]), places], 2) * there[..., None]
    weight = there.astype(np.float64)
    for _ in range(3):
        normal = np.einsum("nki,nk,nkj->nij", rows, weight, rows) + 1e-6 * np.eye(3)
        plane = np.linalg.solve(normal, np.einsum("nki,nk,nk->ni", rows, weight, height)[..., None])[..., 0]
        with np.errstate(all="ignore"):
            off = np.where(there, 1 / height - 1 / np.einsum("nki,ni->nk", rows, plane), 0)
            used, weight = weight, there / (1 + (off / (3 * noise))**4)
    count = used.sum(1)
    with np.errstate(all="ignore"):
        return (np.where(count > 3, 1 / plane[:, 0], np.nan),
                np.where(count > 3, np.sqrt((used * off**2).sum(1) / np.maximum(count - 3, 1)), np.nan))


def line_inputs(scan, beams, own, noise):
    """Where lines through beams of 8 directions meet the beam, in deviations: from one side, from both, sorted too."""
    inverse = [1 / scan.around(beams, [(k * dy, k * dx) for dy, dx in DIRECTIONS])[0] for k in (1, 2, 3, 4)]
    near, later, third = (2 * inverse[0] - inverse[1], 2 * inverse[1] - inverse[2],
                          (4 * inverse[0] + inverse[1] - 2 * inverse[3]) / 3)
    later = later + (inverse[1] - inverse[2])  # two steps on
    both = (inverse[0] + np.roll(inverse[0], 4, 1))[:, :4] / 2
    off = [(own - 1 / at) / noise for at in (near, later, third, both)]
    return np.hstack(off + [np.sort(o, 1) for o in off] + [np.sort(np.abs(o), 1) for o in off])


def plane_inputs(scan, beams, own, noise):
    """Planes through half and quarter discs of 8 directions: distance along the beam, misfit, in deviations"""
    columns = []
    for radius, reach in ((2.9, 1.4), (4.3, 0.85)):
        offsets = [o for o in AROUND if np.hypot(*o) < radius]
        ranges, places = scan.around(beams, offsets)
        bearings = np.arctan2(*np.transpose(offsets))
        off = []
        for direction in range(8):
            turn = np.remainder(bearings - (direction + 0.5) * np.pi / 4 + np.pi, 2 * np.pi) - np.pi
            at, misfit = plane_at_beam(ranges, places, np.flatnonzero(np.abs(turn) <= reach), noise)
            off.append((own[:, 0] - at) / noise[:, 0] / np.sqrt(1 + (misfit / noise[:, 0])**2))
            columns.append(misfit / noise[:, 0])
        off = np.stack(off)
        columns += list(off) + list(np.sort(off, 0)) + [(off > 4).sum(0), (off < -4).sum(0), (np.abs(off) <= 4).sum(0)]
    return np.stack(columns, 1)


def inputs(scan, beams, deviation):
    """(N,K) of float32"""
    own = scan.range[beams][:, None].astype(np.float32)
    noise = deviation * (0.6 + 0.1 * own)
    ranges, places = scan.around(beams, AROUND)
    beside, beside_places = scan.around(beams, BESIDE, by_angle=False)
    ahead = beside - own
    gaps = np.hypot(ahead, np.hypot(*np.moveaxis(beside_places, 2, 0)) * np.minimum(beside, own))
    small = [k for k, o in enumerate(AROUND) if max(np.abs(o)) <= 2]
    with np.errstate(all="ignore"):
        return np.hstack([
            own, scan.cosines[scan.row[beams]][:, None],
            np.log(ranges / own), np.log(scan.around(beams, WIDE)[0] / own), ahead / noise,
            np.sort(ahead / noise, 1), np.sort((ranges[:, small] - own) / noise, 1), np.sort(gaps, 1)[:, :4] / noise,
            np.sort(gaps, 1)[:, :4] / (own * scan.step), np.sort(np.abs(ahead), 1)[:, :6] / noise,
            line_inputs(scan, beams, own, noise), plane_inputs(scan, beams, own, noise)]).astype(np.float32)


def lines_missed(scan, deviation):
    """Per beam, of the row and the column through it: how many put it more than 4 deviations off the line through the
    beams to both sides, or lack one"""
    image, off = scan.image, np.zeros(scan.image.shape, np.int8)
    for axis in (0, 1):
        between = 2 / (1 / np.roll(image, 1, axis) + 1 / np.roll(image, -1, axis))
        with np.errstate(invalid="ignore"):
            off += ~(np.abs(between - image) < 4 * deviation * (0.6 + 0.1 * image))
    return off[scan.row, scan.column]


def choose(scan, options, part, random):
    """-> beams, weights: all that met several surfaces, parts of the others, largest of those that miss both lines"""
    share = np.array([part / 100, part / 10, part])[lines_missed(scan, options.noise)]
    share[scan.label != SURFACE] = 1
    beams = np.flatnonzero(random.random(len(share)) < share)
    return beams, 1 / share[beams]


def train(paths, options, random):
    X, y, weights = [], [], []
    for path in paths:
        scan = Scan(path)
        beams, weight = choose(scan, options, options.train_part, random)
        used = scan.label[beams] != MIXED
        beams, weight = beams[used], weight[used]
        X.append(inputs(scan, beams, options.noise))
        y.append(scan.label[beams] == VEIL)
        weights.append(weight)
    X, y, weights = np.concatenate(X), np.concatenate(y), np.concatenate(weights)
    print(f"trained on {len(paths)} scans: {np.count_nonzero(y)} veil points, {np.count_nonzero(~y)} others, "
          f"{X.shape[1]} inputs", flush=True)
    return HistGradientBoostingClassifier(
        learning_rate=0.1, max_iter=options.trees, max_leaf_nodes=options.leaves, min_samples_leaf=40,
        l2_regularization=5, early_stopping=False, random_state=1).fit(X, y, weights)


def companions(scan, beams, deviation):
    """What a beam looks like: how many of the 8 beside it lie within 4 deviations, whether nearer and farther ones are
    there"""
    ahead = (scan.around(beams, DIRECTIONS)[0] - scan.range[beams][:, None]) / (
        deviation * (0.6 + 0.1 * scan.range[beams][:, None]))
    return (np.abs(ahead) < 4).sum(1), (ahead < -4).any(1), (ahead > 4).any(1)


class Tested:
    """Scores of the beams of test scans"""

    def __init__(self, model, paths, options, random):
        score, label, taken, weight, looks = [], [], [], [], []
        for path in paths:
            scan = Scan(path)
            beams, w = choose(scan, options, options.test_part, random)
            for part in np.array_split(beams, len(beams) // CHUNK + 1):
                score.append(model.decision_function(inputs(scan, part, options.noise)))
                looks.append(np.stack(companions(scan, part, options.noise), 1))
            label.append(scan.label[beams])
            taken.append(taken_by_filter(options.filter, path)[beams])
            weight.append(w)
        self.score, self.label, self.taken, self.weight, self.looks = map(
            np.concatenate, (score, label, taken, weight, looks))

    def rates(self, chosen):
        """-> recall, precision"""
        several = np.count_nonzero(chosen & (self.label != SURFACE))
        return (np.mean(chosen[self.label == VEIL]), several / max(1e-9, np.sum(self.weight[chosen])))

    def curve(self):
        """-> scores descending, recall and precision when all down to each are taken"""
        order = np.argsort(-self.score)
        veil, several = np.cumsum(self.label[order] == VEIL), np.cumsum(self.label[order] != SURFACE)
        return self.score[order], veil / veil[-1], several / np.cumsum(self.weight[order])


def print_table(name, tested):
    score, recall, precision = tested.curve()
    rule = tested.rates(tested.taken)
    print(f"\n{name}: {np.count_nonzero(tested.label == VEIL)} veil points, "
          f"{np.count_nonzero(tested.label == MIXED)} mixed")
    print("| | recall | precision |\n|---|---|---|")
    print(f"| fresco_filter -veil | {rule[0]:.3f} | {rule[1]:.3f} |")
    for least in sorted({0.9, 0.95, round(rule[1], 3)}):
        at = np.flatnonzero(precision >= least)
        print(f"| learned, precision {least:g} | {recall[at[-1]] if len(at) else 0:.3f} | {least:.3f} |")
    for least in (0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95):
        print(f"| learned, recall {least:g} | {least:.3f} | {precision[np.searchsorted(recall, least)]:.3f} |")
    at = np.flatnonzero(precision >= 0.9)
    if len(at):
        print_looks(tested, score[at[-1]])


def print_looks(tested, limit):
    """What is wrongly taken and what is missed at a score"""
    above, (same, front, behind) = tested.score >= limit, tested.looks.T
    print("| at precision 0.9: of the 8 beams around | veil points | found | wrongly taken |\n|---|---|---|---|")
    for name, chosen in (
            ("none within 4 deviations, nearer and farther ones", (same == 0) & (front > 0) & (behind > 0)),
            ("1 or 2 within, nearer and farther ones", (same > 0) & (same < 3) & (front > 0) & (behind > 0)),
            ("3 or more within, nearer and farther ones", (same > 2) & (front > 0) & (behind > 0)),
            ("no nearer ones", (front == 0) & (behind > 0)), ("no farther ones", behind == 0)):
        veil = chosen & (tested.label == VEIL)
        print(f"| {name} | {np.count_nonzero(veil)} | {np.count_nonzero(veil & above)} "
              f"| {np.sum(tested.weight[chosen & above & (tested.label == SURFACE)]):.0f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--train", nargs="+", required=True, metavar="SCAN.pcd", help="labelled scans to learn from")
    parser.add_argument("--test", nargs="+", required=True, metavar="SCAN.pcd", help="labelled scans to find veil in")
    parser.add_argument("--filter", default="fresco_filter", help="program to compare with (default: %(default)s)")
    parser.add_argument("--noise", type=float, default=0.0025,
                        help="of the scans at 4 m, metres (default: %(default)s)")
    parser.add_argument("--train_part", type=float, default=1, metavar="SHARE",
                        help="of the surface points that stand out in their row and column that are learned from; a "
                        "tenth of it of those that do in one, a hundredth of the others (default: %(default)s)")
    parser.add_argument("--test_part", type=float, default=1, metavar="SHARE",
                        help="same for the test; points left out are made up for by weights (default: %(default)s)")
    parser.add_argument("--trees", type=int, default=150, help="default: %(default)s")
    parser.add_argument("--leaves", type=int, default=31, help="of a tree (default: %(default)s)")
    options = parser.parse_args()
    random = np.random.default_rng(1)
    model = train(options.train, options, random)
    print_table(f"{len(options.test)} test scans", Tested(model, options.test, options, random))


if __name__ == "__main__":
    main()
