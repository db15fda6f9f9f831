# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Good line cutting explained: figures 1 to 4 of Y. Zhao and P. A. Vela (ECCV 2018), made anew.

Of each 3D line only the piece is used that makes the pose best known: far ends are uncertain, and a
solver that trusts all residuals alike is better off without them. docs/methods/line-cutting.md has the
derivation, what is wrong in print, and why a solver with the right covariances gains nothing.

    python cutting_explained.py           writes cutting.png
"""
import argparse
import pathlib
from dataclasses import dataclass

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import plumbline

Doubles = NDArray[np.float64]
CAMERA = plumbline.RectifiedCamera(500, 500, 320, 240, 640, 480, baseline=1)
HALF = np.array([1.5, 1.0, 0.75])  # of the cuboid, m


@dataclass
class Scene:
    """Lines in the camera's frame, as a program knows them: with the errors of their ends."""
    segments: Doubles  # (N, 2, 3)
    covariances: Doubles  # (N, 2, 3, 3)
    measured: Doubles  # (N, 2, 2)

    def information(self, ratios: Doubles | None = None) -> Doubles:
        return plumbline.pose_information(CAMERA, self.segments, self.covariances, self.measured, ratios)

    def log_det(self, ratios: Doubles | None = None) -> float:
        return float(np.linalg.slogdet(self.information(ratios))[1])


def project(points: Doubles) -> Doubles:
    pixels = points @ CAMERA.K.T
    return pixels[..., :2] / pixels[..., 2:]


def measure(rng: np.random.Generator, true: Doubles, noise: float) -> Scene:
    """Ends with errors in column, row and inverse depth; the image lines with errors of 1 px."""
    flat = true.reshape(-1, 3)
    pixels = project(flat) + rng.normal(0, noise * CAMERA.fx, (len(flat), 2))
    inverse_depth = np.maximum(1 / flat[:, 2] + rng.normal(0, noise, len(flat)), 0.02)
    rays = np.hstack([(pixels - CAMERA.K[:2, 2]) / CAMERA.fx, np.ones((len(flat), 1))])
    ends = rays / inverse_depth[:, None]
    # With a baseline of 1 m disparities are inverse depths times the focal length.
    covariances = plumbline.covariance_from_disparity(
        CAMERA, ends, sigma_px=noise * CAMERA.fx, sigma_disparity_px=noise * CAMERA.fx)
    return Scene(ends.reshape(true.shape), covariances.reshape(-1, 2, 3, 3),
                 project(true) + rng.normal(0, 1, (len(true), 2, 2)))


def cuboid(rng: np.random.Generator, count: int) -> Doubles:
    """Edges and chords of a cuboid around the origin."""
    edges = []
    for axis in range(3):
        for corner in range(4):
            start = -HALF * [1, 1, 1]
            start[(axis + 1) % 3] *= 1 - 2 * (corner & 1)
            start[(axis + 2) % 3] *= 1 - (corner & 2)
            end = start.copy()
            end[axis] *= -1
            edges.append([start, end])
    lines = np.array(edges)[rng.permutation(12)]
    while len(lines) < count:
        chord = rng.uniform(-HALF, HALF, (1, 2, 3))
        axis = rng.integers(3)
        chord[..., axis] = rng.choice([-1, 1]) * HALF[axis]
        if np.linalg.norm(chord[0, 1] - chord[0, 0]) > 0.5:
            lines = np.concatenate([lines, chord])
    return lines[:count]


def look(rng: np.random.Generator, lines: Doubles, centre: Doubles, at: Doubles) -> Doubles:
    """The lines in the frame of a camera at a centre that looks at a point, rolled at random."""
    z = (at - centre) / np.linalg.norm(at - centre)
    x = np.cross(z, rng.normal(size=3))
    x /= np.linalg.norm(x)
    return (lines - centre) @ np.stack([x, np.cross(z, x), z]).T


def random_scene(rng: np.random.Generator, lines: int, noise: float) -> Scene:
    direction = rng.normal(size=3)
    centre = rng.uniform(3.5, 6) * direction / np.linalg.norm(direction)
    return measure(rng, look(rng, cuboid(rng, lines), centre, 0.2 * rng.normal(size=3)), noise)


