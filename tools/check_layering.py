#!/usr/bin/env python3
"""Checks that the modules depend on each other only as the table LAYERS says.

The product is plumbline/MODULE, the renderer worlds/, the laboratory lab/MODULE. Three things must agree: the row of a module in LAYERS, the DEPS in its CMakeLists.txt, and what its
files include. Third-party headers may be included only where THIRD_PARTY says. Nor do pairs of files (a.h with a.cc) of the
product, worlds, laboratory, program and bindings go round in circles. Exit status: 0 clean, 1 violations (one a line, file:line).
"""
import pathlib
import re
import sys

# module -> modules it may include. Bottom to top: a name may only appear after it was defined, so that
# the table itself cannot describe a cycle.
LAYERS = {
    "base": [],
    "geometry": ["base"],
    "inertial": ["base", "geometry"],
    "solvers": ["base", "geometry"],
    "image": ["base", "geometry"],
    "optimization": ["base", "geometry"],
    "line_cutting": ["base", "geometry", "optimization"],
    "features": ["base", "geometry", "image"],
    "map": ["base", "geometry", "features"],
    "matching": ["base", "geometry", "features", "optimization", "line_cutting", "map"],
    "initialization": ["base", "geometry", "inertial", "image", "features", "optimization", "map",
                       "matching", "solvers"],
    "tracking": ["base", "geometry", "inertial", "image", "features", "optimization",
                 "line_cutting", "map", "matching", "solvers"],
    "mapping": ["base", "geometry", "image", "features", "optimization", "map", "matching"],
    "loop_closing": ["base", "geometry", "solvers", "features", "optimization", "map", "matching",
                     "mapping"],
    "slam": ["base", "geometry", "inertial", "image", "features", "optimization", "line_cutting",
             "map", "matching", "initialization", "tracking", "mapping", "loop_closing"],
    "io": ["base", "geometry", "inertial", "image", "features", "map"],
    "report": ["base", "geometry", "image", "features", "map", "io", "slam"],
    "viewer": ["base", "geometry", "image", "features", "map", "slam", "io"],
    "worlds": ["base", "geometry", "inertial", "image", "io"],
    "line_maps": ["base", "geometry", "io", "report", "worlds"],
    "consistency": ["base", "geometry", "features", "map", "matching", "optimization", "io",
                    "report", "worlds", "line_maps"],
    "line_rivals": ["base", "geometry", "map", "matching", "optimization", "tracking"],
    "rivals": ["base", "geometry", "features", "image", "map", "matching", "optimization",
               "solvers", "line_cutting", "initialization", "tracking", "slam", "line_rivals"],
    "ceres_reference": ["base", "geometry", "inertial", "optimization", "matching", "line_rivals"],
    "starts": ["base", "geometry", "image", "features", "map", "matching", "initialization", "io",
               "slam", "report"],
    "cutting_testbed": ["base", "geometry", "optimization", "line_cutting", "rivals"],
    "experiments": ["base", "geometry", "image", "features", "map", "matching", "initialization",
                    "optimization", "tracking", "io", "slam", "starts", "worlds", "report",
                    "line_maps", "consistency", "line_cutting", "cutting_testbed", "rivals"],
}
# The modules that are not in plumbline/, and where they are. The product includes none of them, and the
# worlds include nothing of the laboratory.
RENDERER = "worlds"
LABORATORY = {"line_maps", "consistency", "line_rivals", "rivals", "ceres_reference", "starts", "cutting_testbed", "experiments"}
# third-party prefix -> the files that may include it (regular expression; those of the product without
# plumbline/). Headers are left out but for those named here, so that nobody needs more than Eigen to include the library.
THIRD_PARTY = {
    "CLI/": None,
    "benchmark/": None,
    "boost/": r"viewer/web_server\.cc|lab/experiments/paired_(ratios|starts)\.cc",
    "ceres/": r"lab/ceres_reference/ceres_\w+\.(h|cc)",
    "coin/": r"lab/cutting_testbed/ipopt_\w+\.cc",
    "embree3/": r"worlds/\w+\.cc",
    "fmt/": r"(\w+/)+\w+\.cc",
    "gmock/": None,
    "gtest/": None,
    "nlopt": r"lab/cutting_testbed/nlopt_\w+\.cc",
    "nlohmann/": r"(io/\w+|report|viewer|lab/experiments|lab/line_maps|lab/consistency)/\w+\.cc",
    "opencv2/": r"image/(opencv_bridge|opencv_modules|image_codecs|plain_png)\.h|"
                r"(image|features|initialization|io/\w+|io|report|viewer)/\w+\.cc",
    "yaml-cpp/": r"((base|io/cameras|io)/\w+|lab/experiments/(printed_figures|gate))\.cc",
    "libavcodec/": r"image/video_decoder_library\.cc",
    "libavformat/": r"image/video_decoder_library\.cc",
    "libavutil/": r"image/video_decoder_library\.cc",
    "libswscale/": r"image/video_decoder_library\.cc",
    "libdeflate.h": r"(base/crc32|image/plain_png)\.cc",
    "spng.h": r"image/image_codecs\.cc",
    "turbojpeg.h": r"image/image_codecs\.cc",
    "webp/": r"image/image_codecs\.cc",
    "bzlib.h": r"io/recordings/compression\.cc",
    "lz4": r"io/recordings/compression\.cc",
    "sqlite3.h": r"io/recordings/sqlite_bag\.cc",
    "zstd.h": r"io/(map_file/section_file|recordings/(compression|mcap_file_writer))\.cc",
}
# Headers of the library that bring a heavy third-party header along: for .cc files only.
HEAVY_HEADERS = {
    "plumbline/image/image_codecs.h",
    "plumbline/image/opencv_bridge.h",
    "plumbline/image/opencv_modules.h",
    "plumbline/image/plain_png.h",
    "lab/ceres_reference/ceres_manifolds.h",
    "lab/ceres_reference/ceres_terms.h",
}

