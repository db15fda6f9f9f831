#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Tests of tools/results.py on folders of its own."""
import json
import pathlib
import tempfile
import unittest

import results

PAGE = """Above.

<!-- runs one ate fps -->
<!-- end -->

<!-- printed one ate -->
<!-- end -->

<!-- matrix one ate -->
<!-- end -->

<!-- figures two all* gain -->
<!-- end -->

<!-- plots one path -->
<!-- end -->

In words <!-- ratio one ate b -->-<!-- end -->.
"""
RATIO = {"metric": "ate", "variant": "b", "sequence": None, "pairs": 4, "places": 2, "ratio": 0.5, "low": 0.4, "high": 0.6}
CELLS = {"centre": "median", "missing": ["tum/far (f; https://x)"], "failures": ["failed: s, b, 1 run: why"]}
TABLE = {**CELLS, "columns": [{"metric": "ate", "title": "ate [mm]"}],
         "rows": [{"sequence": "s", "variant": "a", "runs": "7, 3 the same", "cells": ["4.2 (4.0-4.4)"]},
                  {"sequence": "s", "variant": "b", "runs": "1 failed", "cells": ["-"]}],
         "printed": [{"metric": "ate", "title": "ate [mm]: P, Table 1", "note": "A note.",
                      "header": ["sequence", "a, paper", "a, ours", "runs"], "rows": [["s", "3", "4.2", "7"]]}]}
TIMES = {**CELLS, "columns": [{"metric": "fps", "title": "fps"}],
         "rows": [{"sequence": "s", "variant": v, "runs": "10", "cells": ["30"]} for v in "ab"]}


class Results(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.root = pathlib.Path(self.scratch.name)
        self.before = results.ROOT, results.RESULTS, results.IMAGES
        results.ROOT, docs = self.root, self.root / "docs"
        results.RESULTS, results.IMAGES = docs / "results", docs / "images" / "papers"
        self.page = docs / "papers" / "page.md"
        self.page.parent.mkdir(parents=True)
        self.page.write_text(PAGE)
        (self.root / "README.md").write_text("About.\n")

    def tearDown(self):
        results.ROOT, results.RESULTS, results.IMAGES = self.before

    # What a group of two experiments writes.
    def group(self, plot="<svg/>"):
        out = self.root / "out"
        for name, files in {"one": {"results.json": [{"experiment": "one", "sequence": "s", "variant": "a", "metric": "ate",
                                                      "value": 4.2, "unit": "mm"}],
                                    "table.json": TABLE, "timing_table.json": TIMES, "ratios.json": [RATIO]},
                            "two": {"results.json": [{"experiment": "two", "sequence": s, "variant": "v", "metric": "gain",
                                                      "value": 1.25, "unit": "px"} for s in ("all", "some")]}}.items():
            (out / name / "plots").mkdir(parents=True)
            for file, content in files.items():
                (out / name / file).write_text(json.dumps(content))
        (out / "one" / "plots" / "path.svg").write_text(plot)
        return out

    def record(self, out):
        for name, folder in results.experiments_in(out).items():
            results.record(name, folder, "plumbline experiment all", "abc")

    def test_an_experiment_of_times_alone_is_taken(self):
        out = self.root / "out"
        out.mkdir()
        (out / "results.json").write_text("[]")
        (out / "timing.json").write_text(json.dumps([{"experiment": "one", "sequence": "s", "variant": "a",
                                                      "metric": "track_ms", "value": 1.5, "unit": "ms"}]))
        self.assertEqual(results.experiments_in(out), {"one": out})

    def test_a_table_of_which_nothing_is_kept_says_so(self):
        self.assertEqual(results.fill(write=True), 0)
        self.assertIn("Nothing is kept yet: `tools/results.py make ... one` fills this.", self.page.read_text())
        self.assertEqual(results.fill(write=False), 0)

    def test_a_group_fills_all_tables_figures_and_ratios(self):
        self.record(self.group())
        self.assertEqual(results.fill(write=False), 1)
        results.fill(write=True)
        text = self.page.read_text()
        self.assertIn("| s | a | 7, 3 the same | 4.2 (4.0-4.4) | 30 |", text)
        self.assertIn("| s | 3 | 4.2 | 7 |", text)
        self.assertIn("| ate [mm] | s |", text)
        self.assertIn("| all | v | 1.25 |", text)
        self.assertNotIn("| some |", text)
        self.assertIn("](../images/papers/one/path.svg)", text)
        self.assertIn("In words <!-- ratio one ate b -->0.500 (0.400-0.600)<!-- end -->.", text)
        self.assertIn("- Not there: f; `experiment one --full` runs them where `--data` has them.", text)
        self.assertIn("- Failed: s, b, 1 run: why.", text)
        self.assertIn("`plumbline experiment all`, commit abc, ", text)
        self.assertNotIn("Nothing is kept", text)
        self.assertEqual(results.fill(write=False), 0)

    def test_tables_of_notes_are_filled(self):
        note = self.root / "lab" / "notes" / "note.md"
        note.parent.mkdir(parents=True)
        note.write_text("<!-- runs one ate -->\n<!-- end -->\n")
        self.record(self.group())
        results.fill(write=True)
        self.assertIn("| s | a | 7, 3 the same | 4.2 (4.0-4.4) |", note.read_text())

    def test_a_changed_figure_is_noticed(self):
        self.record(self.group())
        results.fill(write=True)
        self.page.write_text(self.page.read_text().replace("4.2 (4.0-4.4)", "4.1 (4.0-4.4)"))
        self.assertEqual(results.fill(write=False), 1)

    def test_of_single_figures_those_are_kept_that_documents_show(self):
        self.record(self.group())
        kept = json.loads((results.RESULTS / "two.json").read_text())
        self.assertEqual([f["sequence"] for f in kept["figures"]], ["all"])

    def test_large_plots_are_refused(self):
        with self.assertRaisesRegex(SystemExit, "expected at most 700000 bytes, found 700001"):
            self.record(self.group(plot="x" * 700_001))

    def test_a_metric_that_is_not_there_is_refused(self):
        self.record(self.group())
        self.page.write_text("<!-- runs one rpe -->\n<!-- end -->\n")
        with self.assertRaisesRegex(SystemExit, "one.json has no rpe"):
            results.fill(write=True)

    def test_commands_are_those_kept_or_of_the_name(self):
        self.record(self.group())
        self.assertEqual(results.command_of("one", []), "plumbline experiment all")
        self.assertEqual(results.command_of("all", ["--runs", "1"]), "plumbline experiment all --data DIR --runs 1")

    def test_an_experiment_that_computes_gets_no_options_of_runs(self):
        program, told = self.root / "program", self.root / "told"
        program.write_text(f'''#!/bin/sh
case "$*" in
  "experiment two --list") echo "needs no sequences; repeats: 10" ;;
  *--list) echo "sequences: worlds/room" ;;
  *) echo "$*" >> {told} ;;
esac
''')
        program.chmod(0o755)
        taken, results.take = results.take, lambda *_: None
        self.addCleanup(setattr, results, "take", taken)
        results.make(str(program), "data", self.root / "out", None, ["--runs", "1"], ["one", "two"])
        one, two = told.read_text().splitlines()
        self.assertIn("--cache", one)
        self.assertIn("--jobs 2", one)
        self.assertNotIn("--cache", two)
        self.assertNotIn("--jobs", two)


if __name__ == "__main__":
    unittest.main()
