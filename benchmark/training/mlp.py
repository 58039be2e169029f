# SPDX-License-Identifier: BSD-3-Clause
"""Networks of two layers of rectifiers: what their training has in common. filters/src/networks/mlp.h computes them."""
import sys

try:
    import numpy as np
except ImportError:
    sys.exit(f"networks are trained with numpy (apt-get install python3-numpy): not in {sys.executable}")


class Rectifiers:
    """weights: matrices of the first layer (inputs, first), one for each of `parts` sets of figures, bias; second layer
    (first, second), bias; last layer (second, 1)"""

    def __init__(self, figures, parts, sizes, random, most=1_000_000):
        """figures (N, inputs): of about `most` of them the limits and the scale are taken"""
        # The extreme thousandths do not count: what was not seen in training is as what was.
        some = figures[::max(1, len(figures) // most)]
        self.lowest, self.highest = np.quantile(some, [0.001, 0.999], axis=0).astype(np.float32)
        within = np.clip(some, self.lowest, self.highest)
        self.mean, self.scale = within.mean(0), np.maximum(within.std(0), 1e-6)
        self.parts, (first, second), inputs = parts, sizes, figures.shape[1]
        self.weights = [random.normal(0, np.sqrt(1 / inputs), (inputs, first)) for _ in range(parts)] + [
            np.zeros(first), random.normal(0, np.sqrt(2 / first), (first, second)), np.zeros(second),
            random.normal(0, 0.1, (second, 1))]
        self.weights = [w.astype(np.float32) for w in self.weights]
        self.steps, self.means, self.squares = 0, None, None

    def scaled(self, figures):
        return (np.clip(figures, self.lowest, self.highest) - self.mean) / self.scale

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

    def write(self, path, names, writer):
        """Weights for figures as they come, as a header. names: of the matrices of the first layer"""
        matrices = [w / self.scale[:, None] for w in self.weights[:self.parts]]
        bias = self.weights[self.parts] - self.mean @ sum(matrices)
        values = list(zip(
            ["lowest", "highest"] + names + ["first_bias", "second_weights", "second_bias", "last_weights", "last_bias"],
            [self.lowest, self.highest] + matrices + [bias] + self.weights[self.parts + 1:]))
        inputs, (first, second) = len(self.scale), self.weights[self.parts + 1].shape
        name = "".join(word.capitalize() for word in path.split("/")[-1].split(".")[0].split("_"))
        lines = ["// SPDX-License-Identifier: BSD-3-Clause", f"// Written by benchmark/{writer}.", "#pragma once",
                 "namespace fresco {", "// clang-format off", f"struct {name} {{",
                 f"static constexpr int inputs = {inputs}, first = {first}, second = {second};"]
        for array, weights in values:
            flat = [f"{v:.5g}" for v in np.asarray(weights).ravel()]
            flat = [v + "f" if "." in v or "e" in v else v + ".f" for v in flat]
            lines.append(f"static constexpr float {array}[{len(flat)}] = {{")
            lines += ["  " + ", ".join(flat[i:i + 12]) + "," for i in range(0, len(flat), 12)]
            lines.append("};")
        lines += ["};", "// clang-format on", "} // namespace fresco", ""]
        with open(path, "w") as file:
            file.write("\n".join(lines))
