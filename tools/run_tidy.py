#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""clang-tidy with the settings of .clang-tidy on all that a folder compiles.

  tools/run_tidy.py BUILD [PART...]     BUILD: configured by `cmake --preset tidy`; only files whose paths have a PART

Files that are compiled together are looked at together, which takes a tenth of the time. Exit status 1 where clang-tidy has
found something.
"""
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys

# Notes and counts of what was left out say nothing by themselves, and what includes the files that are compiled together is
# CMake's.
FINDING = re.compile(r"^\S+:\d+:\d+: (?:error|warning): .*$", re.MULTILINE)


def findings_of(build, source):
    run = subprocess.run(["clang-tidy", "-p", build, "--quiet", source], text=True, capture_output=True)
    found = FINDING.findall(run.stdout)
    if run.returncode != 0 and not found:
        return [f"{source}: clang-tidy failed: {(run.stdout + run.stderr).strip()[-400:]}"]
    return [line for line in found if "/Unity/unity_" not in line.split(":")[0]]


def main(build, *parts):
    commands = json.loads((pathlib.Path(build) / "compile_commands.json").read_text())
    sources = sorted({c["file"] for c in commands if not parts or any(p in c["file"] for p in parts)})
    found = set()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for lines in pool.map(lambda s: findings_of(build, s), sources):
            found.update(lines)
    print("\n".join(sorted(found)) if found else f"clang-tidy: nothing found in {len(sources)} files")
    return 1 if found or not sources else 0


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