def edge_scene(rng: np.random.Generator, angle: float, noise: float) -> Scene:
    """The first line is an edge, seen at an angle (radians) to the optical axis."""
    lines = cuboid(rng, 10)
    lines[0] = [-HALF, HALF * [1, -1, -1]]
    outwards = np.array([0, -1, -1]) / np.sqrt(2)
    away = np.cos(angle) * np.array([1, 0, 0]) + np.sin(angle) * outwards
    centre = lines[0].mean(axis=0) + 4 * away + 0.3 * outwards
    return measure(rng, look(rng, lines, centre, centre - away), noise)


def cut_one(scene: Scene, line: int = 0) -> Doubles:
    """The best piece of one line while all others stay whole."""
    rest = np.delete(np.arange(len(scene.segments)), line)
    others = Scene(scene.segments[rest], scene.covariances[rest], scene.measured[rest]).information()
    return plumbline.cut_lines(CAMERA, scene.segments[[line]], scene.covariances[[line]],
                               scene.measured[[line]], other_information=others)["ratios"][0]


def surface(scene: Scene, line: int, steps: int) -> Doubles:
    """log det over the two ratios of one line; NaN below the diagonal."""
    grid = np.linspace(0, 1, steps + 1)
    values = np.full((len(grid), len(grid)), np.nan)
    ratios = np.tile([0.0, 1.0], (len(scene.segments), 1))
    for i, first in enumerate(grid):
        for k, second in enumerate(grid[i:], i):
            ratios[line] = first, second
            values[k, i] = scene.log_det(ratios)
    return values


def ellipse(covariance: Doubles) -> Doubles:
    """Of one standard deviation: two columns of points."""
    values, axes = np.linalg.eigh(covariance)
    turn = np.linspace(0, 2 * np.pi, 60)
    return (np.stack([np.cos(turn), np.sin(turn)]).T * np.sqrt(values)) @ axes.T


def figure_1(axes: NDArray[np.object_]) -> None:
    """Lines from above with the uncertainty of their points, and that of the camera's place. Five: the
    pose has six unknowns and a line two residuals, so that of three lines nothing can be spared."""
    rng = np.random.default_rng(1)
    true = np.array([[[-2, -0.6, 3], [-1, 0.2, 9]], [[0.6, 0.5, 3.5], [2.6, -0.5, 10]],
                     [[-1.2, 0.8, 4], [1.6, -0.9, 4.6]], [[-0.4, -1.2, 2.5], [0.8, -1.5, 8]],
                     [[-1.5, 1.2, 3], [-0.2, 1.0, 7.5]]], dtype=float)
    scene = measure(rng, true, 0.012)
    whole = np.tile([0.0, 1.0], (len(true), 1))
    cut = plumbline.cut_lines(CAMERA, scene.segments, scene.covariances, scene.measured)["ratios"]
    for axis, ratios, name in ((axes[0], whole, "whole lines"), (axes[1], cut, "cut lines")):
        for i, (start, end) in enumerate(scene.segments):
            axis.plot(*np.stack([start, end])[:, [0, 2]].T, color="0.8", lw=1)
            for ratio in np.linspace(ratios[i, 0], ratios[i, 1], 5):
                point = (1 - ratio) * start + ratio * end
                covariance = ((1 - ratio)**2 * scene.covariances[i, 0]
                              + ratio**2 * scene.covariances[i, 1])[np.ix_([0, 2], [0, 2])]
                axis.plot(*(point[[0, 2]] + ellipse(covariance)).T, color="tab:red", lw=0.7)
            piece = [(1 - r) * start + r * end for r in ratios[i]]
            axis.plot(*np.stack(piece)[:, [0, 2]].T, "o-", color="tab:red", ms=2)
        pose = np.linalg.inv(scene.information(ratios))[3:, 3:][np.ix_([0, 2], [0, 2])]
        axis.plot(*(10 * ellipse(pose)).T, color="tab:blue")
        axis.set(title=f"1: {name}, log det {scene.log_det(ratios):.1f}\n"
                       "(blue: camera's place, 10 times)", xlabel="x [m]", ylabel="z [m]",
                 xlim=(-4, 6), ylim=(-3, 13))


