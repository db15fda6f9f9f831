# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""The types that editors and mypy see are those of the module."""
import ast
import inspect
import os
import pathlib
import subprocess

import pytest

import plumbline
from plumbline import _plumbline

PACKAGE = pathlib.Path(plumbline.__file__).parent
EXAMPLES = pathlib.Path(__file__).parents[2] / "examples" / "python"
STUB = ast.parse((PACKAGE / "_plumbline.pyi").read_text())


def checked(*command: str, folder: pathlib.Path) -> None:
    """Runs a tool of mypy's, which must have nothing to say against the package."""
    paths = os.pathsep.join([str(PACKAGE.parent), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(command, cwd=folder, text=True, capture_output=True, timeout=250,
                          env=os.environ | {"MYPYPATH": str(PACKAGE.parent), "PYTHONPATH": paths})
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_stub_has_the_names_of_the_module(tmp_path):
    # Classes of pybind11 have a metaclass of its own, and those that only the module makes a
    # constructor that takes anything, and refuses.
    known = tmp_path / "known.txt"
    classes = [node for node in STUB.body if isinstance(node, ast.ClassDef)
               and hasattr(_plumbline, node.name)]
    without = [node for node in classes if "__init__" not in [
        one.name for one in node.body if isinstance(one, ast.FunctionDef)]]
    known.write_text("".join(f"plumbline._plumbline.{node.name}\n" for node in classes)
                     + "".join(f"plumbline._plumbline.{node.name}.__init__\n" for node in without))
    checked("/usr/bin/stubtest", "plumbline._plumbline", "--allowlist", str(known),
            "--ignore-unused-allowlist", folder=tmp_path)


def test_the_package_and_the_examples_are_typed(tmp_path):
    files = sorted(EXAMPLES.glob("*.py"))
    assert len(files) == 5
    settings = tmp_path / "mypy.ini"
    # matplotlib and PIL of Debian 12 have no types.
    settings.write_text("[mypy]\nstrict = True\ncache_dir = cache\ndisallow_untyped_calls = False\n"
                        "warn_return_any = False\n"
                        "[mypy-matplotlib.*,PIL.*]\nignore_missing_imports = True\n"
                        "follow_imports = skip\n")
    checked("/usr/bin/mypy", "--config-file", str(settings), "-p", "plumbline", folder=tmp_path)
    checked("/usr/bin/mypy", "--config-file", str(settings), *map(str, files), folder=tmp_path)


def arguments_of(function: ast.FunctionDef) -> list[tuple[str, bool]]:
    """Names, and whether there is a default; self and the names of ** left out."""
    listed = function.args.args
    defaults = [False] * (len(listed) - len(function.args.defaults)) + \
        [True] * len(function.args.defaults)
    named = [(one.arg, default) for one, default in zip(listed, defaults) if one.arg != "self"]
    return named + ([("**", False)] if function.args.kwarg else [])


def told_by_the_module(docstring: str) -> list[tuple[str, bool]]:
    """The same from the first line that pybind11 gives a docstring."""
    head = docstring.splitlines()[0]
    inside = head[head.index("(") + 1:head.rindex(")", 0, head.find(" -> "))]
    parts, depth, part = [], 0, ""
    for character in inside:
        depth += (character in "[(<{") - (character in "])>}")
        if character == "," and depth == 0:
            parts.append(part)
            part = ""
        else:
            part += character
    parts.append(part)
    out = []
    for one in filter(None, (text.strip() for text in parts)):
        name = one.split(":")[0].split("=")[0].strip()
        if name.startswith("**"):
            out.append(("**", False))
        elif name != "self":
            out.append((name, "=" in one))
    return out


def functions():
    """Names of all functions and methods of the stub, with their definitions."""
    for node in STUB.body:
        if isinstance(node, ast.FunctionDef):
            yield node.name, getattr(_plumbline, node.name), node
        if isinstance(node, ast.ClassDef) and hasattr(_plumbline, node.name):
            owner = getattr(_plumbline, node.name)
            for one in node.body:
                if isinstance(one, ast.FunctionDef):
                    yield f"{node.name}.{one.name}", inspect.getattr_static(owner, one.name), one


CALLED = [(name, member, node) for name, member, node in functions()
          if not isinstance(member, property) and not name.endswith(("__len__", "__iter__"))
          and not name.startswith("_") and "._" not in name.replace("__", "")]


@pytest.mark.parametrize("name, member, node", CALLED, ids=[name for name, _, _ in CALLED])
def test_arguments_are_those_of_the_module(name, member, node):
    member = getattr(member, "__func__", member)
    assert arguments_of(node) == told_by_the_module(member.__doc__), name


def test_properties_are_told_as_such():
    named = [name for name, member, node in functions() if node.decorator_list
             and isinstance(node.decorator_list[0], ast.Name)
             and node.decorator_list[0].id == "property" and not isinstance(member, property)]
    assert named == []


@pytest.mark.parametrize("name", plumbline.__all__)
def test_everything_public_says_what_it_is(name):
    public = getattr(plumbline, name)
    if not isinstance(public, str):
        assert inspect.getdoc(public)
