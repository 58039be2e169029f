#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains the networks with which withoutMixedPixels() classifies points, and says what they find.

    fresco_benchmark_beams -o a1 -scene apartment        and others to learn from
    fresco_benchmark_beams -o c1 -scene conference_room       never learned from
    mixed_pixels.py --train a* --test c* --write filters/data/mixed_pixels.bin

and once the filter is built anew with it, from rows written with -second_stage, filters/data/second_stage.bin: of what the
first network leaves in doubt, with its scores. The loss is the negative log-likelihood of the labels; points with label
1 (beams that met several surfaces, points near one) are left out. Recall counts points with label 2 (mixed pixels in
the air), precision those with label 1 or 2. The same files give the same network on the same machine."""
import argparse
import sys

from mlp import Mlp, np

SURFACE, NEAR_SURFACE, MIXED, BATCH = 0, 1, 2, 1024


class Beams:
    def __init__(self, paths, features):
        rows = np.concatenate([np.fromfile(path, np.float32).reshape(-1, 3 + features) for path in paths])
        others = rows[:, 0] < 0
        self.unseen = rows[others, 2].sum()  # mixed pixels that are not among the rows
        rows = rows[~others]
        self.label, self.weight, self.features = rows[:, 1], rows[:, 2], rows[:, 3:]


class Network(Mlp):
    def __init__(self, features, sizes, random):
        super().__init__(features, 1, sizes, random, 300_000)
        self.weights.append(np.zeros(1, np.float32))

    def forward(self, features):
        """-> values of both layers (N,first), (N,second), scores (N,)"""
        a, b, output = self.upper(features @ self.weights[0] + self.weights[1])
        return a, b, output + self.weights[5]

    def score(self, features):
        parts = np.array_split(features, len(features) // 100_000 + 1)
        return np.concatenate([self.forward(self.scaled(part))[2] for part in parts])

    def gradients(self, features, mixed, weight):
        """-> sum of the negative logarithms, gradients of the weights; features are scaled()"""
        a, b, score = self.forward(features)
        loss = (weight * (np.logaddexp(0, score) - mixed * score)).sum()
        change = ((1 / (1 + np.exp(-score)) - mixed) * weight / len(features))[:, None].astype(np.float32)
        at_first, others = self.back(change, a, b)
        return loss, [features.T @ at_first, at_first.sum(0)] + others + [change.sum(0)]


def train(beams, options, random):
    known = beams.label != NEAR_SURFACE
    features, mixed, weight = (x[known] for x in (beams.features, beams.label == MIXED, beams.weight))
    mixed, weight = mixed.astype(np.float32), (weight / weight.mean()).astype(np.float32)
    network = Network(features, options.sizes, random)
    features = network.scaled(features)
    step, steps = 0, options.epochs * -(-len(features) // BATCH)
    for epoch in range(options.epochs):
        order, total = random.permutation(len(features)), 0
        for begin in range(0, len(features), BATCH):
            rows = order[begin:begin + BATCH]
            loss, gradients = network.gradients(features[rows], mixed[rows], weight[rows])
            total, step = total + loss, step + 1
            network.learn(gradients, 0.003 * 0.5 * (1 + np.cos(np.pi * step / steps)) + 1e-5, options.decay)
        print(f"epoch {epoch + 1} of {options.epochs}: {total / len(features):.4f}", file=sys.stderr, flush=True)
    return network


def print_row(name, beams, score):
    order = np.argsort(-score, kind="stable")
    label, weight, score = beams.label[order], beams.weight[order], score[order]
    recall = np.cumsum(label == MIXED) / ((label == MIXED).sum() + beams.unseen)
    precision = np.cumsum(label != SURFACE) / np.cumsum(np.where(label == SURFACE, weight, 1))
    cells = []
    for least in (0.85, 0.9, 0.95):
        at = np.flatnonzero(precision >= least)
        cells.append(f"{recall[at[-1]]:.3f}, {score[at[-1]]:.1f}" if len(at) else "-")
    for least in (0, 1, 2):
        at = np.searchsorted(-score, -least) - 1
        cells.append(f"{recall[at]:.3f} / {precision[at]:.3f}" if at >= 0 else "-")
    print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--train", nargs="+", required=True, metavar="FILE", help="of fresco_benchmark_beams")
    parser.add_argument("--test", nargs="+", default=[], metavar="FILE", help="a row of the table each")
    parser.add_argument("--write", metavar="FILE", help="where the network goes")
    parser.add_argument("--features", type=int, default=154, help="of a beam; 455 with -second_stage (default: %(default)s)")
    parser.add_argument("--sizes", nargs=2, type=int, default=[32, 16], help="of the layers (default: 32 16)")
    parser.add_argument("--epochs", type=int, default=10, help="default: %(default)s")
    parser.add_argument("--decay", type=float, default=1e-4,
                        help="of weights a step, part of the rate (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="default: %(default)s")
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    beams = Beams(options.train, options.features)
    print(f"{np.count_nonzero(beams.label == MIXED)} mixed pixels, {np.count_nonzero(beams.label == SURFACE)} others",
          file=sys.stderr)
    network = train(beams, options, random)
    if options.write:
        network.write(options.write, ["first_weights"])
    print("| | recall, score at precision 0.85 | 0.9 | 0.95 | recall / precision at score 0 | 1 | 2 |\n" + "|---" * 7 + "|")
    for path in options.test:
        test = Beams([path], options.features)
        print_row(path, test, network.score(test.features))


if __name__ == "__main__":
    main()