def figure_2(axis: plt.Axes, scenes: int) -> None:
    """The best piece of an edge as the camera goes around it."""
    angles = np.arange(0, 91, 10)
    ratios = np.array([[cut_one(edge_scene(np.random.default_rng(100 + s), np.radians(angle), 0.005))
                        for s in range(scenes)] for angle in angles])
    for end, colour, shift in ((0, "tab:blue", -1.2), (1, "tab:red", 1.2)):
        boxes = axis.boxplot(list(ratios[..., end]), positions=angles + shift, widths=2,
                             manage_ticks=False, showfliers=False)
        for box in boxes["boxes"] + boxes["medians"]:
            box.set_color(colour)
    axis.set(title="2: best ratios of an edge (blue first, red second)", xticks=angles,
             xlabel="optical axis to edge [deg]", ylabel="ratio")


def figure_3(axes: NDArray[np.object_], steps: int) -> None:
    """log det by the ratios of a line: three lines of which whole, a part and a point is best."""
    wanted = {"whole": lambda a, b: b - a > 0.98, "a part": lambda a, b: 0.1 < b - a < 0.9,
              "a point": lambda a, b: b - a < 0.01}
    found: dict[str, tuple[Scene, int]] = {}
    for seed in range(400):
        scene = random_scene(np.random.default_rng(seed), 6, 0.005)
        for line in range(6):
            first, second = cut_one(scene, line)
            for name, fits in wanted.items():
                if name not in found and fits(first, second):
                    found[name] = scene, line
        if len(found) == len(wanted):
            break
    for axis, name in zip(axes, wanted):
        if name not in found:
            axis.set(title=f"3: {name} (none found)")
            continue
        scene, line = found[name]
        axis.imshow(surface(scene, line, steps), origin="lower", extent=(0, 1, 0, 1), aspect="equal")
        axis.plot(*cut_one(scene, line), "x", color="red", ms=10, mew=2)
        axis.set(title=f"3: {name} is best", xlabel="first ratio", ylabel="second ratio")


def figure_4(axis: plt.Axes, scenes: int) -> None:
    """What cutting all lines gains, by their number."""
    counts = (8, 15, 30)
    gains = []
    for seed in range(scenes):
        drawn = [random_scene(np.random.default_rng(1000 + seed), count, 0.005) for count in counts]
        cuts = [plumbline.cut_lines(CAMERA, scene.segments, scene.covariances, scene.measured)
                for scene in drawn]
        gains.append([cut["log_det_cut"] - cut["log_det_whole"] for cut in cuts])
    axis.boxplot(np.array(gains), labels=counts)
    axis.set(title=f"4: gain, {scenes} scenes", xlabel="lines", ylabel="log det")
    for count, gain in zip(counts, np.mean(gains, axis=0)):
        print(f"{count} lines: log det grows by {gain:.2f} on average")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", type=int, default=60, help="scenes of each box plot")
    parser.add_argument("--steps", type=int, default=50, help="of the surfaces, along each ratio")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."))
    arguments = parser.parse_args()
    figure = plt.figure(figsize=(15, 9), layout="constrained")
    grid = figure.add_gridspec(2, 12)
    figure_1(np.array([figure.add_subplot(grid[0, 0:3]), figure.add_subplot(grid[0, 3:6])]))
    figure_2(figure.add_subplot(grid[0, 6:12]), arguments.scenes)
    figure_3(np.array([figure.add_subplot(grid[1, 3 * i:3 * i + 3]) for i in range(3)]),
             arguments.steps)
    figure_4(figure.add_subplot(grid[1, 9:12]), arguments.scenes)
    arguments.out.mkdir(parents=True, exist_ok=True)
    figure.savefig(arguments.out / "cutting.png", dpi=110)
    print(f"written: {arguments.out / 'cutting.png'}")


if __name__ == "__main__":
    main()
