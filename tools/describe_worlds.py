#!/usr/bin/python3
"""Renders each world of `plumbline synth` coarsely and prints the table of lab/notes/worlds.md.

    tools/describe_worlds.py [--program build/release/plumbline] [--only NAME] [--frames 40]
                             [--pictures FOLDER]

Each world is rendered at half size with FRAMES frames spread over its whole path (seed 1). Printed are
the frames of the whole path at 20 Hz, its length and duration, the highest speed and turn rate (over
0.1 s), how close the path comes to a surface that stands still, the number of surfaces, the number of true
lines by kind and the mean number of lines seen in a frame. --pictures writes a frame a third of the way
along as FOLDER/NAME.jpg. Needs numpy; Pillow for the pictures.
"""
import argparse
import csv
import math
import pathlib
import re
import subprocess
import tempfile

import numpy as np


def worlds(program):
    text = subprocess.run([program, "synth", "--list"], check=True, capture_output=True, text=True).stdout
    rows = text.split("worlds:\n")[1].split("\n\n")[0].splitlines()
    return [tuple(part.strip() for part in row.strip().split(maxsplit=1)) for row in rows]


def rows_of(path):
    with open(path, newline="") as file:
        return [row for row in csv.reader(file) if row and not row[0].startswith("#")]


def duration(program, world):
    """Seconds of the whole path."""
    text = subprocess.run([program, "synth", world, "--list"], check=True, capture_output=True,
                          text=True).stdout
    return float(re.search(r"whole path takes ([0-9.]+) s", text).group(1))


def render(program, world, out, settings):
    command = [program, "synth", world, "--out", str(out), "--set", "scale=0.5", "--set", "shutter_ms=0",
               "--set", "readout_ms=0"]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run(command, check=True, capture_output=True)


def turn(a, b):
    return 2 * math.acos(min(1.0, abs(float(np.dot(a, b)))))


def closest(positions, surfaces):
    best = math.inf
    for surface in surfaces:
        origin, u, v = surface[:3], surface[3:6], surface[6:9]
        offset = positions - origin
        a = np.clip(offset @ u / (u @ u), 0, 1)
        b = np.clip(offset @ v / (v @ v), 0, 1)
        nearest = origin + a[:, None] * u + b[:, None] * v
        best = min(best, float(np.linalg.norm(positions - nearest, axis=1).min()))
    return best


def seen_in(text):
    count = 0
    for part in text.split():
        first, _, last = part.partition("-")
        count += int(last or first) - int(first) + 1
    return count


def describe(program, world, frames, pictures):
    seconds = duration(program, world)
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / world
        render(program, world, out, [f"rate_hz={frames / seconds}"])
        truth = rows_of(out / "mav0/state_groundtruth_estimate0/data.csv")
        stamps = np.array([int(row[0]) for row in truth]) * 1e-9
        positions = np.array([[float(x) for x in row[1:4]] for row in truth])
        turns = np.array([[float(x) for x in row[4:8]] for row in truth])
        lines = rows_of(out / "lines.csv")
        surfaces = np.array([[float(x) for x in row] for row in rows_of(out / "surfaces.csv")])
        images = sorted((out / "mav0/cam0/data").iterdir())
        if pictures:
            from PIL import Image
            pictures.mkdir(parents=True, exist_ok=True)
            Image.open(images[len(images) // 3]).save(pictures / f"{world}.jpg", quality=80)
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    stride = max(1, round(0.1 / float(np.median(np.diff(stamps)))))
    spans = stamps[stride:] - stamps[:-stride]
    speeds = np.linalg.norm(positions[stride:] - positions[:-stride], axis=1) / spans
    rates = [turn(turns[i], turns[i + stride]) / spans[i] for i in range(0, len(spans), stride)]
    kinds = {kind: sum(row[6] == kind for row in lines) for kind in ("geometry", "texture", "shadow")}
    per_frame = sum(seen_in(row[7]) for row in lines) / len(images)
    return [f"`{world}`", f"{round(seconds * 20)}", f"{seconds:.0f}", f"{steps.sum():.1f}",
            f"{speeds.max():.2f}", f"{max(rates):.2f}",
            f"{closest(positions[::max(1, stride // 2)], surfaces):.2f}", f"{len(surfaces)}",
            f"{kinds['geometry']} / {kinds['texture']} / {kinds['shadow']}", f"{per_frame:.0f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--program", default="build/release/plumbline")
    parser.add_argument("--only")
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--pictures", type=pathlib.Path)
    arguments = parser.parse_args()
    print("| world | frames at 20 Hz | duration [s] | path [m] | most m/s | most rad/s | closest [m] | "
          "surfaces | lines: geometry / texture / shadow | seen in a frame |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for world, _ in worlds(arguments.program):
        if arguments.only and arguments.only not in world:
            continue
        print("| " + " | ".join(describe(arguments.program, world, arguments.frames, arguments.pictures))
              + " |", flush=True)


if __name__ == "__main__":
    main()
