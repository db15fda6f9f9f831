#!/usr/bin/env python3
"""Checks that every plumbline/x/y.cc and plumbline/x/z/y.cc has a tests/x/y_test.cc, every worlds/y.cc a
tests/worlds/y_test.cc and every lab/x/y.cc a tests/lab/x/y_test.cc, and that every test file is built.
Benchmarks (lab/bench) have no tests.

Sources that another file tests are listed with that file in tools/tests_elsewhere.txt; an entry that
is not needed any more is an error too. Exit status: 0 clean, 1 problems (one a line).
"""
import pathlib
import sys

ELSEWHERE = "tools/tests_elsewhere.txt"


def read_elsewhere(root):
    """source -> line number in the list, and problems of the list itself."""
    listed, found = {}, []
    for number, line in enumerate((root / ELSEWHERE).read_text().splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        source, _, test = line.strip().partition(" ")
        for path in (source, test.strip()):
            if not (root / path).is_file():
                found.append(f"{ELSEWHERE}:{number}: there is no {path}")
        listed[source] = number
    return listed, found


def problems(root):
    elsewhere, found = read_elsewhere(root)
    yield from found
    for path in sorted(path for part in ("plumbline", "worlds", "lab")
                       for path in (root / part).rglob("*.cc")):
        source = path.relative_to(root)
        if source.parts[:2] == ("lab", "bench"):
            continue
        folders = source.parts[1:2] if source.parts[0] == "plumbline" else source.parts[:-1]
        test = pathlib.Path("tests", *folders, source.name)
        test = test.with_suffix("")
        test = test.with_name(test.name + "_test.cc")
        exists = (root / test).is_file()
        number = elsewhere.get(source.as_posix())
        if not exists and number is None:
            yield f"{source}: {test} is missing"
        if exists and number is not None:
            yield f"{ELSEWHERE}:{number}: {test} exists"
    for test in sorted((root / "tests").rglob("*_test.cc")):
        listing = test.parent / "CMakeLists.txt"
        words = listing.read_text().replace(")", " ").split() if listing.is_file() else []
        if test.name not in words:
            yield f"{test.relative_to(root)}: not built, {listing.relative_to(root)} does not list it"


if __name__ == "__main__":
    found = list(problems(pathlib.Path(__file__).resolve().parent.parent))
    print("\n".join(found))
    sys.exit(1 if found else 0)
