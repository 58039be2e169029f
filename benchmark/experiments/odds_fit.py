#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fits how probable places are (registration/src/answer/odds.cpp): odds_fit.py FLOOR... [-check FLOOR...].

FLOOR: poses.txt (the truth) and registered/registration.json, as office_floors.py leaves them. Examples are all candidates
and links. Of one group's candidates beside another group one at most is right: a multinomial logistic regression with the
outcome that none is, by scipy's BFGS, weights tied to zero. The largest claim is the best rate of right ones, by
Laplace's rule of succession, among any number of the surest examples. Prints the numbers of the model, and of claims in bins
the share that is right; with -check also of floors that nothing is fitted to."""
import argparse
import json

import numpy as np
from office_floors import FALSE_DEGREES, FALSE_DISTANCE, degrees, read_poses
from scipy.optimize import minimize

MENDED_DISTANCE, MENDED_DEGREES = 0.3, 6.0  # a candidate is not refined: what is nearer becomes right once it is joined
PRIOR = 3.0  # standard deviation of each weight but the constant, about zero
BINS = [0, 0.1, 0.5, 0.7, 0.9, 0.97, 0.99, 1.01]


class Examples:
    """One row per place: its signs, whether it is right, and the number of the choice that it is part of."""

    def __init__(self, folders):
        self.signs, self.right, self.choice = [], [], []
        for folder in folders:
            self.add(folder, json.load(open(folder + "/registered/registration.json")), read_poses(folder + "/poses.txt"))
        self.signs, self.right = np.array(self.signs, float), np.array(self.right, bool)
        self.joined = self.signs[:, 4] > 0
        self.choice = np.unique(self.choice, return_inverse=True)[1]

    def add(self, folder, report, truth):
        group = [scan["group"] for scan in report["scans"]]
        found = [pair["violation"] for pair in report["pairs"] if pair["accepted"]]
        usual = sum(found) / max(1, len(found))
        for joined, list_ in ((0, report["candidates"]), (1, report["links"])):
            for k, place in enumerate(list_):
                a, b = place["beside"], place["scan"]
                D = np.linalg.inv(np.linalg.inv(truth[a]) @ truth[b]) @ self.pose(report, place, joined)
                most = (FALSE_DISTANCE, FALSE_DEGREES) if joined else (MENDED_DISTANCE, MENDED_DEGREES)
                self.right.append(np.linalg.norm(D[:3, 3]) < most[0] and degrees(D[:3, :3]) < most[1])
                u = np.log1p(1000 * max(0, place["contradict"] - 2 * usual * place["agree"]))
                self.signs.append([1, place["agree"] / (1 + place["agree"]), place["overlap"] ** 4, u, joined, joined * u])
                self.choice.append(f"{folder} {joined} {k if joined else (group[a], group[b])}")

    def pose(self, report, place, joined):
        if not joined:
            return np.array(place["pose"])
        a, b = (np.array(report["scans"][place[end]]["pose_in_group"]) for end in ("beside", "scan"))
        return np.linalg.inv(a) @ b

    def claims(self, weights):
        odds = np.exp(np.clip(self.signs @ weights, -50, 50))
        return odds / (1 + np.bincount(self.choice, odds)[self.choice])


def loss(weights, data):
    """Negative logarithm of the likelihood of which place of each choice is right, and of the prior."""
    claims, n = data.claims(weights), data.choice.max() + 1
    right = np.bincount(data.choice, claims * data.right, n)
    none = 1 - np.bincount(data.choice, claims, n)
    known = np.bincount(data.choice, data.right, n) > 0
    return -np.log(np.maximum(np.where(known, right, none), 1e-300)).sum() + ((weights[1:] / PRIOR) ** 2).sum() / 2


def largest_claim(claims, right):
    surest = right[np.argsort(-claims, kind="stable")]
    return ((np.cumsum(surest) + 1) / (np.arange(len(surest)) + 3)).max()


def area(claims, right):
    """Under the curve of right over wrong ones: how often a right place has the higher claim."""
    wrong = claims[~right]
    return np.mean([(claim > wrong).mean() + (claim == wrong).mean() / 2 for claim in claims[right]]) if len(wrong) else 1.0


def report(name, claims, data):
    for kind, of in (("candidates", ~data.joined), ("links", data.joined)):
        right = data.right[of]
        print(f"{name}, {kind}: {right.sum()} of {len(right)} right, area under the curve {area(claims[of], right):.3f}")
        for low, high in zip(BINS, BINS[1:]):
            within = (claims[of] >= low) & (claims[of] < high)
            if within.any():
                print(f"  claimed {low} to {min(high, 1)}, mean {claims[of][within].mean():.3f}: "
                      f"{right[within].sum()} of {within.sum()}, {right[within].mean():.3f} right")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("floors", nargs="+")
    parser.add_argument("-check", nargs="*", default=[], help="floors that nothing is fitted to")
    args = parser.parse_args()
    data = Examples(args.floors)
    weights = minimize(loss, np.zeros(data.signs.shape[1]), data).x
    most = largest_claim(data.claims(weights), data.right)
    print("{" + ", ".join(f"{value:.4g}" for value in (*weights, most)) + "}")
    report("fitted", np.minimum(data.claims(weights), most), data)
    if args.check:
        check = Examples(args.check)
        report("not fitted", np.minimum(check.claims(weights), most), check)


if __name__ == "__main__":
    main()
