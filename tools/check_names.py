#!/usr/bin/env python3
"""Checks that no name is left that tools/names.txt says has another one now.

A row `word OLD NEW [FOLDER...]` is about an identifier in all files, or in those folders alone; OLD with a dot before it is a
member. `file OLD NEW` is about a source file, `folder OLD NEW` about a module. CHANGELOG.md and lab/notes tell of the past and are
left out. Exit status: 0 clean, 1 old names are left (one a line, file:line).
"""
import pathlib
import re
import subprocess
import sys

NAMES = "tools/names.txt"
PAST = ("CHANGELOG.md", NAMES, "lab/notes/")


def rules(root):
    for line in (root / NAMES).read_text().splitlines():
        kind, *parts = line.split() or ["#"]
        if kind == "word":
            old, new, *folders = parts
            pattern = rf"(?<=\.|>|:){old[1:]}\b" if old.startswith(".") else rf"\b{old}\b"
        elif kind == "file":
            old, new, folders = *parts, []
            module, name = pathlib.PurePath(old).parts[-2:]
            pattern = rf"\b{module}/{name}\.(?:h|cc)\b|\btests/[\w/]+/{name}_test\.cc\b"
        elif kind == "folder":
            old, new, folders = *parts, []
            pattern = rf"\b(?:plumbline|tests)/{old}(?![\w.-])|\bplumbline::{old}\b(?!::)"
        else:
            continue
        yield pathlib.PurePath(old).name.lstrip("."), re.compile(pattern), new, tuple(folders)


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    all_rules = list(rules(root))
    problems = 0
    files = subprocess.run(["git", "ls-files"], cwd=root, capture_output=True, text=True, check=True)
    for name in files.stdout.splitlines():
        path = root / name
        if name.startswith(PAST) or path.is_symlink() or not path.is_file():
            continue
        try:
            text = path.read_text()
        except UnicodeDecodeError:
            continue
        words = set(re.findall(r"[A-Za-z]\w*", text))
        here = [(pattern, new) for old, pattern, new, folders in all_rules
                if (old in words or f"{old}_test" in words)
                and (not folders or any(name == f or name.startswith(f + "/") for f in folders))]
        for number, line in enumerate(text.splitlines() if here else [], 1):
            for pattern, new in here:
                found = pattern.search(line)
                if found:
                    print(f"{name}:{number}: {found[0]} is called {new} now")
                    problems += 1
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
