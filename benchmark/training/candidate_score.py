#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains the network with which smoothNormals() chooses normals beside creases, and says what choices are worth.

    fresco_benchmark_normal_candidates -o a2 -scene apartment -noise 0.002 -stations 3      and others to learn from
    fresco_benchmark_normal_candidates -o c2 -scene conference_room -noise 0.002 -stations 1    never learned from
    candidate_score.py --train a* --test c* --write filters/src/bilateral/candidate_weights.h

Two layers of rectifiers over the figures of a direction and those of the point's own normal give its worth; that of the
greatest worth is chosen. What falls during the training is the mean angle to the true normal, up to 60 degrees, when
directions are chosen with probabilities that are the softmax of their worths. Points elsewhere than within 2 cm of an
edge count less (--elsewhere). The same files give the same network on the same machine."""
import argparse
import sys

from mlp import Rectifiers, np

FIGURES, OWN = 44, 1  # of a direction, where its cosine to the own normal stands
BESIDE_EDGE, MOST_DEGREES, BATCH = 0, 60.0, 1024


class Offers:
    """Rows of directions, those of one point together, the own normal first."""

    def __init__(self, paths, most=None, random=None):
        """most: points of each file, some at random"""
        parts, starts, at = [], [], 0
        for path in paths:
            part = np.fromfile(path, np.float32).reshape(-1, 3 + FIGURES)
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
        self.figures = rows[:, 3:]

    def rows_of(self, points):
        """-> rows, firsts of each point among them, counts"""
        counts = self.counts[points]
        firsts = np.r_[0, np.cumsum(counts)[:-1]]
        return np.repeat(self.starts[points] - firsts, counts) + np.arange(counts.sum()), firsts, counts


def softmax(worth, firsts, counts):
    e = np.exp(worth - np.repeat(np.maximum.reduceat(worth, firsts), counts))
    return e / np.repeat(np.add.reduceat(e, firsts), counts)


class Network(Rectifiers):
    """The first layer gets the figures of a direction, and those of the own normal."""

    def __init__(self, offers, sizes, random):
        super().__init__(offers.figures, 2, sizes, random)

    def forward(self, figures, own, counts):
        """-> values of both layers (N,first), (N,second), worths (N,)"""
        direction, normal, bias = self.weights[:3]
        return self.upper(figures @ direction + np.repeat(own @ normal + bias, counts, axis=0))

    def worth(self, offers):
        parts = []
        for points in np.array_split(np.arange(len(offers.starts)), len(offers.starts) // 100_000 + 1):
            rows, _, counts = offers.rows_of(points)
            own = self.scaled(offers.figures[offers.starts[points]])
            parts.append(self.forward(self.scaled(offers.figures[rows]), own, counts)[2])
        return np.concatenate(parts)

    def gradients(self, offers, points, elsewhere):
        """-> expected degrees, gradients of the weights; figures of the offers are scaled()"""
        rows, firsts, counts = offers.rows_of(points)
        figures, own = offers.figures[rows], offers.figures[offers.starts[points]]
        a, b, worth = self.forward(figures, own, counts)
        chance = softmax(worth, firsts, counts)
        cost = np.minimum(offers.degrees[rows], MOST_DEGREES) / MOST_DEGREES
        expected = np.add.reduceat(chance * cost, firsts)
        weight = np.where(offers.at_edge[points], 1, elsewhere).astype(np.float32)
        weight /= weight.sum()
        change = (np.repeat(weight, counts) * chance * (cost - np.repeat(expected, counts)))[:, None]
        at_first, others = self.back(change.astype(np.float32), a, b)
        of_own = np.add.reduceat(at_first, firsts)
        return MOST_DEGREES * (weight * expected).sum(), [figures.T @ at_first, own.T @ of_own, of_own.sum(0)] + others


def train(network, offers, options, random):
    """Step sizes fall as a cosine."""
    points = len(offers.starts)
    offers.figures = network.scaled(offers.figures)
    for epoch in range(options.epochs):
        rate = 0.003 * 0.5 * (1 + np.cos(np.pi * epoch / options.epochs))
        order, total = random.permutation(points), 0
        for begin in range(0, points, BATCH):
            degrees, gradients = network.gradients(offers, order[begin:begin + BATCH], options.elsewhere)
            total += degrees * min(BATCH, points - begin) / points
            network.learn(gradients, rate, options.decay)
        print(f"epoch {epoch + 1} of {options.epochs}: {total:.3f} degrees expected", file=sys.stderr, flush=True)


def print_row(name, network, path):
    offers = Offers([path])
    worth = network.worth(offers)
    most = np.repeat(np.maximum.reduceat(worth, offers.starts), offers.counts)
    owner = np.repeat(np.arange(len(offers.starts)), offers.counts)
    hits = np.flatnonzero(worth == most)
    chosen = offers.degrees[hits[np.unique(owner[hits], return_index=True)[1]]]
    own, best = offers.degrees[offers.starts], np.minimum.reduceat(offers.degrees, offers.starts)
    cells = []
    for there in (offers.at_edge, ~offers.at_edge):
        cells.append(f" {there.sum()} |" + "".join(f" {d[there].mean():.2f}, {100 * np.mean(d[there] > 20):.1f} % |"
                                                   for d in (own, chosen, best)))
    print(f"| {name} |" + "".join(cells), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--train", nargs="+", required=True, metavar="FILE", help="of fresco_benchmark_normal_candidates")
    parser.add_argument("--test", nargs="+", default=[], metavar="FILE", help="a row of the table each")
    parser.add_argument("--write", metavar="direction_weights.h", help="where the network goes")
    parser.add_argument("--sizes", nargs=2, type=int, default=[16, 16], help="of the layers (default: 16 16)")
    parser.add_argument("--most", type=int, default=60000, help="points of each file (default: %(default)s)")
    parser.add_argument("--epochs", type=int, default=14, help="default: %(default)s")
    parser.add_argument("--elsewhere", type=float, default=0.3, help="default: %(default)s")
    parser.add_argument("--decay", type=float, default=1e-4,
                        help="of weights a step, part of the rate (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="default: %(default)s")
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    offers = Offers(options.train, options.most, random)
    network = Network(offers, options.sizes, random)
    print(f"{len(offers.starts)} points, {len(offers.figures)} directions to learn from", file=sys.stderr)
    train(network, offers, options, random)
    if options.write:
        network.write(options.write, ["of_direction", "of_own"], "candidate_score.py")
    print("| degrees, > 20 | points beside edges | own | chosen | best offered | elsewhere | own | chosen | best |")
    print("|" + "---|" * 9)
    for path in options.test:
        print_row(path, network, path)


if __name__ == "__main__":
    main()
