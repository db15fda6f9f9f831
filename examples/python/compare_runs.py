# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Comparing two ways of running, with confidence intervals: points alone against points and lines.

    python compare_runs.py data/MH_01_easy --runs 5
    python compare_runs.py                on a rendered room

A run repeats to the last bit, so that a second one tells nothing. Runs differ by seed and first frame:
run k has seed k and starts at frame k - 1. Two questions, two intervals:

- Of one run of each: are the errors of its frames smaller? Neighbouring frames err alike, so that not
  frames but blocks of them are drawn anew (moving-block bootstrap, Kuensch 1989), the same for both.
- Of several runs of each: would further runs say the same? Student's interval of the logarithms of
  the ratios of the pairs of runs.

An interval of the ratio that contains 1 says that this sequence does not tell the two apart. It says
nothing about other sequences: those are drawn by whoever chose them.

Writes comparison.png.
"""
import argparse
import pathlib
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import plumbline

Doubles = NDArray[np.float64]
VARIANTS: dict[str, dict[str, Any]] = {"points": {"features": {"lines": False}},
                                       "points and lines": {}}
DRAWS = 2000
# Quantiles of 97.5 % of Student's distribution for 1, 2, ... degrees of freedom; more have narrower ones.
STUDENT = [12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228]


def position_errors(dataset: plumbline.Dataset, k: int,
                    variant: str) -> tuple[NDArray[np.int64], Doubles]:
    """Stamps and errors [m] of the poses of run k, after alignment."""
    options: dict[str, Any] = VARIANTS[variant] | {"slam": {"seed": k}}
    run = plumbline.run(dataset, start=k - 1, **options)
    if run.errors is None:
        raise SystemExit(f"compare_runs: {dataset.name} has no ground truth for run {k} of {variant}")
    return run.errors["stamps_ns"], run.errors["position_errors"]


def rmse(errors: Doubles) -> Doubles:
    return np.sqrt(np.mean(np.square(errors), axis=-1))


def interval(draws: Doubles) -> tuple[float, float]:
    """The middle 95 %."""
    low, high = np.percentile(draws, [2.5, 97.5])
    return float(low), float(high)


def correlation_length(errors: Doubles) -> int:
    """Frames after which the correlation of errors has fallen below 1/e: how long blocks must be."""
    centred = errors - errors.mean()
    correlation = np.correlate(centred, centred, "full")[len(errors) - 1:]
    below = np.flatnonzero(correlation < correlation[0] / np.e)
    return int(below[0]) if len(below) else len(errors)


def ratio_of_two(a: Doubles, b: Doubles, rng: np.random.Generator) -> tuple[float, float, float]:
    """RMSE of b over that of a on the same frames, with the interval of a block bootstrap."""
    length = min(len(a) // 2, 2 * max(correlation_length(a), correlation_length(b)))
    count = -(-len(a) // length)
    starts = rng.integers(0, len(a) - length + 1, (DRAWS, count))
    places = (starts[:, :, None] + np.arange(length)).reshape(DRAWS, -1)[:, :len(a)]
    return float(rmse(b) / rmse(a)), *interval(rmse(b[places]) / rmse(a[places]))


def ratio_of_many(a: Doubles, b: Doubles) -> tuple[float, float, float]:
    """Geometric mean of the ratios of pairs of runs, with Student's interval."""
    logs = np.log(b / a)
    half = STUDENT[min(len(logs) - 1, len(STUDENT)) - 1] * logs.std(ddof=1) / np.sqrt(len(logs))
    low, middle, high = np.exp(logs.mean() + [-half, 0, half])
    return float(middle), float(low), float(high)


def told(name: str, ratio: float, low: float, high: float) -> str:
    verdict = "no difference shown" if low <= 1 <= high else "a difference"
    return f"{name}: ratio {ratio:.3f}, 95 % interval {low:.3f} to {high:.3f}: {verdict}"


def plot(first: dict[str, tuple[NDArray[np.int64], Doubles]], rows: dict[str, Doubles],
         ratios: dict[str, tuple[float, float, float]], path: pathlib.Path) -> None:
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(14, 4), layout="constrained")
    begin = min(stamps[0] for stamps, _ in first.values())
    for name, (stamps, errors) in first.items():
        left.plot(1e-9 * (stamps - begin), 1e3 * errors, lw=1, label=name)
    left.set(title="run 1", xlabel="time [s]", ylabel="position error [mm]")
    left.legend()
    a, b = (1e3 * rows[name] for name in VARIANTS)
    for pair in zip(a, b):
        middle.plot([0, 1], pair, "o-", color="0.5")
    middle.set(title=f"{len(a)} pairs of runs", xticks=[0, 1], xticklabels=list(VARIANTS),
               ylabel="ATE [mm]", xlim=(-0.3, 1.3), ylim=(0, None))
    for i, (name, (ratio, low, high)) in enumerate(ratios.items()):
        right.errorbar(ratio, i, xerr=[[ratio - low], [high - ratio]], fmt="o", capsize=4)
    right.axvline(1, color="k", lw=0.8)
    right.set(title="error with lines over error without", yticks=range(len(ratios)),
              yticklabels=list(ratios), xlabel="ratio, 95 % interval", ylim=(-0.5, len(ratios) - 0.5))
    figure.savefig(path, dpi=120)
    plt.close(figure)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("path", nargs="?", type=pathlib.Path, help="default: a rendered room")
    parser.add_argument("--runs", type=int, default=3, help="of each variant")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."))
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    path = arguments.path
    if path is None:
        path = arguments.out / "room"
        if not path.exists():
            plumbline.render("room", path, frames=40, scale=0.5)
    dataset = plumbline.open(path)

    runs = {name: [position_errors(dataset, k, name) for k in range(1, arguments.runs + 1)]
            for name in VARIANTS}
    ates = {name: np.array([rmse(errors) for _, errors in of]) for name, of in runs.items()}
    for name, values in ates.items():
        print(f"{name}: ATE {', '.join(f'{1e3 * value:.2f}' for value in values)} mm")

    rng = np.random.default_rng(1)
    first = {name: of[0] for name, of in runs.items()}
    (stamps_a, a), (stamps_b, b) = first.values()
    _, in_a, in_b = np.intersect1d(stamps_a, stamps_b, return_indices=True)
    ratios = {"frames of run 1": ratio_of_two(a[in_a], b[in_b], rng)}
    if arguments.runs > 1:
        ratios["runs"] = ratio_of_many(*ates.values())
    for name, ratio in ratios.items():
        print(told(name, *ratio))
    plot(first, ates, ratios, arguments.out / "comparison.png")
    print(f"written: {arguments.out / 'comparison.png'}")


if __name__ == "__main__":
    main()
