#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Gradients of the networks that benchmark/training trains are those of finite differences, and what is written is what
was trained. test_networks.py TRAINING_FOLDER; ends with 77 where numpy is missing."""
import os
import sys
import tempfile
from types import SimpleNamespace

sys.path.insert(0, sys.argv[1])
try:
    import numpy as np
except ImportError:
    print("SKIPPED: no numpy")
    sys.exit(77)

import candidate_score
import mixed_pixels
import mlp


def check_gradients(network, value_and_gradients, random):
    network.weights = [random.normal(0, 0.5, w.shape) for w in network.weights]  # double precision
    gradients = value_and_gradients()[1]
    assert len(gradients) == len(network.weights)
    for weights, gradient in zip(network.weights, gradients):
        assert gradient.shape == weights.shape
        for _ in range(5):
            at = tuple(random.integers(n) for n in weights.shape)
            old, step = weights[at], 1e-5
            weights[at] = old + step
            above = value_and_gradients()[0]
            weights[at] = old - step
            below = value_and_gradients()[0]
            weights[at] = old
            numeric = (above - below) / (2 * step)
            assert abs(numeric - gradient[at]) < 1e-3 * max(1, abs(numeric)), (at, numeric, gradient[at])


def test_mixed_pixels(random):
    features = random.normal(size=(60, 7))
    network = mixed_pixels.Network(features, (5, 4), random)
    mixed, weight = (random.random(60) < 0.4).astype(float), random.random(60)

    def both():
        loss, gradients = network.gradients(features, mixed, weight)
        return loss / len(features), gradients

    check_gradients(network, both, random)


def test_normals(random):
    counts = random.integers(2, 5, 20)
    starts = np.cumsum(counts) - counts
    candidates = SimpleNamespace(features=random.normal(size=(counts.sum(), 6)), starts=starts, counts=counts,
                             degrees=random.uniform(0, 90, counts.sum()), at_edge=random.random(20) < 0.5)
    candidates.rows_of = lambda points: candidate_score.Candidates.rows_of(candidates, points)
    network = candidate_score.Network(candidates, (5, 4), random)

    def both():
        degrees, gradients = network.gradients(candidates, np.arange(20), 0.3)
        return degrees / candidate_score.MOST_DEGREES, gradients

    check_gradients(network, both, random)


def test_written_weights(random):
    features = random.normal(3, 2, (500, 7)).astype(np.float32)
    network = mixed_pixels.Network(features, (5, 4), random)
    with tempfile.TemporaryDirectory() as folder:
        network.write(folder + "/some.bin", ["first_weights"])
        values = mlp.read_matrices(folder + "/some.bin")
    assert list(values) == ["lowest", "highest", "first_weights", "first_bias", "second_weights", "second_bias",
                            "last_weights", "last_bias"]
    assert np.abs(output(values, "first_weights", features) - network.score(features)).max() < 1e-3


def output(values, first, features):
    within = np.clip(features, values["lowest"], values["highest"])
    a = np.maximum(within @ values[first] + values["first_bias"], 0)
    b = np.maximum(a @ values["second_weights"] + values["second_bias"], 0)
    return (b @ values["last_weights"] + values["last_bias"])[:, 0]


def test_weights_of_the_library(_):
    folder = os.path.join(sys.argv[1], "..", "..", "filters", "data")
    for name, inputs, first, second in (("mixed_pixels", 154, 64, 24), ("second_stage", 455, 96, 32)):
        values = mlp.read_matrices(os.path.join(folder, name + ".bin"))
        assert values["first_weights"].shape == (inputs, first), name
        assert values["second_weights"].shape == (first, second), name
        assert np.isfinite(output(values, "first_weights", values["lowest"])).all(), name
    values = mlp.read_matrices(os.path.join(folder, "candidate_score.bin"))
    assert values["of_candidate"].shape == values["of_own_normal"].shape == (44, 16)


if __name__ == "__main__":
    for test in (test_mixed_pixels, test_normals, test_written_weights, test_weights_of_the_library):
        test(np.random.default_rng(1))
        print(f"{test.__name__}: passed")
