# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""The package as users install it: the files of python3-plumbline; with PLUMBLINE_LONG set, by pip and ./demo."""
import os
import pathlib
import subprocess

import pytest

import plumbline

ROOT = pathlib.Path(__file__).parents[2]
BUILD = pathlib.Path(plumbline.__file__).parents[2]
long = pytest.mark.skipif(not os.environ.get("PLUMBLINE_LONG"), reason="PLUMBLINE_LONG is not set")
SCRIPT = ("import sys, plumbline; print(plumbline.__file__, "
          "plumbline.run(sys.argv[1], stop=3))")


def said(*command: object, **changes: str) -> str:
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"} | changes
    done = subprocess.run([str(one) for one in command], text=True, capture_output=True,
                          env=environment, cwd="/")
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_component_python_is_the_whole_package(sequence, tmp_path):
    said("cmake", "--install", BUILD, "--component", "python", "--prefix", tmp_path)
    package = tmp_path / "lib" / "python3" / "dist-packages" / "plumbline"
    files = sorted(path.name for path in package.iterdir())
    assert {"__init__.py", "_plumbline.pyi", "py.typed"} < set(files)
    documents = tmp_path / "share" / "doc" / "python3-plumbline"
    assert not [path for path in tmp_path.rglob("*")
                if path.is_file() and path.parent not in (package, documents)]
    out = said("/usr/bin/python3", "-c", SCRIPT, sequence, PYTHONPATH=str(package.parent))
    assert out.startswith(str(package)) and "3 of 3 frames tracked" in out


@long
def test_pip_installs_it_into_an_environment(sequence, tmp_path):
    said("/usr/bin/python3", "-m", "venv", "--system-site-packages", tmp_path / "V")
    said(tmp_path / "V" / "bin" / "pip", "install", "--no-build-isolation", "--no-deps", ROOT)
    out = said(tmp_path / "V" / "bin" / "python", "-c", SCRIPT, sequence)
    assert out.startswith(str(tmp_path / "V")) and "3 of 3 frames tracked" in out
    shown = said(tmp_path / "V" / "bin" / "pip", "show", "plumbline")
    assert f"Version: {plumbline.__version__}\n" in shown


@long
def test_the_demo_makes_a_first_run(sequence):
    out = said(ROOT / "demo", "--python", sequence)
    assert "12 of 12 frames tracked" in out
    environment = ROOT / "build" / "venv" / "bin" / "python"
    assert said(environment, "-c", "import plumbline; print(plumbline.__version__)")
