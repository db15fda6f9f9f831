#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Tables of the documents that come from what a command wrote.

  tools/results.py record NAME OUT COMMAND [COMMIT]
                                             keeps OUT/ratios.json of an experiment as docs/results/NAME.json, and of
                                             monocular starts their numbers, with the command that made them,
                                             today's date and the commit that the program was built from (that
                                             checked out)
  tools/results.py make --program PROGRAM --data DIR --out OUT [--earlier PROGRAM] [NAME...]
                                             runs the commands of all files of docs/results again, or of those named,
                                             with a program of the commit checked out, and records what comes out;
                                             some experiments compare it with an earlier one. What is in OUT already
                                             is not run again. About an hour and a half on two fast cores
  tools/results.py fill                      writes all tables anew
  tools/results.py check                     exit status 1 where a table is not what its file says

A table stands in a document of docs/ between two lines of comment:

  <!-- ratios NAME METRIC... -->
  <!-- end -->

One row for each variant, one column for each metric: the ratio over all places with its 95 % interval by Student's t.
The lines below the table say how many comparisons would seem certain by chance alone, and name command, commit and
date.

  <!-- starts NAME -->
  <!-- end -->

One row for each variant: right starts in time of the possible ones (where those are known) and wrong ones by sequence,
and by how many percent points more starts are right than with the first variant: mean over the sequences, with its 95 %
interval by Student's t.
"""
import argparse
import datetime
import json
import pathlib
import re
import shlex
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
TABLE = re.compile(r"<!-- (ratios|starts) (\S+)((?: \S+)*) -->\n(.*?)<!-- end -->", re.DOTALL)
# The 97.5 % quantile of Student's t for 1, 2, ... degrees of freedom; beyond the list that of many.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
           2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042)
COUNTS = ("starts", "possible", "success", "late", "wrong")  # of the starts of a sequence


# What became of the starts on each sequence, by variant. Pools of several sequences have no folder in their names.
def starts_of(out):
    figures = {}
    for figure in json.loads((pathlib.Path(out) / "results.json").read_text()):
        if figure["metric"] in COUNTS and "/" in figure["sequence"]:
            row = figures.setdefault((figure["sequence"], figure["variant"]), {})
            row[figure["metric"]] = figure["value"]
    return [{"sequence": sequence, "variant": variant, **row}
            for (sequence, variant), row in figures.items() if "starts" in row]


def record(name, out, command, commit="HEAD"):
    ratios = json.loads((pathlib.Path(out) / "ratios.json").read_text())
    commit = subprocess.run(["git", "rev-parse", "--short", commit], cwd=ROOT, check=True, text=True,
                            capture_output=True).stdout.strip()
    kept = {"command": command, "commit": commit, "date": datetime.date.today().isoformat(),
            "ratios": ratios}
    starts = starts_of(out)
    if starts:
        kept["starts"] = starts
    folder = ROOT / "docs" / "results"
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.json").write_text(json.dumps(kept, indent=1) + "\n")


# A kept command with programs and folders in place of the words that stand for them.
def runnable(command, words):
    arguments = shlex.split(command)
    unknown = [a for a in arguments if a in words and words[a] is None]
    if unknown:
        sys.exit(f"results: `{command}` needs an earlier program (--earlier)")
    return [words.get(a, a) for a in arguments]


def make(program, data, out, earlier, names):
    words = {"plumbline": program, "DIR": data, "PROGRAM": earlier}
    commands = {name: read(name)["command"] for name in names}
    runs = {name: runnable(command, words) for name, command in commands.items()}
    for name, run in runs.items():
        print(f"{name}: {commands[name]}", flush=True)
        folder = pathlib.Path(out) / name
        cache = pathlib.Path(out) / "cache"
        subprocess.run([*run, "--out", folder, "--cache", cache, "--jobs", "2", "--quiet"], check=True)
        record(name, folder, commands[name])


def cell(entry):
    if entry is None or entry["ratio"] is None:
        return "-"
    if entry["low"] is None:
        return f"{entry['ratio']:.3f}"
    return f"{entry['ratio']:.3f} ({entry['low']:.3f}-{entry['high']:.3f})"


def read(name):
    file = ROOT / "docs" / "results" / f"{name}.json"
    if not file.is_file():
        sys.exit(f"results: {file.relative_to(ROOT)} is missing, but a table is made of it")
    return json.loads(file.read_text())


def table_of_ratios(name, metrics):
    kept = read(name)
    whole = {(r["metric"], r["variant"]): r for r in kept["ratios"] if r["sequence"] is None}
    variants = list(dict.fromkeys(r["variant"] for r in kept["ratios"]))
    unknown = [m for m in metrics if m not in {metric for metric, _ in whole}]
    if unknown or not metrics:
        sys.exit(f"results: docs/results/{name}.json has no ratios of {', '.join(unknown)}")
    lines = ["| variant | " + " | ".join(metrics) + " | pairs | places |", "|---" * (len(metrics) + 3) + "|"]
    for variant in variants:
        cells = [cell(whole.get((metric, variant))) for metric in metrics]
        entry = whole.get((metrics[0], variant), {})
        lines.append(f"| {variant} | " + " | ".join(cells) + f" | {entry.get('pairs', 0)} | {entry.get('places', 0)} |")
    certain = [e for (metric, _), e in whole.items() if metric in metrics and e["low"] is not None and e["low"] < e["high"]]
    lines += ["", f"Of {len(certain)} comparisons {0.05 * len(certain):.1f} would seem certain by chance alone."]
    return lines, kept


# Half of the 95 % interval of the mean of at least two values.
def half_width_of_mean(values):
    freedom = len(values) - 1
    quantile = STUDENT[freedom - 1] if freedom <= len(STUDENT) else 1.96
    return quantile * statistics.stdev(values) / len(values) ** 0.5


# Percent points that the share of right starts is above that of the reference, by sequence.
def gains(by_place, sequences, variant, reference):
    shares = [(by_place[s, variant]["success"], by_place[s, reference]["success"]) for s in sequences]
    return [mine - other for mine, other in shares if mine is not None and other is not None]


def gain_with_interval(differences):
    if not differences:
        return "-"
    mean = sum(differences) / len(differences)
    if len(differences) < 2:
        return f"{mean:+.1f}"
    half = half_width_of_mean(differences)
    return f"{mean:+.1f} ({mean - half:+.1f} to {mean + half:+.1f})"


def starts_cell(row):
    if row.get("success") is None:
        return f"- / {row['wrong']:.0f}"
    return f"{row['success'] * row['possible'] / 100:.0f} of {row['possible']:.0f} / {row['wrong']:.0f}"


def table_of_starts(name):
    kept = read(name)
    rows = kept.get("starts")
    if not rows:
        sys.exit(f"results: docs/results/{name}.json has no starts")
    by_place = {(row["sequence"], row["variant"]): row for row in rows}
    sequences = list(dict.fromkeys(row["sequence"] for row in rows))
    variants = list(dict.fromkeys(row["variant"] for row in rows))
    titles = [f"{s.split('/')[1].split('@')[0].split('_first')[0]} ({by_place[s, variants[0]]['starts']:.0f})"
              for s in sequences]
    lines = ["| right / wrong | " + " | ".join(titles) + " | right, points of % |",
             "|---" * (len(sequences) + 2) + "|"]
    for variant in variants:
        cells = [starts_cell(by_place[s, variant]) for s in sequences]
        cells.append(gain_with_interval(gains(by_place, sequences, variant, variants[0])))
        lines.append(f"| {variant} | " + " | ".join(cells) + " |")
    return lines, kept


def filled(text):
    def anew(match):
        kind, name, metrics = match.group(1), match.group(2), match.group(3).split()
        lines, kept = table_of_starts(name) if kind == "starts" else table_of_ratios(name, metrics)
        below = f"`{kept['command']}`, commit {kept['commit']}, {kept['date']}."
        return f"<!-- {kind} {name}{match.group(3)} -->\n" + "\n".join(lines) + f"\n\n{below}\n<!-- end -->"
    return TABLE.sub(anew, text)


# Writes the tables anew, or only tells which differ: exit status 1 where one does.
def fill(write):
    status = 0
    for document in sorted((ROOT / "docs").rglob("*.md")):
        text = document.read_text()
        made = filled(text)
        if made == text:
            continue
        if write:
            document.write_text(made)
        else:
            print(f"{document.relative_to(ROOT)}: a table is not what docs/results says; "
                  "run tools/results.py fill")
            status = 1
    return status


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    actions = parser.add_subparsers(dest="action", required=True)
    recording = actions.add_parser("record")
    for name in ("name", "out", "command"):
        recording.add_argument(name)
    recording.add_argument("commit", nargs="?", default="HEAD")
    making = actions.add_parser("make")
    for name in ("--program", "--data", "--out"):
        making.add_argument(name, required=True)
    making.add_argument("--earlier")
    making.add_argument("names", nargs="*", metavar="NAME")
    actions.add_parser("fill")
    actions.add_parser("check")
    asked = parser.parse_args()
    if asked.action == "record":
        record(asked.name, asked.out, asked.command, asked.commit)
    elif asked.action == "make":
        kept = sorted(file.stem for file in (ROOT / "docs" / "results").glob("*.json"))
        make(asked.program, asked.data, asked.out, asked.earlier, asked.names or kept)
    else:
        return fill(write=asked.action == "fill")
    return 0


if __name__ == "__main__":
    sys.exit(main())
