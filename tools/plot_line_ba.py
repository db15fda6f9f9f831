#!/usr/bin/env python3
"""Draws what lab/bench/line_ba measured as SVG: time of bundle adjustment against the number of lines.

Usage: plot_line_ba.py RESULT.csv FIGURE.svg

Solid: lines alone; dashed: with the points. Times are the least of the repetitions.
"""
import csv
import pathlib
import sys

from plot_ba_times import HEIGHT, Chart

COLORS = {
    "plucker": "#1f5fa8",
    "plucker_left": "#1b9e77",
    "endpoints": "#d95f02",
    "endpoints, projected, split": "#7570b3",
}


def main(result, figure):
    curves = {}
    for row in csv.DictReader(result.open()):
        if row["rival"] in COLORS:
            curve = curves.setdefault((row["rival"], int(row["points"])), [])
            curve.append((int(row["lines"]), float(row["min_ms"])))
    sizes = sorted({lines for curve in curves.values() for lines, _ in curve})
    times = [ms for curve in curves.values() for _, ms in curve]
    chart = Chart((sizes[0], sizes[-1]), (min(times) / 1.2, max(times) * 1.2))
    chart.axes(sizes, "lines (dashed: with 2000 points)")
    label_y = HEIGHT
    for (rival, points), curve in sorted(curves.items(), key=lambda item: item[1][-1][1]):
        path = [(chart.x(lines), chart.y(ms)) for lines, ms in sorted(curve)]
        chart.line(path, COLORS[rival], 2, "6 4" if points else "")
        if points == 0:
            label_y = min(path[-1][1] + 4, label_y - 15)
            chart.text(path[-1][0] + 8, label_y, rival, "start", COLORS[rival])
    figure.write_text(chart.svg("Local bundle adjustment by the parameters of lines"),
                      encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
