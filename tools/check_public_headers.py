#!/usr/bin/env python3
"""Checks that the installed headers need nothing but the C++ library and Eigen.

    tools/check_public_headers.py INCLUDE_DIR COMPILER EIGEN_DIR

Compiles one file that includes every header and looks at what it read. Exit status: 0 clean, 1 a header
does not compile or reads something else (one a line), 2 no headers there.
"""
import pathlib
import subprocess
import sys


def main():
    include, compiler, eigen = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], sys.argv[3]
    headers = sorted(path.relative_to(include) for path in include.glob("plumbline/**/*.h"))
    if not headers:
        print(f"{include}: no headers")
        return 2
    command = [compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Werror", "-I", str(include)]
    source = "".join(f"#include <{header}>\n" for header in headers)
    # -H names every file read, one a line, with as many dots as its depth.
    done = subprocess.run([*command, "-isystem", eigen, "-H", "-x", "c++", "-"], input=source,
                          capture_output=True, text=True)
    if done.returncode != 0:
        print(done.stderr)
        return 1
    read = {line.lstrip(".").strip() for line in done.stderr.splitlines() if line.startswith(".")}
    builtin = subprocess.run([compiler, "-std=c++20", "-x", "c++", "-E", "-v", "-"], input="",
                             capture_output=True, text=True).stderr
    # The compiler's own folders but /usr/include itself, where every package puts its headers.
    own = [line.strip() for line in builtin.splitlines() if line.startswith(" /")]
    own = [str(pathlib.Path(folder).resolve()) for folder in own if folder != "/usr/include"]
    allowed = (str(include) + "/", str(pathlib.Path(eigen).resolve()) + "/",
               *(folder + "/" for folder in own))
    c_library = subprocess.run([compiler, "-x", "c++", "-std=c++20", "-M", "-"], text=True,
                               input="#include <bits/stdc++.h>\n#include <immintrin.h>\n",
                               capture_output=True).stdout
    standard = {str(pathlib.Path(name).resolve()) for name in c_library.split() if name.startswith("/")}
    foreign = sorted(path for path in (str(pathlib.Path(name).resolve()) for name in read)
                     if not path.startswith(allowed) and path not in standard)
    for path in foreign:
        print(f"read: {path}")
    return 1 if foreign else 0


if __name__ == "__main__":
    sys.exit(main())
