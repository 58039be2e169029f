#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Gradients of the networks that benchmark/ trains are those of finite differences, and what is written is what was
trained. test_networks.py BENCHMARK_FOLDER; ends with 77 where numpy is missing."""
import re
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


def test_veil(random):
    figures = random.normal(size=(60, 7))
    network = mixed_pixels.Network(figures, (5, 4), random)
    veil, weight = (random.random(60) < 0.4).astype(float), random.random(60)

    def both():
        loss, gradients = network.gradients(figures, veil, weight)
        return loss / len(figures), gradients

    check_gradients(network, both, random)


def test_normals(random):
    counts = random.integers(2, 5, 20)
    starts = np.cumsum(counts) - counts
    offers = SimpleNamespace(figures=random.normal(size=(counts.sum(), 6)), starts=starts, counts=counts,
                             degrees=random.uniform(0, 90, counts.sum()), at_edge=random.random(20) < 0.5)
    offers.rows_of = lambda points: candidate_score.Offers.rows_of(offers, points)
    network = candidate_score.Network(offers, (5, 4), random)

    def both():
        degrees, gradients = network.gradients(offers, np.arange(20), 0.3)
        return degrees / candidate_score.MOST_DEGREES, gradients

    check_gradients(network, both, random)


def test_written_weights(random):
    figures = random.normal(3, 2, (500, 7)).astype(np.float32)
    network = mixed_pixels.Network(figures, (5, 4), random)
    with tempfile.TemporaryDirectory() as folder:
        network.write(folder + "/some_weights.h", ["of_figures"], "test_networks.py")
        with open(folder + "/some_weights.h") as file:
            text = file.read()
    assert "struct SomeWeights {" in text
    values = {name: np.array([float(v.strip().rstrip("f")) for v in body.split(",") if v.strip()])
              for name, body in re.findall(r"(\w+)\[\d+\] = \{(.*?)\}", text, re.S)}
    within = np.clip(figures, values["lowest"], values["highest"])
    a = np.maximum(within @ values["of_figures"].reshape(7, 5) + values["first_bias"], 0)
    b = np.maximum(a @ values["second_weights"].reshape(5, 4) + values["second_bias"], 0)
    output = b @ values["last_weights"] + values["last_bias"]
    assert np.abs(output - network.score(figures)).max() < 1e-3


if __name__ == "__main__":
    for test in (test_veil, test_normals, test_written_weights):
        test(np.random.default_rng(1))
        print(f"{test.__name__}: passed")
