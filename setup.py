# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Builds the compiled module with CMake, in build/release, and hands it to setuptools."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import setuptools
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent
BUILD = ROOT / "build" / "release"


def version() -> str:
    """The version that CMakeLists.txt names."""
    text = (ROOT / "CMakeLists.txt").read_text()
    return re.search(r"project\(plumbline VERSION ([0-9.]+)", text).group(1)


class CMakeBuild(build_ext):
    """Configures build/release as ./demo does, where it is not there yet, and builds the module."""

    def build_extension(self, extension):
        if os.path.realpath(sys.executable) != os.path.realpath("/usr/bin/python3"):
            raise SystemExit("setup.py: the module is built for /usr/bin/python3, Debian's; make the "
                             f"environment with it, found {sys.executable}")
        if (BUILD / "CMakeCache.txt").exists():  # keeps its settings
            configure = ["cmake", BUILD]
        else:
            configure = ["cmake", "--preset", "release", "-DPLUMBLINE_TESTS=OFF",
                         "-DPLUMBLINE_WERROR=OFF"]
        subprocess.run([*configure, "-DPLUMBLINE_PYTHON=ON", "-DPLUMBLINE_WORLDS=ON"], cwd=ROOT, check=True,
                       stdout=subprocess.DEVNULL)
        subprocess.run(["cmake", "--build", BUILD, "--target", "plumbline_python"], cwd=ROOT,
                       check=True)
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        for name in (target.name, "libplumbline_opencv.so"):
            shutil.copy2(BUILD / "python" / "plumbline" / name, target.parent / name)


setuptools.setup(
    version=version(),
    ext_modules=[setuptools.Extension("plumbline._plumbline", [])],
    cmdclass={"build_ext": CMakeBuild},
)
