#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains the network with which smoothNormals() selects normals beside creases, and says how good its choices are.

    fresco_benchmark_normal_candidates -o a2 -scene apartment -noise 0.002 -stations 3      and others to learn from
    fresco_benchmark_normal_candidates -o c2 -scene conference_room -noise 0.002 -stations 1    never learned from
    candidate_score.py --train a* --test c* --write filters/data/candidate_score.bin

A multilayer perceptron over the features of a candidate and those of the point's own normal gives its score; the
candidate of the greatest score is chosen. The loss is the mean angle to the true normal, up to 60 degrees, when
candidates are drawn with the softmax of their scores. Points elsewhere than within 2 cm of an edge count less
(--elsewhere). The same files give the same network on the same machine."""
import argparse
import sys

from mlp import Mlp, np

FEATURES, OWN = 44, 1  # of a candidate, where its cosine to the own normal stands
BESIDE_EDGE, MOST_DEGREES, BATCH = 0, 60.0, 1024


class Candidates:
    """Rows of candidates, those of one point together, the own normal first."""

    def __init__(self, paths, most=None, random=None):
        """most: points of each file, some at random"""
        parts, starts, at = [], [], 0
        for path in paths:
            part = np.fromfile(path, np.float32).reshape(-1, 3 + FEATURES)
            own = part[:, 3 + OWN] == 1
            if most and own.sum() > most:
                kept = random.permutation(own.sum()) < most
                part = part[kept[np.cumsum(own) - 1]]
                own = part[:, 3 + OWN] == 1
            parts.append(part)
            starts.append(at + np.flatnonzero(own))
            at += len(part)
        rows = np.concatenate(parts)
        self.starts = np.concatenate(starts)
        self.counts = np.diff(np.r_[self.starts, len(rows)])
        self.at_edge = rows[self.starts, 1] == BESIDE_EDGE
        self.degrees = np.degrees(np.arccos(np.clip(rows[:, 2], -1, 1)))
        self.features = rows[:, 3:]

    def rows_of(self, points):
        """-> rows, firsts of each point among them, counts"""
        counts = self.counts[points]
        firsts = np.r_[0, np.cumsum(counts)[:-1]]
        return np.repeat(self.starts[points] - firsts, counts) + np.arange(counts.sum()), firsts, counts


def softmax(score, firsts, counts):
    e = np.exp(score - np.repeat(np.maximum.reduceat(score, firsts), counts))
    return e / np.repeat(np.add.reduceat(e, firsts), counts)


class Network(Mlp):
    """The first layer gets the features of a candidate, and those of the own normal."""

    def __init__(self, candidates, sizes, random):
        super().__init__(candidates.features, 2, sizes, random)

    def forward(self, features, own, counts):
        """-> values of both layers (N,first), (N,second), scores (N,)"""
        direction, normal, bias = self.weights[:3]
        return self.upper(features @ direction + np.repeat(own @ normal + bias, counts, axis=0))

    def score(self, candidates):
        parts = []
        for points in np.array_split(np.arange(len(candidates.starts)), len(candidates.starts) // 100_000 + 1):
            rows, _, counts = candidates.rows_of(points)
            own = self.scaled(candidates.features[candidates.starts[points]])
            parts.append(self.forward(self.scaled(candidates.features[rows]), own, counts)[2])
        return np.concatenate(parts)

    def gradients(self, candidates, points, elsewhere):
        """-> expected degrees, gradients of the weights; features of the candidates are scaled()"""
        rows, firsts, counts = candidates.rows_of(points)
        features, own = candidates.features[rows], candidates.features[candidates.starts[points]]
        a, b, score = self.forward(features, own, counts)
        chance = softmax(score, firsts, counts)
        cost = np.minimum(candidates.degrees[rows], MOST_DEGREES) / MOST_DEGREES
        expected = np.add.reduceat(chance * cost, firsts)
        weight = np.where(candidates.at_edge[points], 1, elsewhere).astype(np.float32)
        weight /= weight.sum()
        change = (np.repeat(weight, counts) * chance * (cost - np.repeat(expected, counts)))[:, None]
        at_first, others = self.back(change.astype(np.float32), a, b)
        of_own = np.add.reduceat(at_first, firsts)
        return MOST_DEGREES * (weight * expected).sum(), [features.T @ at_first, own.T @ of_own, of_own.sum(0)] + others


def train(network, candidates, options, random):
    """Step sizes fall as a cosine."""
    points = len(candidates.starts)
    candidates.features = network.scaled(candidates.features)
    for epoch in range(options.epochs):
        rate = 0.003 * 0.5 * (1 + np.cos(np.pi * epoch / options.epochs))
        order, total = random.permutation(points), 0
        for begin in range(0, points, BATCH):
            degrees, gradients = network.gradients(candidates, order[begin:begin + BATCH], options.elsewhere)
            total += degrees * min(BATCH, points - begin) / points
            network.learn(gradients, rate, options.decay)
        print(f"epoch {epoch + 1} of {options.epochs}: {total:.3f} degrees expected", file=sys.stderr, flush=True)


def print_row(name, network, path):
    candidates = Candidates([path])
    score = network.score(candidates)
    most = np.repeat(np.maximum.reduceat(score, candidates.starts), candidates.counts)
    owner = np.repeat(np.arange(len(candidates.starts)), candidates.counts)
    hits = np.flatnonzero(score == most)
    chosen = candidates.degrees[hits[np.unique(owner[hits], return_index=True)[1]]]
    own, best = candidates.degrees[candidates.starts], np.minimum.reduceat(candidates.degrees, candidates.starts)
    cells = []
    for there in (candidates.at_edge, ~candidates.at_edge):
        cells.append(f" {there.sum()} |" + "".join(f" {d[there].mean():.2f}, {100 * np.mean(d[there] > 20):.1f} % |"
                                                   for d in (own, chosen, best)))
    print(f"| {name} |" + "".join(cells), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--train", nargs="+", required=True, metavar="FILE", help="of fresco_benchmark_normal_candidates")
    parser.add_argument("--test", nargs="+", default=[], metavar="FILE", help="a row of the table each")
    parser.add_argument("--write", metavar="FILE", help="where the network goes")
    parser.add_argument("--sizes", nargs=2, type=int, default=[16, 16], help="of the layers (default: 16 16)")
    parser.add_argument("--most", type=int, default=60000, help="points of each file (default: %(default)s)")
    parser.add_argument("--epochs", type=int, default=14, help="default: %(default)s")
    parser.add_argument("--elsewhere", type=float, default=0.3, help="default: %(default)s")
    parser.add_argument("--decay", type=float, default=1e-4,
                        help="of weights a step, part of the rate (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="default: %(default)s")
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    candidates = Candidates(options.train, options.most, random)
    network = Network(candidates, options.sizes, random)
    print(f"{len(candidates.starts)} points, {len(candidates.features)} candidates to learn from", file=sys.stderr)
    train(network, candidates, options, random)
    if options.write:
        network.write(options.write, ["of_candidate", "of_own_normal"])
    print("| degrees, > 20 | points beside edges | own | chosen | best candidate | elsewhere | own | chosen | best |")
    print("|" + "---|" * 9)
    for path in options.test:
        print_row(path, network, path)


if __name__ == "__main__":
    main()
