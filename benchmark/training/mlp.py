# SPDX-License-Identifier: BSD-3-Clause
"""Multilayer perceptrons with two hidden layers of rectified linear units (ReLU): what their training has in common.
filters/src/networks/mlp.h evaluates them."""
import struct
import sys

try:
    import numpy as np
except ImportError:
    sys.exit(f"networks are trained with numpy (apt-get install python3-numpy): not in {sys.executable}")


class Mlp:
    """weights: matrices of the first layer (inputs, first), one for each of `parts` sets of features, bias; second layer
    (first, second), bias; last layer (second, 1)"""

    def __init__(self, features, parts, sizes, random, most=1_000_000):
        """features (N, inputs): of about `most` of them the limits and the scale are taken"""
        # The extreme thousandths do not count: what was not seen in training is as what was.
        some = features[::max(1, len(features) // most)]
        self.lowest, self.highest = np.quantile(some, [0.001, 0.999], axis=0).astype(np.float32)
        within = np.clip(some, self.lowest, self.highest)
        self.mean, self.scale = within.mean(0), np.maximum(within.std(0), 1e-6)
        self.parts, (first, second), inputs = parts, sizes, features.shape[1]
        self.weights = [random.normal(0, np.sqrt(1 / inputs), (inputs, first)) for _ in range(parts)] + [
            np.zeros(first), random.normal(0, np.sqrt(2 / first), (first, second)), np.zeros(second),
            random.normal(0, 0.1, (second, 1))]
        self.weights = [w.astype(np.float32) for w in self.weights]
        self.steps, self.means, self.squares = 0, None, None

    def scaled(self, features):
        return (np.clip(features, self.lowest, self.highest) - self.mean) / self.scale

    def upper(self, sums):
        """sums of the first layer with its bias -> values of both layers (N,first), (N,second), output (N,)"""
        second, bias, last = self.weights[self.parts + 1:self.parts + 4]
        a = np.maximum(sums, 0)
        b = np.maximum(a @ second + bias, 0)
        return a, b, (b @ last)[:, 0]

    def back(self, change, a, b):
        """gradient by the output (N,1) -> gradients by the sums of the first layer, by the weights of the others"""
        second, _, last = self.weights[self.parts + 1:self.parts + 4]
        at_second = (change @ last.T) * (b > 0)
        at_first = (at_second @ second.T) * (a > 0)
        return at_first, [a.T @ at_second, at_second.sum(0), b.T @ change]

    def learn(self, gradients, rate, decay):
        """A step of Adam (Kingma & Ba 2015)."""
        if self.means is None:
            self.means, self.squares = ([np.zeros_like(w) for w in self.weights] for _ in range(2))
        self.steps += 1
        for w, g, m, s in zip(self.weights, gradients, self.means, self.squares):
            m += 0.1 * (g - m)
            s += 0.001 * (g * g - s)
            w -= rate * (m / (1 - 0.9**self.steps) / (np.sqrt(s / (1 - 0.999**self.steps)) + 1e-8) + decay * w)

    def write(self, path, names):
        """Weights for features as they come, in the format of filters/src/networks/weights.h. names: of the matrices of the
        first layer"""
        matrices = [w / self.scale[:, None] for w in self.weights[:self.parts]]
        bias = self.weights[self.parts] - self.mean @ sum(matrices)
        others = ["first_bias", "second_weights", "second_bias", "last_weights", "last_bias"]
        write_matrices(path, dict(zip(["lowest", "highest"] + names + others,
                                      [self.lowest, self.highest] + matrices + [bias] + self.weights[self.parts + 1:])))


MAGIC = b"FRESCO\x1aW"


def write_matrices(path, matrices):
    """matrices: by name; a vector is a row"""
    matrices = {name: np.atleast_2d(values).astype("<f4") for name, values in matrices.items()}
    with open(path, "wb") as file:
        file.write(MAGIC + struct.pack("<I", len(matrices)))
        for name, values in matrices.items():
            file.write(struct.pack("<24sII", name.encode(), *values.shape))
        for values in matrices.values():
            file.write(values.tobytes())


def read_matrices(path):
    with open(path, "rb") as file:
        if file.read(8) != MAGIC:
            sys.exit(f"{path}: no weights of a network")
        heads = [struct.unpack("<24sII", file.read(32)) for _ in range(struct.unpack("<I", file.read(4))[0])]
        return {name.rstrip(b"\0").decode(): np.fromfile(file, "<f4", rows * columns).reshape(rows, columns)
                for name, rows, columns in heads}
