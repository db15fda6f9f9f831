#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Counts the options of a run: few enough to know. One more is for what a measurement, an experiment, a test or a
user needs to set; everything else is a constant with its reason.

    tools/check_options.py PROGRAM
"""

import re
import subprocess
import sys

MOST_OF_ALL = 110
MOST_OF_USERS = 35
OPTION = re.compile(r"^ *\w+: \S.*  # ", re.MULTILINE)  # a group has no value


def count(program, *arguments):
    return len(OPTION.findall(subprocess.run([program, "config", *arguments], check=True, capture_output=True,
                                             text=True).stdout))


def main(program):
    users, all_of_them = count(program), count(program, "--all")
    print(f"{all_of_them} options, {users} of them for users")
    if not 0 < users <= MOST_OF_USERS or not users < all_of_them <= MOST_OF_ALL:
        sys.exit(f"expected at most {MOST_OF_ALL} options, {MOST_OF_USERS} of them for users")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
