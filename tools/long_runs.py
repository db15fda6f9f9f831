#!/usr/bin/env python3
"""Checks that the time of a frame does not grow with the length of a run, and draws it.

Usage: long_runs.py BUILD WORK [FIGURE.svg]

BUILD is a build with the benchmarks (PLUMBLINE_BENCHMARKS), WORK a folder for the rendered rooms, which
is used again where it is there. Two kinds of runs, of 10 minutes each:

  a drive of 5 km at 30 km/h, below the front end (bench/large_map straight): CPU time of mapping a
  keyframe and of a snapshot, and of the adjustment at the end
  20 rounds of 30 s through the same rooms, 10 images a second at a quarter of the area
  (bench/rounds_of_a_room): CPU time of a frame, memory

Fails where mapping a keyframe or a frame takes more than 1.2 times as long at the end as after a minute.
"""
import pathlib
import re
import subprocess
import sys

from plot_ba_times import Chart, HEIGHT

MOST = 1.2
METRES_A_MINUTE = 500
KEYFRAMES = [500, 1000, 2500, 5000]  # a metre apart
ROUNDS = 20  # of half a minute


def run(*command):
    return subprocess.run([str(part) for part in command], check=True, stdout=subprocess.PIPE,
                          text=True).stdout


def drive(build):
    """Minute -> milliseconds of a keyframe, a snapshot and the end."""
    steps = run(build / "bench/large_map", "straight", "--steps", *KEYFRAMES)
    ends = run(build / "bench/large_map", "straight", "--end", *KEYFRAMES)
    mapped = re.findall(r"^  keyframe ([\d.]+) ms, snapshot ([\d.]+) ms", steps, re.M)
    adjusted = re.findall(r"^  adjustment, twice ([\d.]+) s", ends, re.M)
    assert len(mapped) == len(adjusted) == len(KEYFRAMES), steps + ends
    return {count / METRES_A_MINUTE: {"keyframe": float(keyframe), "snapshot": float(snapshot),
                                      "end": 1000 * float(end)}
            for count, (keyframe, snapshot), end in zip(KEYFRAMES, mapped, adjusted)}


def rooms(build, work):
    """Minute -> milliseconds of a frame and resident megabytes; every frame must be tracked."""
    office = work / "office"
    if not office.exists():
        run(build / "plumbline", "synth", "office", "--out", office, "--set", "frames=300",
            "--set", "rate_hz=10", "--set", "scale=0.5", "--set", "samples=1", "--set", "noise=0")
    return read_rooms(run(build / "bench/rounds_of_a_room", office, "--rounds", ROUNDS))


def read_rooms(table):
    """The mean of each minute of the rows that rounds_of_a_room prints."""
    lines = [[cell.strip() for cell in line.strip("| \n").split("|")] for line in table.splitlines()
             if line.startswith("|") and not line.startswith("|---")]
    rows = [dict(zip(lines[0], cells)) for cells in lines[1:]]
    for row in rows:
        tracked, frames = row["tracked"].split(" of ")
        if tracked != frames:
            sys.exit(f"long_runs.py: round {row['round']}: {row['tracked']} frames are tracked")
    pairs = [rows[i:i + 2] for i in range(0, len(rows) - 1, 2)]
    return {minute: {key: sum(float(row[name]) for row in pair) / 2
                     for key, name in [("frame", "frame"), ("memory", "RSS")]}
            for minute, pair in enumerate(pairs, 1)}


def draw(on_road, in_rooms):
    curves = [("mapping a keyframe [ms]", "#1f5fa8", "", on_road, "keyframe"),
              ("a snapshot [ms]", "#1f5fa8", "2 4", on_road, "snapshot"),
              ("the end [ms]", "#1f5fa8", "8 4", on_road, "end"),
              ("a frame in rooms [ms]", "#d95f02", "", in_rooms, "frame"),
              ("memory in rooms [MB]", "#d95f02", "8 4", in_rooms, "memory")]
    values = [row[key] for _, _, _, rows, key in curves for row in rows.values()]
    chart = Chart((1, 10), (min(values) / 1.5, max(values) * 1.5))
    chart.axes([1, 2, 3, 5, 10], "minutes", "CPU time [ms], memory [MB]")
    label_y = HEIGHT
    for legend, color, dash, rows, key in sorted(curves, key=lambda c: list(c[3].values())[-1][c[4]]):
        points = [(chart.x(minute), chart.y(row[key])) for minute, row in rows.items()]
        chart.line(points, color, 2, dash)
        label_y = min(points[-1][1] + 4, label_y - 15)
        chart.text(points[-1][0] + 8, label_y, legend, "start", color)
    return chart.svg("5 km of road below the front end, and 10 minutes in the same rooms")


def grows(name, rows, key, after):
    ratio = rows[max(rows)][key] / rows[after][key]
    print(f"{name}: {rows[after][key]:.1f} ms in minute {after:g}, {rows[max(rows)][key]:.1f} ms in "
          f"minute {max(rows):g}, {ratio:.2f} times (at most {MOST})")
    return ratio > MOST


def main(build, work, figure=None):
    build, work = pathlib.Path(build).resolve(), pathlib.Path(work)
    work.mkdir(parents=True, exist_ok=True)
    on_road, in_rooms = drive(build), rooms(build, work)
    for rows in (on_road, in_rooms):
        for minute, row in rows.items():
            print(f"minute {minute:g}: " + ", ".join(f"{key} {value:.2f}" for key, value in row.items()))
    if figure:
        pathlib.Path(figure).write_text(draw(on_road, in_rooms), encoding="utf-8")
    # The first minute in the rooms is the only one that sees them for the first time.
    failed = [grows("mapping a keyframe", on_road, "keyframe", 1),
              grows("a frame in rooms", in_rooms, "frame", 2)]
    return 1 if any(failed) else 0


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__.strip())
    sys.exit(main(*sys.argv[1:]))