INCLUDE = re.compile(r'\s*#\s*include\s+["<]([^">]+)[">]')
MODULE = re.compile(r"plumbline_module\(\s*NAME\s+(\w+)(.*?)\)", re.DOTALL)
KEYWORDS = {"SOURCES", "DEPS", "PUBLIC", "PRIVATE", "ALONE", "QUICKLY"}


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


def folder_of(module):
    """Where a module is, relative to the repository."""
    if module == RENDERER:
        return module
    return f"lab/{module}" if module in LABORATORY else f"plumbline/{module}"


def module_of(target):
    """The module that an included file of ours belongs to; None for other files."""
    first, *rest = target.split("/")
    if first == RENDERER:
        return first
    return rest[0] if first in ("plumbline", "lab") and len(rest) > 1 else None


def part_problems():
    """The table itself keeps product, worlds and laboratory apart."""
    for module, allowed in LAYERS.items():
        part = folder_of(module).split("/")[0]
        beyond = {"plumbline": LABORATORY | {RENDERER}, "worlds": LABORATORY, "lab": set()}[part]
        for other in sorted(beyond & set(allowed)):
            yield f"tools/check_layering.py: {folder_of(module)} may not depend on {folder_of(other)}"


def cmake_problems(root, module):
    where = f"{folder_of(module)}/CMakeLists.txt"
    path = root / where
    if not path.is_file():
        yield f"{folder_of(module)}: no CMakeLists.txt"
        return
    targets = dict(declared_dependencies(path.read_text()))
    row = set(LAYERS[module])
    if module not in targets:
        yield f"{where}: defines no module {module}"
    for target, dependencies in targets.items():
        if target == module and dependencies != row:
            yield (f"{where}: DEPS {sorted(dependencies)}, but the table of "
                   f"tools/check_layering.py says {sorted(row)}")
        if target != module and not dependencies <= row | {module}:
            yield f"{where}: {target} may not depend on {sorted(dependencies - row - {module})}"


def include_problems(path, where, module):
    relative = where.removeprefix("plumbline/")
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        target, place = match[1], f"{where}:{number}"
        other = module_of(target)
        if other is not None:
            if other != module and other not in LAYERS[module]:
                yield f"{place}: {module} may not include {other}"
            if target in HEAVY_HEADERS and path.suffix == ".h":
                yield f"{place}: {target} may be included in .cc files only"
        elif target.startswith(("apps/", "tests/")):
            yield f"{place}: the library may not include {target}"
        for prefix, users in THIRD_PARTY.items():
            if target.startswith(prefix) and not (users and re.fullmatch(users, relative)):
                yield f"{place}: {target} is not allowed here"


PAIRED = ("plumbline", RENDERER, "lab", "apps", "python")


# The pairs of files that each pair includes: path without suffix -> paths without suffixes.
def included_pairs(root):
    pairs = {}
    for path in (p for folder in PAIRED for p in (root / folder).rglob("*")):
        if path.suffix not in (".h", ".cc"):
            continue
        pair = path.relative_to(root).with_suffix("").as_posix()
        found = (INCLUDE.match(line) for line in path.read_text().splitlines())
        others = {match[1].removesuffix(".h") for match in found if match}
        pairs.setdefault(pair, set()).update(others - {pair})
    return pairs


# Takes away what includes nothing that is left, again and again: what remains is in a circle or above one.
def pair_problems(root):
    pairs = included_pairs(root)
    while True:
        ends = {pair for pair, others in pairs.items() if not others & pairs.keys()}
        if not ends:
            break
        pairs = {pair: others for pair, others in pairs.items() if pair not in ends}
    included = set().union(*pairs.values())
    for pair in sorted(pairs.keys() & included):
        yield f"{pair}: includes itself by way of {sorted(pairs[pair] & pairs.keys())}"


def problems(root):
    yield from pair_problems(root)
    yield from table_problems()
    yield from part_problems()
    folders = {module_of(path.relative_to(root).as_posix() + "/x")
               for parent in ("plumbline", "lab") for path in (root / parent).iterdir() if path.is_dir() and path.name not in ("bench", "notes")}
    folders |= {RENDERER} if (root / RENDERER).is_dir() else set()
    for module in sorted(folders - LAYERS.keys()):
        yield f"{folder_of(module)}: has no row in the table of tools/check_layering.py"
    for module in sorted(LAYERS.keys() - folders):
        yield f"tools/check_layering.py: there is no {folder_of(module)}"
    for module in sorted(folders & LAYERS.keys()):
        yield from cmake_problems(root, module)
        for path in sorted((root / folder_of(module)).rglob("*")):
            if path.suffix in (".h", ".cc"):
                yield from include_problems(path, path.relative_to(root).as_posix(), module)


if __name__ == "__main__":
    found = list(problems(pathlib.Path(__file__).resolve().parent.parent))
    print("\n".join(found))
    sys.exit(1 if found else 0)
