#!/usr/bin/env python3
"""Tells which stages and functions of a run take what, for each frame and for each keyframe.

    tools/profile_run.py SEQUENCE [--by cpu|instructions] [--program PROGRAM] [--top N] [-- OPTIONS OF RUN]

OPTIONS OF RUN are for instance --camera icl_nuim --sensor mono --from 60 --to 140.

Runs `plumbline run SEQUENCE` with all stages in one thread and prints two Markdown tables: the stages, each with
what it calls, and the functions that take most by themselves. A stage is a function of the library, so nothing has
to be measured in it: cpu takes samples of the call stack by `perf` on the clock of the process (997 a second),
instructions counts by `valgrind --tool=callgrind`, which takes fifty times as long, is not disturbed by other
processes and gives the same numbers again.
"""
import argparse
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

FRAME, KEYFRAME, RUN = "frame", "keyframe", "run"
# What is counted, the depth in the table, what it is divided by, the function.
STAGES = [
    (0, FRAME, "reading and decoding images", r"plumbline::(ReadGrayImage|ReadDepthImage)"),
    (0, FRAME, "rectification", r"plumbline::Rectifier::Apply"),
    (0, FRAME, "features", r"plumbline::(ExtractFeatures|FindRightLines)"),
    (1, FRAME, "pyramids", r"plumbline::BuildPyramid"),
    (1, FRAME, "corners", r"plumbline::ExtractOrb"),
    (2, FRAME, "FAST", r"plumbline::FastCorners::(FastCorners|Collect)"),
    (2, FRAME, "descriptors", r"plumbline::DescribeOrb"),
    (1, FRAME, "disparities of corners", r"plumbline::MatchStereoPoints"),
    (1, FRAME, "disparities from depth", r"plumbline::(PointDisparities|VirtualRightLines)"),
    (1, FRAME, "gradients", r"plumbline::ComputeGradient"),
    (1, FRAME, "lines", r"plumbline::DetectLines"),
    (2, FRAME, "drawing", r"plumbline::DrawSegments"),
    (2, FRAME, "refinement", r"plumbline::RefineSegment"),
    (1, FRAME, "descriptors of lines", r"plumbline::DescribeLines"),
    (1, FRAME, "of it for lines of the right image", r"plumbline::FindRightLines"),
    (0, FRAME, "index of features", r"plumbline::IndexFeatures"),
    (0, FRAME, "tracking", r"plumbline::Tracker::Track"),
    (1, FRAME, "landmarks of the last frame", r"plumbline::PoseSearch::LastLandmarks"),
    (1, FRAME, "search of landmarks", r"plumbline::MatchCandidates"),
    (1, FRAME, "pose", r"plumbline::PoseEstimator::Estimate"),
    (0, FRAME, "start of a monocular map", r"plumbline::MonocularInitialization::Offer"),
    (0, KEYFRAME, "mapping", r"plumbline::LocalMapper::Add"),
    (1, KEYFRAME, "taking in", r"plumbline::LocalMapper::InsertKeyFrame"),
    (1, KEYFRAME, "new landmarks", r"plumbline::LocalMapper::CreateLandmarks"),
    (1, KEYFRAME, "fusion", r"plumbline::LocalMapper::Fuse"),
    (1, KEYFRAME, "adjustment", r"plumbline::LocalMapper::Adjust"),
    (2, KEYFRAME, "solving", r"plumbline::SolveLocalBa"),
    (1, KEYFRAME, "calibration", r"plumbline::LocalMapper::CalibrateStereo"),
    (1, KEYFRAME, "redundant keyframes", r"plumbline::Remove(Redundant|Revisited)KeyFrames"),
    (0, KEYFRAME, "places", r"plumbline::PlaceRecognition::(Recognize|Follow|Withdraws)"),
    (0, KEYFRAME, "snapshot", r"plumbline::TakeSnapshot"),
    (0, RUN, "adjustment of the whole map", r"plumbline::AdjustWholeMap"),
    (0, RUN, "line map", r"plumbline::MakeLineMap"),
    (0, RUN, "whole run", None),
]


def run_program(tool, arguments, out):
    """Runs the program under a tool; the numbers of frames and of keyframes."""
    command = [*tool, arguments.program, "run", arguments.sequence, "--out", str(out), "--quiet",
               "--set", "slam.mode=inline", "--set", "features.parallel=false", *arguments.options]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}\n{done.stderr.strip()}")
    with open(out / "frames.csv", newline="") as file:
        frames = list(csv.DictReader(file))
    return len(frames), sum(frame["keyframe"] == "1" for frame in frames)


