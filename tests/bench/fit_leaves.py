#!/usr/bin/env python3
"""Fits the two networks that tell leaves from wood (src/scan/leaves/leaf_classifier.h), and then the rule that
takes branches back that were grown through leaves (src/skeleton/twigs/leaf_twigs.h).

usage: fit_leaves.py BENCHMARKS [--seeds N] [--bare SCAN...] [--labelled SCAN...] [--out FOLDER]
       fit_leaves.py --twigs BENCHMARKS [--seeds N] [--out FOLDER]

BENCHMARKS is what './dev bench' builds. It grows trees, scans them, and prints what the networks know of
their points; --bare names real scans without leaves, --labelled such whose points say which they are (a
column "leaf"). Every scan is judged by networks that were fitted to the other half of the scans; the figures
printed are of that. The weights written, to src/scan/leaves or FOLDER, are fitted to all. --twigs fits the rule
alone, which depends on what the networks that BENCHMARKS was built with leave to follow.
"""

import argparse
import glob
import os
import subprocess
import sys
import tempfile

import numpy as np

FIRST, SECOND = 32, 16  # units, as in leaf_network.h
REACH = 3.0  # standard deviations, likewise
EPOCHS, BATCH, RATE, DECAY = 25, 2048, 2e-3, 1e-3


class Scan:
    def __init__(self, path):
        kind, number, self.name = os.path.basename(path)[:-4].split(" ", 2)
        self.real, self.odd = kind == "real", int(number) % 2 == 1
        rows = np.fromfile(path, np.float32)
        self.number = int(number)
        self.rows = rows

    def shape(self, width):
        self.inputs = self.rows.reshape(-1, width + 1)[:, :width]
        self.leaf = self.rows.reshape(-1, width + 1)[:, width]
        return self


def read(folder, width):
    return sorted((Scan(p).shape(width) for p in glob.glob(folder + "/*.bin")), key=lambda s: s.number)


