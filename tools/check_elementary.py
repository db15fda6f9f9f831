#!/usr/bin/env python3
"""Checks that the library computes sines, logarithms and the like by plumbline/base/elementary.h.

    tools/check_elementary.py          lists what the C library or Eigen computes instead
    tools/check_elementary.py --fix    replaces std::sin by math::Sin, and so on; then tools/format.sh

Those of the C library, and what calls them, differ in the last digit from one processor to another.
Exit status: 0 clean, 1 problems (one a line, file:line).
"""
import pathlib
import re
import sys

HEADER = '#include "plumbline/base/elementary.h"'
OURS = ["sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "expm1", "tanh", "log", "log1p",
        "log10", "pow", "cbrt", "hypot"]
NOT_OURS = ["sincos", "sinh", "cosh", "asinh", "acosh", "atanh", "exp2", "exp10", "log2", "erf",
            "erfc", "tgamma", "lgamma", "polar"]
OURS_CALL = re.compile(rf"\bstd::({'|'.join(OURS)})\(")
# Each with what to use instead.
FORBIDDEN = [
    (OURS_CALL, "math:: of plumbline/base/elementary.h"),
    # Neither a member nor the declaration of a variable, as in `std::ifstream log(path)`.
    (re.compile(rf"(?:(?<![\w:.>] )|(?<=return ))(?<![\w:.>])(?:std::|::)?"
                rf"({'|'.join(OURS + NOT_OURS)})[fl]?\("), "math:: of plumbline/base/elementary.h"),
    (re.compile(rf"\bstd::({'|'.join(OURS + NOT_OURS)})[fl]?\("),
     "math:: of plumbline/base/elementary.h"),
    (re.compile(rf"\.({'|'.join(OURS)})\(\)"), "a loop over math:: of plumbline/base/elementary.h"),
    (re.compile(r"\b(AngleAxis[df]?|Rotation2D[df]?)\b"), "ExpSo3 of plumbline/geometry/se3.h"),
    (re.compile(r"\.(slerp|angularDistance|eulerAngles)\("), "plumbline/geometry/se3.h"),
    (re.compile(r"\bstd::(\w+_distribution)\b"), "Rng of plumbline/base/random.h"),
]


def without_comment(line):
    return line.split("//")[0]


def problems(path, root):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        for pattern, instead in FORBIDDEN:
            found = pattern.search(without_comment(line))
            if found:
                yield f"{path.relative_to(root)}:{number}: {found.group(1)}; use {instead}"
                break


def fix(path):
    lines = path.read_text().split("\n")
    replaced = [OURS_CALL.sub(lambda m: f"math::{m.group(1).capitalize()}(", without_comment(line)) +
                line[len(without_comment(line)):] for line in lines]
    if replaced == lines:
        return
    if HEADER not in replaced:
        ours = [i for i, line in enumerate(replaced) if line.startswith('#include "plumbline/')]
        pragma = [i for i, line in enumerate(replaced) if line == "#pragma once"]
        replaced.insert((ours or pragma)[-1] + 1, "\n" * (len(ours) <= 1) + HEADER)
    path.write_text("\n".join(replaced))


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    files = sorted(path for folder in ("plumbline", "worlds", "lab", "apps")
                   for path in (root / folder).rglob("*")
                   if path.suffix in (".h", ".cc") and path.name != "elementary.cc"
                   and root / "lab" / "bench" not in path.parents)  # measures, makes no results
    if sys.argv[1:] == ["--fix"]:
        for path in files:
            fix(path)
    found = [problem for path in files for problem in problems(path, root)]
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
