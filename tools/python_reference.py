#!/usr/bin/env python3
"""Prints the reference of the package for Python as a page in Markdown, made of its docstrings.

    PYTHONPATH=build/release/python tools/python_reference.py

Public names without a docstring are errors; plain data of a described class may go without. Exit status: 0 printed,
1 errors (one a line, on stderr).
"""
import inspect
import sys

import plumbline


def parts_of(value, name):
    """The signature and the description. Functions in C++ have it in their first line, of each overload in one."""
    text = inspect.getdoc(value) or ""
    lines = text.splitlines()
    typed = [line for line in lines if line.startswith(f"{name}(") and " -> " in line]
    if typed:  # the readable signature, if there is one, is the line behind the typed one
        rest = [line for line in lines if line not in typed]
        while rest and not rest[0].strip():
            rest.pop(0)
        if rest and rest[0].startswith(f"{name}("):
            return rest[0], "\n".join(rest[1:]).strip()
        return typed[0], "\n".join(rest).strip()
    try:
        signature = f"{name}{inspect.signature(value)}" if callable(value) and not inspect.isclass(value) else name
    except ValueError:
        signature = name
    return signature, text.strip()


def block(signature, description):
    lines = [line for line in (signature, "", description) if line or description]
    return "```text\n" + "\n".join(lines) + "\n```\n"


def members(cls):
    for name, value in vars(cls).items():
        if name in ("__init__", "__getitem__") or not name.startswith("_"):
            yield name, value


def page(problems):
    yield "# Reference of the package for Python\n"
    yield f"`import plumbline`, version {plumbline.__version__}. [How it is used](python.md).\n"
    yield "```text\n" + inspect.getdoc(plumbline) + "\n```\n"
    for name in sorted(plumbline.__all__, key=str.lower):
        value = getattr(plumbline, name)
        if isinstance(value, str):
            continue
        signature, description = parts_of(value, name)
        if not description:
            problems.append(f"plumbline.{name} has no docstring")
        yield f"## {name}\n"
        yield block(signature, description)
        for member, inner in members(value) if inspect.isclass(value) else []:
            signature, description = parts_of(inner, member)
            if not description and callable(inner) and not member.startswith("__"):
                problems.append(f"plumbline.{name}.{member} has no docstring")
            if member.startswith("__") and description == (inspect.getdoc(getattr(object, member, None)) or ""):
                continue
            yield f"### {name}.{member}\n"
            yield block(signature, description)


def main():
    problems = []
    text = "\n".join(page(problems))
    print("\n".join(problems), file=sys.stderr, end="\n" if problems else "")
    if not problems:
        print(text)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
