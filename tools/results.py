#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Tables and figures of the documents that come from what a command wrote.

  tools/results.py make --program PROGRAM --data DIR --out OUT [--earlier PROGRAM] [--runs N] [--only PATTERN] [NAME...]
                                             runs the commands of all files of docs/results again, or of those named, or
                                             experiments and groups of them (all, controls), with a program of the commit
                                             checked out, keeps what comes out and fills the documents. Some experiments
                                             compare it with an earlier program. What is in OUT already is not run again.
                                             `all` takes one to two hours on two cores, `controls` as long
  tools/results.py take OUT COMMAND [COMMIT] keeps what COMMAND, an experiment or a group of them, wrote to OUT:
                                             docs/results/EXPERIMENT.json with the command, today's date and the commit
                                             that the program was built from (that checked out), and the plots that the
                                             documents show; then fills them
  tools/results.py fill                      writes all tables anew
  tools/results.py check                     exit status 1 where a table is not what its file says

A table stands in a document of docs/ or lab/notes/ between two lines of comment; below it stand command, commit and date:

  <!-- ratios NAME METRIC... -->
  <!-- end -->

One row for each variant, one column for each metric: the ratio over all places with its 95 % interval by Student's t,
and how many comparisons would seem certain by chance alone.

  starts NAME               right starts in time of the possible ones (where those are known) and wrong ones by
                            sequence, and by how many percent points more starts are right than with the first variant:
                            mean over the sequences, with its 95 % interval by Student's t
  printed NAME METRIC       a table of a paper: its rows, printed figures beside ours
  runs NAME METRIC...       one row for each sequence and variant: mean or median and range of the runs
  matrix NAME METRIC        the same of one metric, one row for each variant, one column for each sequence
  figures NAME PATTERN METRIC...
                            single figures, as of an experiment that computes by itself: one row for each variant on
                            each sequence that fits PATTERN
  plots NAME PLOT...        plots that the experiment drew, kept in docs/images/papers

A single ratio stands in a line of text, also in README.md:

  <!-- ratio NAME METRIC VARIANT -->1.000 (0.900-1.100)<!-- end -->