def fit(scans, seed=1):
    """The weights as LeafNetwork takes them. Scans count alike, and leaves as much as wood."""
    rng = np.random.default_rng(seed)
    x = np.concatenate([s.inputs for s in scans])
    y = np.concatenate([s.leaf for s in scans])
    w = np.concatenate([np.full(len(s.leaf), 1.0 / len(s.leaf)) for s in scans])
    w *= np.where(y > 0.5, 0.5 / w[y > 0.5].sum(), 0.5 / w[y <= 0.5].sum()) * len(w)
    mean = x.mean(0)
    deviation = np.maximum(x.std(0), 1e-4)
    x = np.clip((x - mean) / deviation, -REACH, REACH).astype(np.float32)
    sizes = [x.shape[1], FIRST, SECOND, 1]
    layers = []
    for a, b in zip(sizes, sizes[1:]):
        layers.append(rng.normal(0, np.sqrt(2.0 / a), (a, b)).astype(np.float32))
        layers.append(np.zeros(b, np.float32))
    m = [np.zeros_like(p) for p in layers]
    v = [np.zeros_like(p) for p in layers]
    step, steps = 0, EPOCHS * (len(x) // BATCH + 1)
    for _ in range(EPOCHS):
        order = rng.permutation(len(x))
        for begin in range(0, len(x), BATCH):
            i = order[begin : begin + BATCH]
            a0 = x[i]
            a1 = np.maximum(a0 @ layers[0] + layers[1], 0)
            a2 = np.maximum(a1 @ layers[2] + layers[3], 0)
            z = (a2 @ layers[4] + layers[5])[:, 0]
            g = ((1 / (1 + np.exp(-np.clip(z, -30, 30))) - y[i]) * w[i] / len(i)).astype(np.float32)[:, None]
            g2 = (g @ layers[4].T) * (a2 > 0)
            g1 = (g2 @ layers[2].T) * (a1 > 0)
            grads = [a0.T @ g1, g1.sum(0), a1.T @ g2, g2.sum(0), a2.T @ g, g.sum(0)]
            step += 1
            rate = RATE * 0.5 * (1 + np.cos(np.pi * step / steps)) + 1e-5
            for k, (p, d) in enumerate(zip(layers, grads)):
                m[k] = 0.9 * m[k] + 0.1 * d
                v[k] = 0.999 * v[k] + 0.001 * d * d
                p -= rate * (
                    m[k] / (1 - 0.9**step) / (np.sqrt(v[k] / (1 - 0.999**step)) + 1e-8) + DECAY * p
                )
    return [mean, deviation] + layers


def logits(weights, x):
    mean, deviation, *layers = weights
    x = np.clip((x - mean) / deviation, -REACH, REACH)
    x = np.maximum(x @ layers[0] + layers[1], 0)
    x = np.maximum(x @ layers[2] + layers[3], 0)
    return (x @ layers[4] + layers[5])[:, 0]


def write(path, weights, suffix="F"):
    flat = np.concatenate([np.asarray(p).ravel() for p in weights])
    words = []
    for value in flat:
        word = f"{value:.5g}"
        if suffix and "." not in word and "e" not in word:
            word += ".0"
        words.append(word + suffix)
    with open(path, "w") as file:
        if path.endswith(".inc"):
            file.write("// By tests/bench/fit_leaves.py; not to be edited.\n")
        for i in range(0, len(words), 10):
            file.write(", ".join(words[i : i + 10]) + (",\n" if i + 10 < len(words) else "\n"))


def area_under_curve(z, leaf):
    order = np.argsort(z, kind="stable")
    rank = np.empty(len(z))
    rank[order] = np.arange(1, len(z) + 1)
    n = leaf.sum()
    return (rank[leaf].sum() - n * (n + 1) / 2) / (n * (len(z) - n))


def report(title, scans, halves):
    """halves: fitted to even and to odd scans."""
    print(f"\n{title}, each scan by what was fitted to the other half:\n")
    print("| scans | number | wood told right % | leaves told right % | area under curve |")
    print("|---|---|---|---|---|")
    groups = {}
    for s in scans:
        z = logits(halves[0 if s.odd else 1], s.inputs)
        leaf = s.leaf > 0.5
        wood_right = (z[~leaf] <= 0).mean() if (~leaf).any() else np.nan
        leaf_right = (z[leaf] > 0).mean() if leaf.any() else np.nan
        area = area_under_curve(z, leaf) if leaf.any() and (~leaf).any() else np.nan
        row = (wood_right, leaf_right, area)
        if s.real:
            groups.setdefault(s.name, []).append(row)
            continue
        habit, noise, leaves = s.name.split(" ")
        kind = "in leaf" if float(leaves) > 0 else "bare"
        groups.setdefault(f"grown, {kind}, noise {100 * float(noise):g} cm", []).append(row)
        groups.setdefault(f"grown, {kind}, {habit}", []).append(row)
        groups.setdefault(f"grown, {kind}", []).append(row)
    for name, rows in sorted(groups.items()):
        means = [np.nanmean(c) if np.isfinite(c).any() else np.nan for c in np.array(rows).T]
        text = [f"{100 * means[0]:.1f}", f"{100 * means[1]:.1f}", f"{means[2]:.3f}"]
        print(f"| {name} | {len(rows)} | " + " | ".join("-" if t == "nan" else t for t in text) + " |")
    sys.stdout.flush()


def fit_logistic(scans, rounds=50, ridge=1e-3):
    """The weights of the plain looks and, last, the bias. Scans count alike, stretches by their length."""
    x = np.concatenate([s.inputs for s in scans]).astype(float)
    y = np.concatenate([s.right for s in scans]).astype(float)
    w = np.concatenate([s.length / s.length.sum() for s in scans]).astype(float)
    mean, deviation = x.mean(0), x.std(0) + 1e-9
    z = np.c_[(x - mean) / deviation, np.ones(len(x))]
    beta = np.zeros(z.shape[1])
    for _ in range(rounds):
        p = 1 / (1 + np.exp(-z @ beta))
        gradient = z.T @ ((y - p) * w) - ridge * w.sum() * beta
        hessian = (z * (p * (1 - p) * w)[:, None]).T @ z + ridge * w.sum() * np.eye(len(beta))
        beta += np.linalg.solve(hessian, gradient)
    return np.append(beta[:-1] / deviation, beta[-1] - (beta[:-1] * mean / deviation).sum())


def fit_twigs(folder, out):
    scans = []
    for path in glob.glob(folder + "/*.bin"):
        scan = Scan(path)
        rows = scan.rows.reshape(-1, TWIG_LOOKS + 2)
        if len(rows) == 0:
            continue  # it was not told to be in leaf
        scan.inputs, scan.length, scan.right = rows[:, :TWIG_LOOKS], rows[:, -2], rows[:, -1]
        scans.append(scan)
    scans.sort(key=lambda s: s.number)
    print("\nStretches of skeletons, each scan by what was fitted to the other half:\n")
    print("| least chance | of what is kept, wood % | of the wood, kept % |\n|---|---|---|")
    for least in (0.1, 0.16, 0.2, 0.3, 0.5):
        kept = right = wood = 0.0
        for odd in (False, True):
            weights = fit_logistic([s for s in scans if s.odd != odd])
            for s in (s for s in scans if s.odd == odd):
                p = 1 / (1 + np.exp(-(s.inputs @ weights[:-1] + weights[-1])))
                share = s.length / s.length.sum()
                kept += share[p > least].sum()
                right += (share * s.right)[p > least].sum()
                wood += (share * s.right).sum()
        print(f"| {least:g} | {100 * right / kept:.1f} | {100 * right / wood:.1f} |")
    write(out + "/leaf_twig_weights.inc", [fit_logistic(scans)], "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("benchmarks")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--bare", nargs="*", default=[])
    parser.add_argument("--labelled", nargs="*", default=[])
    parser.add_argument("--out", default="")
    parser.add_argument("--twigs", action="store_true")
    options = parser.parse_args()
    if options.twigs:
        with tempfile.TemporaryDirectory() as scratch:
            command = [options.benchmarks, "--twig-inputs", scratch, "--seeds", str(options.seeds)]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            fit_twigs(scratch, options.out or os.path.join(SOURCE, "skeleton/twigs"))
        return
    options.out = options.out or os.path.join(SOURCE, "scan/leaves")
    scans = options.bare + options.labelled

    def inputs_of(folder, extra):
        command = [options.benchmarks, "--leaf-inputs", folder, "--seeds", str(options.seeds), *extra, *scans]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)

    with tempfile.TemporaryDirectory() as scratch:
        inputs_of(scratch + "/point", [])
        points = read(scratch + "/point", POINT_INPUTS)
        halves = [fit([s for s in points if s.odd == odd]) for odd in (False, True)]
        report("By the points alone", points, halves)
        # Scans of odd numbers are seen by what was fitted to even ones.
        write(scratch + "/odd.txt", halves[0], "")
        write(scratch + "/even.txt", halves[1], "")
        point_weights = fit(points)
        inputs_of(scratch + "/context", ["--weights", scratch])
        contexts = read(scratch + "/context", CONTEXT_INPUTS)
        halves = [fit([s for s in contexts if s.odd == odd]) for odd in (False, True)]
        report("With what is around them", contexts, halves)
        write(options.out + "/leaf_point_weights.inc", point_weights)
        write(options.out + "/leaf_context_weights.inc", fit(contexts))


POINT_INPUTS, CONTEXT_INPUTS = 82, 21  # as in leaf_classifier.h
TWIG_LOOKS = 12  # as in leaf_twigs.h
SOURCE = os.path.join(os.path.dirname(__file__), "../../src")

if __name__ == "__main__":
    main()
