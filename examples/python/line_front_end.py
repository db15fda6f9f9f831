# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""A line front end on images of one's own: detect, describe, match.

    python line_front_end.py photo.jpg another.jpg
    python line_front_end.py              on two rendered images of a room

Writes lines.png: above the lines of both images by their octave, below the pairs.
"""
import argparse
import pathlib
import time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray
from PIL import Image

import plumbline

Gray = NDArray[np.uint8]


def read(path: pathlib.Path, longest: int = 1280) -> Gray:
    """An image in grey, not larger than it needs to be."""
    with Image.open(path) as image:
        gray = image.convert("L")
        gray.thumbnail((longest, longest))
        return np.array(gray)


def show_lines(axes: plt.Axes, image: Gray, lines: NDArray[np.void], title: str) -> None:
    axes.imshow(image, cmap="gray", vmin=0, vmax=255)
    for line in lines:
        ends = np.stack([line["start"], line["end"]])
        axes.plot(ends[:, 0], ends[:, 1], "-", lw=1.2, color=f"C{line['octave'] % 10}")
    axes.set(title=title)
    axes.axis("off")


def show_pairs(axes: plt.Axes, images: list[Gray], lines: list[NDArray[np.void]],
               matches: NDArray[np.int64]) -> None:
    rows = max(image.shape[0] for image in images)
    both = [np.pad(image, ((0, rows - image.shape[0]), (0, 0))) for image in images]
    axes.imshow(np.hstack(both), cmap="gray", vmin=0, vmax=255)
    shift = np.array([images[0].shape[1], 0])
    for i, (a, b, _) in enumerate(matches):
        for line, offset in ((lines[0][a], 0 * shift), (lines[1][b], shift)):
            ends = np.stack([line["start"], line["end"]]) + offset
            axes.plot(ends[:, 0], ends[:, 1], "-", lw=1.5, color=f"C{i % 10}")
    axes.set(title=f"{len(matches)} pairs, each of one colour")
    axes.axis("off")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("images", nargs="*", type=pathlib.Path, help="two images of one place")
    parser.add_argument("--detector", default="drawing", help="drawing, lsd or edlines")
    parser.add_argument("--count", type=int, default=200, help="lines an image")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."))
    arguments = parser.parse_args()
    if len(arguments.images) not in (0, 2):
        parser.error(f"expected two images or none, found {len(arguments.images)}")
    if arguments.images:
        images = [read(path) for path in arguments.images]
    else:
        world = plumbline.Synth("room", frames=2, rate_hz=4, samples=2)
        images = [world[0].left, world[1].left]

    begin = time.perf_counter()
    lines = [plumbline.detect_lines(image, count=arguments.count, detector=arguments.detector)
             for image in images]
    milliseconds = 1e3 * (time.perf_counter() - begin) / 2
    # The tests of place suit images of near viewpoints; 0 switches them off for others.
    matches = plumbline.match_lines(lines[0], lines[1], max_shift_px=0, max_offset_px=200)
    print(f"{len(lines[0])} and {len(lines[1])} lines, {milliseconds:.1f} ms an image with their "
          f"descriptors; {len(matches)} pairs")
    longest = max(lines[0], key=lambda line: float(np.linalg.norm(line["end"] - line["start"])))
    print(f"the longest: {longest['start'].round(1)} to {longest['end'].round(1)}, its ends known to "
          f"{longest['sigma_px']:.2f} px across it")

    figure = plt.figure(figsize=(12, 9), layout="constrained")
    grid = figure.add_gridspec(2, 2)
    for i in range(2):
        show_lines(figure.add_subplot(grid[0, i]), images[i], lines[i], f"{len(lines[i])} lines")
    show_pairs(figure.add_subplot(grid[1, :]), images, lines, matches)
    arguments.out.mkdir(parents=True, exist_ok=True)
    figure.savefig(arguments.out / "lines.png", dpi=120)
    print(f"written: {arguments.out / 'lines.png'}")


if __name__ == "__main__":
    main()
