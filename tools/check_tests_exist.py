#!/usr/bin/env python3
"""Checks that every plumbline/x/y.cc has a tests/x/y_test.cc that is built.

Exceptions are listed in tools/untested_sources.txt, one a line: the source, then why. An entry that is
not needed any more is an error too. Exit status: 0 clean, 1 problems (one a line).
"""
import pathlib
import sys

EXCEPTIONS = "tools/untested_sources.txt"


def read_exceptions(root):
    """source -> reason, and problems of the list itself."""
    exceptions, found = {}, []
    for number, line in enumerate((root / EXCEPTIONS).read_text().splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        source, _, reason = line.strip().partition(" ")
        if not reason.strip():
            found.append(f"{EXCEPTIONS}:{number}: {source} has no reason")
        if not (root / source).is_file():
            found.append(f"{EXCEPTIONS}:{number}: there is no {source}")
        exceptions[source] = number
    return exceptions, found


def problems(root):
    exceptions, found = read_exceptions(root)
    yield from found
    for path in sorted((root / "plumbline").rglob("*.cc")):
        source = path.relative_to(root)
        test = pathlib.Path("tests") / source.relative_to("plumbline").with_suffix("")
        test = test.with_name(test.name + "_test.cc")
        exists = (root / test).is_file()
        if not exists and source.as_posix() not in exceptions:
            yield f"{source}: {test} is missing"
        if exists and source.as_posix() in exceptions:
            yield f"{EXCEPTIONS}:{exceptions[source.as_posix()]}: {test} exists now"
    for test in sorted((root / "tests").rglob("*_test.cc")):
        listing = test.parent / "CMakeLists.txt"
        if not listing.is_file() or test.name not in listing.read_text().split():
            yield f"{test.relative_to(root)}: not built, {listing.relative_to(root)} does not list it"


if __name__ == "__main__":
    found = list(problems(pathlib.Path(__file__).resolve().parent.parent))
    print("\n".join(found))
    sys.exit(1 if found else 0)
