#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Tables of the documents that come from what a command wrote.

  tools/results.py record NAME OUT COMMAND   keeps OUT/ratios.json of an experiment as docs/results/NAME.json, with
                                             the command that made it, today's date and the commit checked out
  tools/results.py fill                      writes all tables anew
  tools/results.py check                     exit status 1 where a table is not what its file says

A table stands in a document of docs/ between two lines of comment:

  <!-- ratios NAME METRIC... -->
  <!-- end -->

One row for each variant, one column for each metric: the ratio over all sequences with its 95 % interval. The line
below the table names command, commit and date.
"""
import datetime
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
TABLE = re.compile(r"<!-- ratios (\S+)((?: \S+)+) -->\n(.*?)<!-- end -->", re.DOTALL)


def record(name, out, command):
    ratios = json.loads((pathlib.Path(out) / "ratios.json").read_text())
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, check=True, text=True,
                            capture_output=True).stdout.strip()
    kept = {"command": command, "commit": commit, "date": datetime.date.today().isoformat(),
            "ratios": ratios}
    folder = ROOT / "docs" / "results"
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.json").write_text(json.dumps(kept, indent=1) + "\n")


def cell(entry):
    if entry is None or entry["ratio"] is None:
        return "-"
    return f"{entry['ratio']:.3f} ({entry['low']:.3f}-{entry['high']:.3f})"


def table(name, metrics):
    file = ROOT / "docs" / "results" / f"{name}.json"
    if not file.is_file():
        sys.exit(f"results: {file.relative_to(ROOT)} is missing, but a table is made of it")
    kept = json.loads(file.read_text())
    whole = {(r["metric"], r["variant"]): r for r in kept["ratios"] if r["sequence"] is None}
    variants = list(dict.fromkeys(r["variant"] for r in kept["ratios"]))
    unknown = [m for m in metrics if m not in {metric for metric, _ in whole}]
    if unknown:
        sys.exit(f"results: {file.relative_to(ROOT)} has no ratios of {', '.join(unknown)}")
    lines = ["| variant | " + " | ".join(metrics) + " | pairs |", "|---" * (len(metrics) + 2) + "|"]
    for variant in variants:
        cells = [cell(whole.get((metric, variant))) for metric in metrics]
        pairs = whole.get((metrics[0], variant), {}).get("pairs", 0)
        lines.append(f"| {variant} | " + " | ".join(cells) + f" | {pairs} |")
    return "\n".join(lines) + f"\n\n`{kept['command']}`, commit {kept['commit']}, {kept['date']}.\n"


def filled(text):
    def anew(match):
        name, metrics = match.group(1), match.group(2).split()
        return f"<!-- ratios {name}{match.group(2)} -->\n{table(name, metrics)}<!-- end -->"
    return TABLE.sub(anew, text)


def main(arguments):
    if arguments[:1] == ["record"] and len(arguments) == 4:
        record(*arguments[1:])
        return 0
    if arguments not in (["fill"], ["check"]):
        sys.exit(__doc__)
    status = 0
    for document in sorted((ROOT / "docs").rglob("*.md")):
        text = document.read_text()
        made = filled(text)
        if made == text:
            continue
        if arguments == ["fill"]:
            document.write_text(made)
        else:
            print(f"{document.relative_to(ROOT)}: a table is not what docs/results says; "
                  "run tools/results.py fill")
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
