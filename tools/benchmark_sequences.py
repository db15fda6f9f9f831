#!/usr/bin/python3
"""Runs Plumbline several times over recorded sequences and tabulates accuracy and speed.

    tools/benchmark_sequences.py --data DIR [--runs 5] [--only TEXT] [--variant NAME] [--set KEY=VALUE]
                                 [--mode inline|lockstep|live]

Run k uses seed k and starts at frame k-1; runs with the same trajectory count once. Prints for each
sequence and variant the median (lowest-highest) ATE over the runs, frames tracked, lost, skipped and
dropped in all runs, the medians over the runs of frames a second, of median and 95th percentile of
the time from a frame's arrival to its pose, of the first frame's pose after the start of the program,
of processor time a frame (decoding and all), and the peak memory. --json FILE keeps every run.
"""
import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

SEQUENCES = [
    "euroc/MH_01_easy_first250",
    "kitti/06_first51",
    "tum/rgbd_dataset_freiburg1_floor_first90",
]
VARIANTS = {
    "points+lines": [],
    "points": ["features.lines=false"],
    "lines": ["features.points=false"],
}


def run_once(binary, path, settings, k, extra):
    with tempfile.TemporaryDirectory() as out:
        command = [binary, "run", str(path), "--out", out, "--quiet", "--seed", str(k),
                   "--from", str(k - 1), *extra]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            return {"run": k, "error": done.stderr.strip()}
        summary = json.loads(pathlib.Path(out, "summary.json").read_text())
        digest = hashlib.sha256(pathlib.Path(out, "trajectory.txt").read_bytes()).hexdigest()
    accuracy = summary["accuracy"]
    return {
        "run": k,
        "trajectory": digest,
        "ate_m": accuracy["ate"]["rmse"] if accuracy else None,
        "frames": summary["frames"],
        "keyframes": summary["keyframes"],
        "points": summary["points"],
        "lines": summary["lines"],
        "frame_ms": summary["timing"]["total"]["median_ms"],
        "frame_p95_ms": summary["timing"]["total"]["p95_ms"],
        "cpu_ms": 1000 * summary["cpu_seconds"] / summary["frames"]["in"],
        "first_pose_s": summary["first_pose_seconds"],
        "fps": summary["frames"]["in"] / summary["wall_seconds"],
        "peak_memory_mb": summary["peak_memory_mb"],
    }


def row(sequence, variant, runs):
    good = [r for r in runs if r.get("ate_m") is not None]
    failed = [r for r in runs if "error" in r]
    if not good:
        return f"{sequence:42} {variant:13} no result: {failed[0]['error'] if failed else 'no pose'}"
    ates = [r["ate_m"] * 1000 for r in {r["trajectory"]: r for r in good}.values()]
    total = {name: sum(r["frames"][name] for r in good) for name in ("in", "tracked", "lost", "skipped", "dropped")}
    median = {name: statistics.median(r[name] for r in good)
              for name in ("fps", "frame_ms", "frame_p95_ms", "cpu_ms", "first_pose_s")}
    return (f"{sequence:42} {variant:13} ATE {statistics.median(ates):7.2f} mm "
            f"({min(ates):.2f}-{max(ates):.2f}, {len(ates)} runs)  "
            f"tracked {total['tracked']}/{total['in']} lost {total['lost']} "
            f"skipped {total['skipped']} ({total['dropped']} dropped)  {median['fps']:5.1f} fps  "
            f"{median['frame_ms']:.1f} ms (p95 {median['frame_p95_ms']:.1f})  "
            f"first pose {median['first_pose_s']:.2f} s  CPU {median['cpu_ms']:.0f} ms/frame  "
            f"{max(r['peak_memory_mb'] for r in good):4.0f} MB"
            + (f"  {len(failed)} runs failed" if failed else ""))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", required=True, type=pathlib.Path, help="folder of the sequences")
    parser.add_argument("--binary", default="build/release/plumbline")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--only", default="", help="sequences whose name contains this text")
    parser.add_argument("--variant", action="append", choices=sorted(VARIANTS))
    parser.add_argument("--set", action="append", default=[], help="KEY=VALUE for all runs")
    parser.add_argument("--mode", choices=["inline", "lockstep", "live"])
    parser.add_argument("--jobs", type=int, default=1, help="runs at once; more than 1 spoils times")
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    results = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for sequence in (s for s in SEQUENCES if options.only in s):
            if not (options.data / sequence).is_dir():
                print(f"{sequence:42} skipped: not in {options.data}")
                continue
            for variant in options.variant or VARIANTS:
                settings = VARIANTS[variant] + options.set
                runs = list(pool.map(
                    lambda k: run_once(options.binary, options.data / sequence, settings, k,
                                       ["--mode", options.mode] if options.mode else []),
                    range(1, options.runs + 1)))
                print(row(sequence, variant, runs), flush=True)
                results.append({"sequence": sequence, "variant": variant, "runs": runs})
    if options.json:
        options.json.write_text(json.dumps(results, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
