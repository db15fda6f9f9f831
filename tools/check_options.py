#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Counts the options of a run: few enough to know. One more is for what a user's situation, a measurement or an
experiment asks for; everything else is a constant with its reason. Those of the papers' presets, which stand under a
heading of their own in `config --all`, are counted apart.

    tools/check_options.py PROGRAM
"""

import re
import subprocess
import sys

MOST_OF_USERS = 30
MOST = 50  # of users and methods together
MOST_OF_PAPERS = 30
OPTION = re.compile(r"^ *[\w.]+: \S.*  # ", re.MULTILINE)  # a group has no value
PAPERS = "\n# Of the papers' presets"


def config(program, *arguments):
    return subprocess.run([program, "config", *arguments], check=True, capture_output=True, text=True).stdout


def count(text):
    return len(OPTION.findall(text))


def main(program):
    ours, heading, papers = config(program, "--all").partition(PAPERS)
    users, total, of_papers = count(config(program)), count(ours), count(papers)
    print(f"{total} options, {users} of them for users, and {of_papers} of the papers' presets")
    if not heading:
        sys.exit(f"expected '{PAPERS.strip()}' in config --all")
    if not (0 < users <= MOST_OF_USERS and users < total <= MOST and 0 < of_papers <= MOST_OF_PAPERS):
        sys.exit(f"expected at most {MOST} options, {MOST_OF_USERS} of them for users, and {MOST_OF_PAPERS} of papers")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