def by_cpu(arguments, folder):
    """(inclusive, self) milliseconds of each function, frames, keyframes."""
    data = folder / "perf.data"
    tool = ["perf", "record", "-q", "-e", "cpu-clock", "-F", "997", "--call-graph", "dwarf,32768", "-o", str(data), "--"]
    frames, keyframes = run_program(tool, arguments, folder / "out")
    report = subprocess.run(["perf", "script", "-i", str(data), "--no-inline", "-F", "ip,sym"],
                            capture_output=True, text=True)
    return (*sums_of_stacks(report.stdout), frames, keyframes)


def sums_of_stacks(text):
    """(inclusive, self) milliseconds of each function from the stacks that `perf script` prints."""
    inclusive, alone, total = {}, {}, 0
    milliseconds = 1000 / 997
    for stack in text.strip().split("\n\n"):
        names = []
        for line in stack.splitlines():
            parts = line.split(maxsplit=1)
            if len(parts) == 2:
                names.append(parts[1].strip())
        if not names:
            continue
        total += milliseconds
        alone[names[0]] = alone.get(names[0], 0) + milliseconds
        for name in set(names):
            inclusive[name] = inclusive.get(name, 0) + milliseconds
    return inclusive, alone, total


def by_instructions(arguments, folder):
    """(inclusive, self) millions of instructions of each function, frames, keyframes."""
    data = folder / "callgrind.out"
    tool = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={data}", "-q"]
    frames, keyframes = run_program(tool, arguments, folder / "out")
    inclusive, total = annotated(data, "yes")
    return inclusive, annotated(data, "no")[0], total, frames, keyframes


def annotated(data, inclusive):
    text = subprocess.run(["callgrind_annotate", f"--inclusive={inclusive}", "--threshold=99.99", "--auto=no", str(data)],
                          capture_output=True, text=True, check=True).stdout
    sums, total = {}, 0
    for line in text.splitlines():
        match = re.match(r"\s*([\d,]+) \([^)]*\)\s+(.*)", line)
        if not match:
            continue
        count = int(match[1].replace(",", "")) / 1e6
        if match[2].startswith("PROGRAM TOTALS"):
            total = count
            continue
        name = re.sub(r"^[^:]*:(?!:)", "", match[2])      # the file
        name = re.sub(r"\s\[[^\]]*\]$", "", name).strip()  # the binary
        sums[name] = sums.get(name, 0) + count
    return sums, total


def of_stage(pattern, inclusive, total):
    if pattern is None:
        return total
    whole = re.compile(pattern + r"($|\(|@| \[)")
    # Functions within a function count as a part of it already.
    return sum(value for name, value in inclusive.items() if whole.match(name) and "{lambda" not in name)


def print_stages(inclusive, total, frames, keyframes, unit):
    print(f"| stage | of the run | {unit} a frame | {unit} a keyframe |\n|---|---|---|---|")
    for depth, per, label, pattern in STAGES:
        value = of_stage(pattern, inclusive, total)
        if value < 0.001 * total:
            continue
        each = [f"{value / frames:.2f}", f"{value / max(keyframes, 1):.2f}" if per == KEYFRAME else ""]
        print(f"| {'&nbsp;&nbsp;' * depth}{label} | {100 * value / total:.1f} % | {' | '.join(each)} |")


def short(name):
    name = name.replace("(anonymous namespace)::", "").replace("plumbline::", "")
    return name if len(name) <= 90 else name[:87] + "..."


def print_functions(alone, total, frames, unit, top):
    print(f"\n| function by itself | of the run | {unit} a frame |\n|---|---|---|")
    for name, value in sorted(alone.items(), key=lambda item: -item[1])[:top]:
        print(f"| `{short(name)}` | {100 * value / total:.1f} % | {value / frames:.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sequence")
    parser.add_argument("--by", choices=["cpu", "instructions"], default="cpu")
    parser.add_argument("--program", default="build/release/plumbline")
    parser.add_argument("--top", type=int, default=25, help="functions in the second table")
    end = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    arguments = parser.parse_args(sys.argv[1:end])
    arguments.options = sys.argv[end + 1:]
    measure, unit = {"cpu": (by_cpu, "ms"), "instructions": (by_instructions, "million instructions")}[arguments.by]
    with tempfile.TemporaryDirectory() as folder:
        inclusive, alone, total, frames, keyframes = measure(arguments, pathlib.Path(folder))
    print(f"{frames} frames, {keyframes} keyframes, {total:.0f} {unit}\n")
    print_stages(inclusive, total, frames, keyframes, unit)
    print_functions(alone, total, frames, unit, arguments.top)


if __name__ == "__main__":
    main()
