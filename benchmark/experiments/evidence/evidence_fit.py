#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fits registration's evidence (benchmark/experiments/evidence/frame_evidence.h): evidence_fit.py PAIRS.txt... [-check PAIRS.txt...].

PAIRS.txt: what fresco_benchmark_evidence pairs prints, a file a floor; all floors weigh the same. Logistic regression of
right proposals (5 cm, 1 degree) against wrong ones (0.3 m or 6 degrees and more), by gradient descent (Adam, Kingma & Ba
2015). What a room's agreement is worth at most is first fitted for each floor, then as a law of what the floor's proposals
show without labels: of those whose rooms agree much, how many nothing contradicts. Prints the numbers of the model and how
well claimed odds are calibrated."""
import argparse

import numpy as np

KINDS, BINS = 3, 9
NEVER = -20.0  # logarithm of what counts nothing
START = np.concatenate([np.log([0.002, 0.006, 0.03]), [NEVER], np.log(np.full(BINS - 1, 0.3)), [-2.0]])
COST, PRIOR = KINDS, KINDS + BINS
STRONG = 15.0  # log-odds of two rooms before the bound: nearly all of them agrees


def read(path):
    """Per usable proposal: label, rooms as rows (own, confirmed by kind, compared), counts of contradicted groups."""
    proposals = []
    for line in open(path):
        words = line.split()
        if not words or words[0] != "pair":
            continue
        distance, angle = float(words[3]), float(words[4])
        right, wrong = distance < 0.05 and angle < 1, distance > 0.3 or angle > 6
        if not right and not wrong:
            continue
        rooms, groups, k = [], np.zeros(BINS), 6
        while k < len(words):
            if words[k] == "groups":
                groups += np.array(words[k + 1:k + 1 + BINS], float)
                k += 1 + BINS
            else:
                rooms.append([words[k] == "own"] + [float(w) for w in words[k + 1:k + 2 + KINDS]])
                k += 2 + KINDS
        proposals.append((right, np.array(rooms, float).reshape(-1, 2 + KINDS), groups))
    return proposals


class Data:
    def __init__(self, paths):
        floors = [read(path) for path in paths]
        proposals = [p for floor in floors for p in floor]
        self.paths = paths
        self.floor = np.repeat(np.arange(len(floors)), [len(floor) for floor in floors])
        self.right = np.array([p[0] for p in proposals], float)
        self.rooms = np.vstack([p[1] for p in proposals])
        self.of = np.repeat(np.arange(len(proposals)), [len(p[1]) for p in proposals])
        self.groups = self.raw = np.array([p[2] for p in proposals])
        self.compared = self.sums(self.rooms[:, -1])
        self.weight = np.concatenate([np.full(len(floor), 1 / max(1, len(floor))) for floor in floors])
        self.weight *= len(proposals) / self.weight.sum()

    def stray_rate(self):
        """Contradicted groups in a comparison at right places, by size."""
        right = self.right > 0
        return (self.groups[right].sum(0) + 0.5 * (np.arange(BINS) < 3)) / self.compared[right].sum()

    def spare(self, stray):
        self.groups = np.maximum(0, self.groups - stray * self.compared[:, None])
        return self

    def sums(self, values):
        return np.bincount(self.of, values, len(self.right))


def log_odds(x, most, data):
    """With derivatives by x, then by the logarithm of each floor's bound of a room."""
    agree, cost, prior = np.exp(x[:KINDS]), np.cumsum(np.exp(x[COST:PRIOR])), x[PRIOR]
    counts = data.rooms[:, 1:-1]
    L = np.exp(most)[data.floor[data.of]]
    ratio = counts @ agree / L
    left = np.exp(-ratio)
    value = 0.5 * L * (1 - left)  # of two scans that see a room one agrees with the other
    rows = [data.sums(0.5 * left * counts[:, k]) * agree[k] for k in range(KINDS)]
    slope = 0.5 * L * ((1 - left) - ratio * left)
    increments = np.exp(x[COST:PRIOR])
    rows += [-data.groups[:, k:].sum(1) * increments[k] for k in range(BINS)]
    rows.append(np.ones(len(data.right)))
    per_floor = data.sums(slope)
    rows += [per_floor * (data.floor == f) for f in range(len(most))]
    return data.sums(value) - data.groups @ cost + prior, np.array(rows)


