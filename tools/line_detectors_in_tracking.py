#!/usr/bin/python3
"""Runs Plumbline with each line detector at full and half size and tabulates tracking.

    tools/line_detectors_in_tracking.py --data DIR [--binary build/release/plumbline] [--runs N] [--only TEXT]

For each recorded sequence, with points and lines and with lines alone, prints a Markdown table: lines
matched and inliers in the mean over all frames (frames.csv), frames lost, median ATE of N runs that
start at frames 0, 1, ...
"""
import argparse
import csv
import json
import pathlib
import statistics
import subprocess
import tempfile

SEQUENCES = {
    "MH_01": "euroc/MH_01_easy_first250",
    "KITTI_06": "kitti/06_first51",
    "fr1_floor": "tum/rgbd_dataset_freiburg1_floor_first90",
}
DETECTORS = ["drawing", "lsd", "edlines"]
SCALES = ["1", "0.5"]


def run_once(binary, path, settings, k):
    with tempfile.TemporaryDirectory() as out:
        command = [binary, "run", str(path), "--out", out, "--quiet", "--seed", str(k), "--from", str(k - 1)]
        for setting in settings:
            command += ["--set", setting]
        subprocess.run(command, check=True, capture_output=True)
        summary = json.loads(pathlib.Path(out, "summary.json").read_text())
        with open(pathlib.Path(out, "frames.csv"), newline="") as file:
            frames = list(csv.DictReader(file))

    def mean(column):
        return statistics.mean(float(f[column] or 0) for f in frames)

    accuracy = summary["accuracy"]
    return {
        "ate_mm": 1000 * accuracy["ate"]["rmse"] if accuracy else float("inf"),
        "lost": summary["frames"]["lost"],
        "matched": mean("matched_lines"),
        "inliers": mean("inlier_lines"),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", required=True, type=pathlib.Path, help="folder of the sequences")
    parser.add_argument("--binary", default="build/release/plumbline")
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--only", default="", help="sequences whose name contains this text")
    options = parser.parse_args()
    print("| sequence | features | detector | scale | matched lines | inlier lines | inlier rate | lost | ATE mm |")
    print("|---|---|---|---|---|---|---|---|---|")
    for sequence, folder in SEQUENCES.items():
        if options.only not in sequence or not (options.data / folder).is_dir():
            continue
        for points in (True, False):
            for detector in DETECTORS:
                for scale in SCALES:
                    settings = [f"features.line_detector={detector}", f"features.line.detection_scale={scale}"]
                    if not points:
                        settings.append("features.points=false")
                    runs = [run_once(options.binary, options.data / folder, settings, k)
                            for k in range(1, options.runs + 1)]

                    def median(name):
                        return statistics.median(r[name] for r in runs)

                    print(f"| {sequence} | {'points, lines' if points else 'lines'} | {detector} | {scale} "
                          f"| {median('matched'):.0f} | {median('inliers'):.0f} "
                          f"| {100 * median('inliers') / max(1e-9, median('matched')):.0f} % "
                          f"| {median('lost'):.0f} | {median('ate_mm'):.1f} |", flush=True)


if __name__ == "__main__":
    main()