Where nothing is kept yet, the table says so and names the command.
"""
import argparse
import datetime
import fnmatch
import json
import os
import pathlib
import re
import shlex
import shutil
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
RESULTS = ROOT / "docs" / "results"
IMAGES = ROOT / "docs" / "images" / "papers"
LARGEST_IMAGE = 700_000  # bytes
TABLE = re.compile(r"<!-- (ratios|starts|printed|runs|matrix|figures|plots) (\S+)((?: \S+)*) -->\n(.*?)<!-- end -->",
                   re.DOTALL)
RATIO = re.compile(r"<!-- ratio (\S+) (\S+) (\S+) -->.*?<!-- end -->")
# The 97.5 % quantile of Student's t for 1, 2, ... degrees of freedom; beyond the list that of many.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
           2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042)
COUNTS = ("starts", "possible", "success", "late", "wrong")  # of the starts of a sequence


def read_json(file):
    return json.loads(file.read_text()) if file.is_file() else None


# What became of the starts on each sequence, by variant. Pools of several sequences have no folder in their names.
def starts_of(figures):
    rows = {}
    for figure in figures:
        if figure["metric"] in COUNTS and "/" in (figure["sequence"] or ""):
            rows.setdefault((figure["sequence"], figure["variant"]), {})[figure["metric"]] = figure["value"]
    return [{"sequence": sequence, "variant": variant, **row}
            for (sequence, variant), row in rows.items() if "starts" in row]


def documents():
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")), *sorted((ROOT / "lab/notes").glob("*.md"))]


# What stands in the documents: kind, name and the further words of each table.
def shown():
    return [match[:3] for document in documents() for match in TABLE.findall(document.read_text())]


# The parts of docs/results/NAME.json that an experiment wrote to a folder. Of single figures only those that documents
# show.
def parts_of(name, out):
    figures = read_json(out / "results.json")
    if figures is None:
        sys.exit(f"results: {out}: no results.json, which an experiment writes")
    parts = {"ratios": read_json(out / "ratios.json"), "starts": starts_of(figures),
             "table": read_json(out / "table.json"), "timing": read_json(out / "timing_table.json")}
    asked = [words.split() for kind, of, words in shown() if (kind, of) == ("figures", name)]
    parts["figures"] = [{key: f[key] for key in ("sequence", "variant", "metric", "value", "unit")}
                        for f in figures + (read_json(out / "timing.json") or [])
                        if any(fnmatch.fnmatch(f["sequence"] or "", a[0]) and f["metric"] in a[1:] for a in asked)]
    return {name: part for name, part in parts.items() if part}


# Copies the plots that documents show.
def keep_plots(name, out):
    for plot in [plot for kind, of, plots in shown() if (kind, of) == ("plots", name) for plot in plots.split()]:
        file = out / "plots" / f"{plot}.svg"
        if not file.is_file():
            print(f"results: {name} drew no {plot}; the one in the documents stays", file=sys.stderr)
            continue
        if file.stat().st_size > LARGEST_IMAGE:
            sys.exit(f"results: {file}: expected at most {LARGEST_IMAGE} bytes, found {file.stat().st_size}")
        (IMAGES / name).mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, IMAGES / name / f"{plot}.svg")


def record(name, out, command, commit):
    RESULTS.mkdir(exist_ok=True)
    kept = {"command": command, "commit": commit, "date": datetime.date.today().isoformat(), **parts_of(name, out)}
    (RESULTS / f"{name}.json").write_text(json.dumps(kept, indent=1) + "\n")
    keep_plots(name, out)


# The folders of the experiments of a command, by name: those of a group, or its own.
def experiments_in(out):
    of_group = {folder.name: folder for folder in sorted(out.iterdir())
                if (folder / "results.json").is_file() and folder.name != "sequences"}
    if of_group:
        return of_group
    figures = read_json(out / "results.json") or read_json(out / "timing.json")  # of times alone: no results
    if not figures:
        sys.exit(f"results: {out}: expected what an experiment or a group of them wrote, found no results")
    return {figures[0]["experiment"]: out}


def take(out, command, commit="HEAD"):
    commit = subprocess.run(["git", "rev-parse", "--short", commit], cwd=ROOT, check=True, text=True,
                            capture_output=True).stdout.strip()
    for name, folder in experiments_in(out).items():
        record(name, folder, command, commit)


# A kept command with programs and folders in place of the words that stand for them.
def runnable(command, words):
    arguments = shlex.split(command)
    unknown = [a for a in arguments if a in words and words[a] is None]
    if unknown:
        sys.exit(f"results: `{command}` needs an earlier program (--earlier)")
    return [words.get(a, a) for a in arguments]


# The command of a file of docs/results, or that of an experiment or a group.
def command_of(name, more):
    kept = read_json(RESULTS / f"{name}.json")
    return kept["command"] if kept and not more else " ".join(["plumbline", "experiment", name, "--data", "DIR", *more])


def make(program, data, out, earlier, more, names):
    words = {"plumbline": program, "DIR": data, "PROGRAM": earlier}
    commands = list(dict.fromkeys(command_of(name, more) for name in names))
    runs = {command: runnable(command, words) for command in commands}
    for command, run in runs.items():
        print(command, flush=True)
        folder = out / shlex.split(command)[2]
        options = [] if computes_by_itself(program, folder.name) else ["--cache", out / "cache", "--jobs", "2"]
        subprocess.run([*run, "--out", folder, "--quiet", *options], check=True)
        take(folder, command)


# Whether an experiment makes no runs: it takes no options of runs then.
def computes_by_itself(program, name):
    listed = subprocess.run([program, "experiment", name, "--list"], check=True, text=True, capture_output=True).stdout
    return "needs no sequences" in listed


def cell(entry):
    if entry is None or entry["ratio"] is None:
        return "-"
    if entry["low"] is None:
        return f"{entry['ratio']:.3f}"
    return f"{entry['ratio']:.3f} ({entry['low']:.3f}-{entry['high']:.3f})"


class NotKept(Exception):
    pass


def read(name, part=None):
    kept = read_json(RESULTS / f"{name}.json")
    if kept is None or (part and part not in kept):
        raise NotKept
    return kept


def markdown(header, rows):
    return [f"| {' | '.join(row)} |" for row in (header,)] + ["|---" * len(header) + "|"] + \
           [f"| {' | '.join(row)} |" for row in rows]


def table_of_ratios(name, metrics):
    kept = read(name, "ratios")
    whole = {(r["metric"], r["variant"]): r for r in kept["ratios"] if r["sequence"] is None}
    variants = list(dict.fromkeys(r["variant"] for r in kept["ratios"]))
    unknown = [m for m in metrics if m not in {metric for metric, _ in whole}]
    if unknown or not metrics:
        sys.exit(f"results: docs/results/{name}.json has no ratios of {', '.join(unknown)}")
    rows = []
    for variant in variants:
        entry = whole.get((metrics[0], variant), {})
        cells = [cell(whole.get((metric, variant))) for metric in metrics]
        rows.append([variant, *cells, str(entry.get("pairs", 0)), str(entry.get("places", 0))])
    certain = [e for (metric, _), e in whole.items() if metric in metrics and e["low"] is not None and e["low"] < e["high"]]
    chance = ["", f"Of {len(certain)} intervals {0.05 * len(certain):.1f} would leave out 1 by chance alone."] if len(certain) > 1 else []
    return markdown(["variant", *metrics, "pairs", "places"], rows) + chance


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


def table_of_starts(name, _):
    rows = read(name, "starts")["starts"]
    by_place = {(row["sequence"], row["variant"]): row for row in rows}
    sequences = list(dict.fromkeys(row["sequence"] for row in rows))
    variants = list(dict.fromkeys(row["variant"] for row in rows))
    titles = [f"{s.split('/')[1].split('@')[0].split('_first')[0]} ({by_place[s, variants[0]]['starts']:.0f})"
              for s in sequences]
    lines = []
    for variant in variants:
        cells = [starts_cell(by_place[s, variant]) for s in sequences]
        lines.append([variant, *cells, gain_with_interval(gains(by_place, sequences, variant, variants[0]))])
    return markdown(["right / wrong", *titles, "right, points of %"], lines)


# A dash says that runs failed: ours of a row that was not run are empty.
def without_dashes(header, row):
    if not row[-1].startswith("not there"):
        return row
    return ["" if title.endswith(", ours") and text == "-" else text for title, text in zip(header, row)]


def printed_table(name, metrics):
    for table in read(name, "table")["table"]["printed"]:
        if [table["metric"]] == metrics:
            note = [f"{table['title']}. {table['note']}".strip(), ""]
            return note + markdown(table["header"], [without_dashes(table["header"], row) for row in table["rows"]])
    sys.exit(f"results: docs/results/{name}.json has no printed table of {' '.join(metrics)}")


# The columns of these metrics, whether of results or of times: title, and cells by sequence and variant.
def columns_of(name, metrics):
    kept = read(name, "table")
    columns = []
    for metric in metrics:
        for part in (kept[p] for p in ("table", "timing") if p in kept):
            places = [i for i, column in enumerate(part["columns"]) if column["metric"] == metric]
            if places:
                cells = {(row["sequence"], row["variant"]): row["cells"][places[0]] for row in part["rows"]}
                columns.append((part["columns"][places[0]]["title"], cells))
                break
        else:
            sys.exit(f"results: docs/results/{name}.json has no {metric}")
    return kept["table"], columns


# What is said below a table: of which figure of the runs it is, what is not there, what failed.
def notes(name, table):
    lines = ["", f"- {table['centre'].capitalize()} (range) over the runs; runs with the same trajectory count once."]
    missing = [re.sub(r"^\S+ \((.*); \S+\)$", r"\1", text) for text in table["missing"]]
    if missing:
        lines.append(f"- Not there: {', '.join(missing)}; `experiment {name} --full` runs them where `--data` has them.")
    return lines + [f"- {text[0].upper()}{text[1:]}." for text in table["failures"]]


def table_of_runs(name, metrics):
    table, columns = columns_of(name, metrics)
    rows = [[row["sequence"], row["variant"], row["runs"],
             *(cells.get((row["sequence"], row["variant"]), "-") for _, cells in columns)] for row in table["rows"]]
    return markdown(["sequence", "variant", "runs", *(title for title, _ in columns)], rows) + notes(name, table)


def matrix(name, metrics):
    table, columns = columns_of(name, metrics)
    sequences = list(dict.fromkeys(row["sequence"] for row in table["rows"]))
    variants = list(dict.fromkeys(row["variant"] for row in table["rows"]))
    title, cells = columns[0]
    rows = [[variant, *(cells.get((sequence, variant), "-") for sequence in sequences)] for variant in variants]
    return markdown([title, *sequences], rows) + notes(name, table)


def number(value):
    return "-" if value is None else f"{value:.4g}"


def table_of_figures(name, asked):
    pattern, metrics = asked[0], asked[1:]
    figures = [f for f in read(name, "figures")["figures"]
               if fnmatch.fnmatch(f["sequence"] or "", pattern) and f["metric"] in metrics]
    values = {(f["sequence"] or "", f["variant"] or "", f["metric"]): number(f["value"]) for f in figures}
    units = {f["metric"]: f["unit"] for f in figures}
    if set(units) != set(metrics):
        sys.exit(f"results: docs/results/{name}.json has no {' '.join(set(metrics) - set(units))} of {pattern}")
    places = list(dict.fromkeys((f["sequence"] or "", f["variant"] or "") for f in figures))
    header = ["", "variant", *(f"{m} [{units[m]}]" if units[m] else m for m in metrics)]
    return markdown(header, [[*place, *(values.get((*place, m), "-") for m in metrics)] for place in places])


def images(name, plots, document):
    lines = []
    for plot in plots:
        file = IMAGES / name / f"{plot}.svg"
        if not file.is_file():
            raise NotKept
        lines += ["", f"![{name}: {plot.replace('_', ' ')}]({os.path.relpath(file, document.parent)})"]
    return lines[1:]


def ratio_in_text(name, metric, variant):
    try:
        entries = read(name, "ratios")["ratios"]
    except NotKept:
        return "-"
    of_all = [e for e in entries if e["sequence"] is None and (e["metric"], e["variant"]) == (metric, variant)]
    if not of_all:
        sys.exit(f"results: docs/results/{name}.json has no ratio of {metric} of {variant}")
    return cell(of_all[0])


KINDS = {"ratios": table_of_ratios, "starts": table_of_starts, "printed": printed_table, "runs": table_of_runs,
         "matrix": matrix, "figures": table_of_figures}


def filled(document, text):
    def anew(match):
        kind, name, words = match.group(1), match.group(2), match.group(3).split()
        try:
            lines = images(name, words, document) if kind == "plots" else KINDS[kind](name, words)
            kept = read(name)
            below = f"`{kept['command']}`, commit {kept['commit']}, {kept['date']}."
        except NotKept:
            lines, below = [], f"Nothing is kept yet: `tools/results.py make ... {name}` fills this."
        between = "\n".join([*lines, "", below] if lines else [below])
        return f"<!-- {kind} {name}{match.group(3)} -->\n{between}\n<!-- end -->"
    text = RATIO.sub(lambda m: f"<!-- ratio {' '.join(m.groups())} -->{ratio_in_text(*m.groups())}<!-- end -->", text)
    return TABLE.sub(anew, text)


# Writes the tables anew, or only tells which differ: exit status 1 where one does.
def fill(write):
    status = 0
    for document in documents():
        text = document.read_text()
        made = filled(document, text)
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
    taking = actions.add_parser("take")
    taking.add_argument("out", type=pathlib.Path)
    taking.add_argument("command")
    taking.add_argument("commit", nargs="?", default="HEAD")
    making = actions.add_parser("make")
    for name in ("--program", "--data"):
        making.add_argument(name, required=True)
    making.add_argument("--out", required=True, type=pathlib.Path)
    making.add_argument("--earlier")
    making.add_argument("--runs")
    making.add_argument("--only", action="append", default=[])
    making.add_argument("names", nargs="*", metavar="NAME")
    actions.add_parser("fill")
    actions.add_parser("check")
    asked = parser.parse_args()
    if asked.action == "take":
        take(asked.out, asked.command, asked.commit)
    elif asked.action == "make":
        more = (["--runs", asked.runs] if asked.runs else []) + [w for o in asked.only for w in ("--only", shlex.quote(o))]
        kept = sorted(file.stem for file in RESULTS.glob("*.json"))
        make(asked.program, asked.data, asked.out, asked.earlier, more, asked.names or kept)
    return fill(write=asked.action != "check")


if __name__ == "__main__":
    sys.exit(main())