def surprise(x, data):
    """Per floor the logarithm of refuted over clean proposals among those whose rooms agree much; no labels."""
    own = 0.5 * data.sums((data.rooms[:, 1:-1] @ np.exp(x[:KINDS])) * data.rooms[:, 0])
    strong, clean = own > STRONG, data.raw[:, 1:].sum(1) == 0
    return np.array([np.log((1 + (strong & ~clean & (data.floor == f)).sum()) / (1 + (strong & clean & (data.floor == f)).sum()))
                     for f in range(len(data.paths))])


def bounds(law, x, data):
    """Logarithms of what agreement of a room is worth at most."""
    return np.log(np.maximum(0.1, law[0] + law[1] * surprise(x, data)))


def descend(data, x, most, free, steps=4000, strength=0.0003):
    """Ties all numbers to where they start, so that what the data do not tell stays finite."""
    begin = np.concatenate([x, most])
    x, mean, square = begin.copy(), np.zeros(len(begin)), np.zeros(len(begin))
    for step in range(1, steps + 1):
        odds, rows = log_odds(x[:len(START)], x[len(START):], data)
        off = 1 / (1 + np.exp(-np.clip(odds, -50, 50))) - data.right
        gradient = (rows @ (data.weight * off) / len(off) + strength * (x - begin)) * free
        mean, square = 0.9 * mean + 0.1 * gradient, 0.999 * square + 0.001 * gradient ** 2
        x -= 0.01 * mean / (1 - 0.9 ** step) / (np.sqrt(square / (1 - 0.999 ** step)) + 1e-8)
    return x[:len(START)], x[len(START):]


def fit(data, without):
    """Numbers of the model, and the law of a room's bound."""
    floors = len(data.paths)
    begin, most = START.copy(), np.full(floors, np.log(3.0))
    free = np.ones(len(START) + floors)
    free[COST] = 0  # a single patch contradicts nothing: mixed pixels do
    if without == "rooms":
        most[:] = np.log(1e4)
        free[len(START):] = 0
    if without == "contradiction":
        begin[COST:PRIOR], free[COST:PRIOR] = NEVER, 0
    x, most = descend(data, begin, most, free)
    if without in ("rooms", "job"):
        law = np.array([np.exp(most).mean(), 0.0])
    else:
        law = np.polyfit(surprise(x, data), np.exp(most), 1)[::-1]
    print("surprise and bound of a room: " + ", ".join(f"{p.split('/')[-2]} {s:.2f} {np.exp(m):.2f}"
          for p, s, m in zip(data.paths, surprise(x, data), most)))
    free[len(START):] = 0
    return descend(data, x, bounds(law, x, data), free)[0], law


def report(name, x, most, data):
    odds, _ = log_odds(x, most, data)
    loss = np.average(np.logaddexp(0, np.where(data.right > 0, -odds, odds)), weights=data.weight)
    rank = np.empty(len(odds))
    rank[np.argsort(odds)] = np.arange(len(odds))
    positive = data.right > 0
    area = (rank[positive].mean() - (positive.sum() - 1) / 2) / max(1, (~positive).sum())
    print(f"{name}: {len(odds)} proposals, {positive.mean():.2f} right, loss {loss:.4f}, area under the curve {area:.4f}")
    claimed = 1 / (1 + np.exp(-odds))
    for low, high in [(0, .01), (.01, .1), (.1, .5), (.5, .9), (.9, .99), (.99, .999), (.999, 1.01)]:
        inside = (claimed >= low) & (claimed < high)
        if inside.any():
            print(f"  claimed {low} to {min(high, 1)}: {inside.sum()} proposals, {data.right[inside].mean():.4f} right")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pairs", nargs="+")
    parser.add_argument("-check", nargs="*", default=[], help="pairs that nothing is fitted to")
    parser.add_argument("-without", default="", help="rooms (no bound), job (one bound for all), contradiction: leaves this term out")
    args = parser.parse_args()
    data = Data(args.pairs)
    stray = data.stray_rate()
    data.spare(stray)
    x, law = fit(data, args.without)
    join = lambda values: ", ".join(f"{v:.4g}" for v in values)
    print(f"{{{{{join(np.exp(x[:KINDS]))}}}, {join(law)}, "
          f"{{{join(np.cumsum(np.exp(x[COST:PRIOR])))}}}, {{{join(stray)}}}, {x[PRIOR]:.4g}}}")
    report("fitted", x, bounds(law, x, data), data)
    if args.check:
        check = Data(args.check).spare(stray)
        report("not fitted", x, bounds(law, x, check), check)


if __name__ == "__main__":
    main()
