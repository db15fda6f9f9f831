#!/usr/bin/env python3
"""Checks that the modules depend on each other only as the table LAYERS says.

Three things must agree: the row of a module in LAYERS, the DEPS in its CMakeLists.txt, and what its
files include. Third-party headers may be included only where THIRD_PARTY says. Exit status: 0 clean,
1 violations (one a line, file:line).
"""
import pathlib
import re
import sys

# module -> modules it may include. Bottom to top: a name may only appear after it was defined, so that
# the table itself cannot describe a cycle.
LAYERS = {
    "base": [],
    "geometry": ["base"],
    "solvers": ["base", "geometry"],
    "image": ["base", "geometry"],
    "optimization": ["base", "geometry"],
    "cutting": ["base", "geometry", "optimization"],
    "features": ["base", "geometry", "image"],
    "place": ["base", "geometry", "features"],
    "map": ["base", "geometry", "features"],
    "association": ["base", "geometry", "features", "optimization", "cutting", "map"],
    "initialization": ["base", "geometry", "image", "features", "optimization", "map",
                       "association", "solvers"],
    "tracking": ["base", "geometry", "features", "optimization", "cutting", "map", "association",
                 "solvers"],
    "mapping": ["base", "geometry", "features", "optimization", "map", "association"],
    "loop": ["base", "geometry", "solvers", "features", "optimization", "map", "association",
             "mapping"],
    "slam": ["base", "geometry", "image", "features", "optimization", "cutting", "map",
             "association", "initialization", "tracking", "mapping", "place", "loop"],
    "recording": ["base"],
    "io": ["base", "geometry", "image", "features", "map", "recording"],
    "live": ["base", "geometry", "image", "io"],
    "starts": ["base", "geometry", "image", "features", "map", "association", "initialization", "io",
               "slam"],
    "synth": ["base", "geometry", "image", "io"],
    "eval": ["base", "geometry"],
    "report": ["base", "geometry", "image", "features", "map", "io", "slam", "eval"],
    "cutting_testbed": ["base", "geometry", "optimization", "cutting"],
    "experiments": ["base", "geometry", "image", "features", "map", "association", "initialization",
                    "io", "slam", "starts", "synth", "eval", "cutting", "cutting_testbed"],
}
# third-party prefix -> the files of plumbline/ that may include it (regular expression). Headers are
# left out but for three, so that nobody needs more than Eigen and fmt to include the library.
THIRD_PARTY = {
    "CLI/": None,
    "benchmark/": None,
    "ceres/": r"optimization/ceres_\w+\.(h|cc)",
    "coin/": r"cutting_testbed/ipopt_\w+\.cc",
    "embree3/": r"synth/\w+\.cc",
    "fmt/": r"base/log\.h|\w+/\w+\.cc",
    "gmock/": None,
    "gtest/": None,
    "nlopt": r"cutting_testbed/nlopt_\w+\.cc",
    "nlohmann/": r"(io|eval|report|experiments)/\w+\.cc",
    "opencv2/": r"image/opencv_bridge\.h|"
                r"(image|features|initialization|io|live|report)/\w+\.cc",
    "spdlog/": r"base/log\.cc",
    "yaml-cpp/": r"(base|io)/\w+\.cc",
    "bzlib.h": r"recording/compression\.cc",
    "lz4": r"recording/compression\.cc",
    "zstd.h": r"(io/section_file|recording/compression)\.cc",
}
# Headers of the library that bring a heavy third-party header along: for .cc files only.
HEAVY_HEADERS = {
    "plumbline/image/opencv_bridge.h",
    "plumbline/optimization/ceres_manifolds.h",
    "plumbline/optimization/ceres_terms.h",
}

INCLUDE = re.compile(r'\s*#\s*include\s+["<]([^">]+)[">]')
MODULE = re.compile(r"plumbline_module\(\s*NAME\s+(\w+)(.*?)\)", re.DOTALL)
KEYWORDS = {"SOURCES", "DEPS", "PUBLIC", "PRIVATE"}


def table_problems():
    seen = set()
    for module, allowed in LAYERS.items():
        unknown = sorted(set(allowed) - seen)
        if unknown:
            yield f"tools/check_layering.py: {module} names {unknown} before they are defined"
        seen.add(module)


def declared_dependencies(text):
    """(target name, set of DEPS) for every plumbline_module() of a CMakeLists.txt."""
    for match in MODULE.finditer(re.sub(r"#.*", "", text)):
        dependencies, keyword = set(), None
        for word in match[2].split():
            if word in KEYWORDS:
                keyword = word
            elif keyword == "DEPS":
                dependencies.add(word)
        yield match[1], dependencies


def cmake_problems(folder, module):
    path = folder / "CMakeLists.txt"
    if not path.is_file():
        yield f"plumbline/{module}: no CMakeLists.txt"
        return
    targets = dict(declared_dependencies(path.read_text()))
    row = set(LAYERS[module])
    where = f"plumbline/{module}/CMakeLists.txt"
    if module not in targets:
        yield f"{where}: defines no module {module}"
    for target, dependencies in targets.items():
        if target == module and dependencies != row:
            yield (f"{where}: DEPS {sorted(dependencies)}, but the table of "
                   f"tools/check_layering.py says {sorted(row)}")
        if target != module and not dependencies <= row | {module}:
            yield f"{where}: {target} may not depend on {sorted(dependencies - row - {module})}"


def include_problems(path, relative, module):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        target, where = match[1], f"plumbline/{relative}:{number}"
        if target.startswith("plumbline/"):
            other = target.split("/")[1]
            if other != module and other not in LAYERS[module]:
                yield f"{where}: {module} may not include {other}"
            if target in HEAVY_HEADERS and path.suffix == ".h":
                yield f"{where}: {target} may be included in .cc files only"
        elif target.startswith(("apps/", "tests/")):
            yield f"{where}: the library may not include {target}"
        for prefix, users in THIRD_PARTY.items():
            if target.startswith(prefix) and not (users and re.fullmatch(users, relative)):
                yield f"{where}: {target} is not allowed here"


def problems(root):
    yield from table_problems()
    library = root / "plumbline"
    folders = {path.name for path in library.iterdir() if path.is_dir()}
    for module in sorted(folders - LAYERS.keys()):
        yield f"plumbline/{module}: has no row in the table of tools/check_layering.py"
    for module in sorted(LAYERS.keys() - folders):
        yield f"tools/check_layering.py: there is no plumbline/{module}"
    for module in sorted(folders & LAYERS.keys()):
        yield from cmake_problems(library / module, module)
        for path in sorted((library / module).rglob("*")):
            if path.suffix in (".h", ".cc"):
                relative = path.relative_to(library).as_posix()
                yield from include_problems(path, relative, module)


if __name__ == "__main__":
    found = list(problems(pathlib.Path(__file__).resolve().parent.parent))
    print("\n".join(found))
    sys.exit(1 if found else 0)
