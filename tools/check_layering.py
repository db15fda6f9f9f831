#!/usr/bin/env python3
"""Fails when a plumbline module includes something its row of LAYERS does not allow.

Run from the repository root. Exit status: 0 clean, 1 violations (one per line, file:line).
"""
import pathlib
import re
import sys

# module -> modules it may include directly. Order is bottom to top, so a name may only
# appear after it was defined: the table itself cannot describe a cycle.
LAYERS = {
    "base": [],
    "geometry": ["base"],
    "image": ["base", "geometry"],
    "solvers": ["base", "geometry"],
    "optimization": ["base", "geometry"],
    "linecut": ["base", "geometry", "optimization"],
    "features": ["base", "geometry", "image"],
    "initialization": ["base", "geometry", "image", "features", "solvers", "optimization"],
    "map": ["base", "geometry", "features"],
    "association": ["base", "geometry", "features", "map"],
    "tracking": ["base", "geometry", "image", "features", "solvers", "initialization",
                 "optimization", "linecut", "map", "association"],
    "mapping": ["base", "geometry", "features", "solvers", "optimization", "map", "association"],
    "place": ["base", "geometry", "features", "solvers", "optimization", "map", "association"],
    "slam": ["base", "geometry", "image", "features", "solvers", "optimization", "linecut",
             "initialization", "map", "tracking", "mapping", "place"],
    "io": ["base", "geometry", "image", "features", "map", "place"],
    "synth": ["base", "geometry", "image", "io"],
    "eval": ["base", "geometry"],
    "report": ["base", "geometry", "image", "features", "map", "io", "slam", "eval"],
    "experiments": ["base", "geometry", "image", "features", "solvers", "optimization", "linecut",
                    "initialization", "map", "tracking", "mapping", "place", "slam", "io", "synth",
                    "eval", "report"],
    "viewer": ["base", "geometry", "map", "slam"],
}
# third-party prefix -> modules whose .cc files may include it. A header may only do so when
# its name says it (ceres_*.h), so no public header drags a heavy library along.
THIRD_PARTY = {
    "ceres/": ["optimization"],
    "opencv2/": ["image", "features", "io", "report"],
    "embree3/": ["synth"],
    "nlopt": ["experiments"],
    "coin/": ["experiments"],
    "nlohmann/": ["io", "report", "experiments", "viewer"],
    "yaml-cpp/": ["base", "io"],
    "civetweb": ["viewer"],
    "CLI/": [],
    "pybind11/": [],
}
INCLUDE = re.compile(r'\s*#\s*include\s+["<]([^">]+)[">]')


def violations(root: pathlib.Path):
    seen = set()
    for module, allowed in LAYERS.items():
        unknown = set(allowed) - seen
        if unknown:
            yield f"LAYERS: {module} names {sorted(unknown)} before they are defined"
        seen.add(module)
    for path in sorted((root / "plumbline").rglob("*")):
        if path.suffix not in (".h", ".cc"):
            continue
        module = path.relative_to(root / "plumbline").parts[0]
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            target, where = match[1], f"{path.relative_to(root)}:{number}"
            if target.startswith("plumbline/"):
                other = target.split("/")[1]
                if other != module and other not in LAYERS.get(module, []):
                    yield f"{where}: {module} may not include {other}"
            for prefix, users in THIRD_PARTY.items():
                named_header = path.name.startswith(prefix.rstrip("/") + "_")
                if target.startswith(prefix) and (
                        module not in users or (path.suffix == ".h" and not named_header)):
                    yield f"{where}: {target} is not allowed here"


if __name__ == "__main__":
    problems = list(violations(pathlib.Path(".")))
    print("\n".join(problems))
    sys.exit(1 if problems else 0)
