#!/usr/bin/env python3
"""Draws the time of bundle adjustment against the size of the problem as SVG, and prints ratios.

Usage: plot_ba_times.py RESULT.json FIGURE.svg

RESULT.json is what lab/bench/local_ba_bench wrote with --benchmark_out=RESULT.json
--benchmark_out_format=json. Times are medians of the CPU time over the repetitions.
"""
import json
import math
import pathlib
import re
import statistics
import sys

# benchmark -> legend, color, dash pattern
CURVES = {
    "CeresGrowing/endpoints": ("Ceres, end points", "#d95f02", "6 4"),
    "CeresGrowing/plucker": ("Ceres, Plücker", "#d95f02", ""),
    "OursGrowing/endpoints": ("Plumbline, end points", "#1f5fa8", "6 4"),
    "OursGrowing/plucker": ("Plumbline, Plücker", "#1f5fa8", ""),
}
# reference, ours: each pair of benchmarks is compared at every size both were run at
RATIOS = [
    ("Ceres/plucker", "Ours/plucker"),
    ("Ceres/endpoints", "Ours/endpoints"),
    ("Ours/endpoints", "Ours/plucker"),
    ("Ceres/endpoints", "Ceres/plucker"),
    ("CeresWeakLines/plucker", "OursWeakLines/plucker"),
    ("OursWeakLines/endpoints", "OursWeakLines/plucker"),
    ("OursDefault/endpoints", "OursDefault/plucker"),
    ("CeresMonocular", "OursMonocular"),
    ("CeresGrowing/plucker", "OursGrowing/plucker"),
    ("CeresGrowing/endpoints", "OursGrowing/endpoints"),
]
WIDTH, HEIGHT = 760, 460
LEFT, RIGHT, TOP, BOTTOM = 70, 170, 40, 60


def read_times(path):
    """(benchmark, arguments) -> CPU milliseconds of each repetition."""
    times = {}
    for run in json.loads(path.read_text())["benchmarks"]:
        if run["run_type"] != "iteration":
            continue
        if run["time_unit"] != "ms":
            sys.exit(f"{path}: {run['name']}: expected times in ms, found {run['time_unit']}")
        match = re.match(r"(.*?)/(fixed:.*?)(/repeats:\d+)?$", run["run_name"])
        if match:
            times.setdefault((match[1], match[2]), []).append(run["cpu_time"])
    return times


def free_keyframes(arguments):
    return int(re.search(r"free:(\d+)", arguments)[1])


def ticks(low, high):
    """1, 2, 5, 10, ... within [low, high]."""
    out = []
    for power in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1):
        out += [m * 10.0**power for m in (1, 2, 5) if low <= m * 10.0**power <= high]
    return out


class Chart:
    """A double logarithmic chart as SVG elements."""

    def __init__(self, x_range, y_range):
        self.x_range, self.y_range = x_range, y_range
        self.parts = []

    def x(self, value):
        low, high = map(math.log, self.x_range)
        return LEFT + (math.log(value) - low) / (high - low) * (WIDTH - LEFT - RIGHT)

    def y(self, value):
        low, high = map(math.log, self.y_range)
        return HEIGHT - BOTTOM - (math.log(value) - low) / (high - low) * (HEIGHT - TOP - BOTTOM)

    def line(self, points, color, width=1, dash=""):
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{color}" '
                          f'stroke-width="{width}"{dashes}/>')

    def text(self, x, y, text, anchor="middle", color="#333", extra=""):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" '
                          f'fill="{color}" {extra}>{text}</text>')

    def axes(self, x_values, label="free keyframes (with 200 points and 30 lines each)",
             y_label="CPU time to convergence [ms]"):
        bottom, right = HEIGHT - BOTTOM, WIDTH - RIGHT
        for value in x_values:
            self.line([(self.x(value), TOP), (self.x(value), bottom)], "#ddd")
            self.text(self.x(value), bottom + 18, f"{value:g}")
        for value in ticks(*self.y_range):
            self.line([(LEFT, self.y(value)), (right, self.y(value))], "#ddd")
            self.text(LEFT - 8, self.y(value) + 4, f"{value:g}", "end")
        self.line([(LEFT, TOP), (LEFT, bottom), (right, bottom)], "#333")
        self.text((LEFT + right) / 2, HEIGHT - 18, label)
        middle = (TOP + bottom) / 2
        self.text(20, middle, y_label,
                  extra=f'transform="rotate(-90 20 {middle:.1f})"')

    def svg(self, title):
        self.text(LEFT, 22, title, "start", extra='font-weight="bold"')
        return "\n".join([
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
            f'viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="13">',
            f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>', *self.parts, "</svg>", ""])


def draw(times):
    curves = {}
    for name in CURVES:
        curves[name] = sorted((free_keyframes(arguments), statistics.median(values))
                              for (other, arguments), values in times.items() if other == name)
    if not all(curves.values()):
        sys.exit("plot_ba_times.py: the result lacks one of " + ", ".join(CURVES))
    sizes = [size for size, _ in next(iter(curves.values()))]
    milliseconds = [ms for curve in curves.values() for _, ms in curve]
    chart = Chart((sizes[0], sizes[-1]), (min(milliseconds) / 1.2, max(milliseconds) * 1.2))
    chart.axes(sizes)
    label_y = HEIGHT
    for name in sorted(CURVES, key=lambda name: curves[name][-1][1]):
        legend, color, dash = CURVES[name]
        points = [(chart.x(size), chart.y(ms)) for size, ms in curves[name]]
        chart.line(points, color, 2, dash)
        label_y = min(points[-1][1] + 4, label_y - 15)
        chart.text(points[-1][0] + 8, label_y, legend, "start", color)
    return chart.svg("Local bundle adjustment")


def print_ratios(times):
    for reference, ours in RATIOS:
        for (name, arguments), values in sorted(times.items()):
            mine = times.get((ours, arguments))
            if name != reference or mine is None:
                continue
            print(f"{reference} / {ours}, {arguments}: "
                  f"min {min(values):.2f} / {min(mine):.2f} ms = {min(values) / min(mine):.2f}, "
                  f"median {statistics.median(values):.2f} / {statistics.median(mine):.2f} ms = "
                  f"{statistics.median(values) / statistics.median(mine):.2f}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    measured = read_times(pathlib.Path(sys.argv[1]))
    print_ratios(measured)
    pathlib.Path(sys.argv[2]).write_text(draw(measured), encoding="utf-8")
