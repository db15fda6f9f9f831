#!/usr/bin/env python3
"""Checks the documents against the repository.

- Links between documents (also those of lab/notes) resolve, anchors included.
- Every decision record is listed in docs/adr/README.md, every page in the README.md of its folder.
- Pages are as short as MOST_WORDS says: README.md, those of docs/methods, those of docs.
- Comments in the code cite only documents that exist, and equations that a document explains.
- Commands shown in documents exist: scripts, subcommands of plumbline, and their flags.
- Tests named in documents exist.
Exit status: 0 clean, 1 problems (one a line, file:line).
"""
import fnmatch
import pathlib
import re
import sys

LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
EQUATION = re.compile(r"\beq\. (\d+(?:(?:-|, )\d+)*)")
DOCUMENT = re.compile(r"\b(?:docs|lab/notes)/[\w/.-]+\.md\b")
TEST_NAME = re.compile(r"`([A-Z]\w+)\.([A-Z]\w+)`")
FLAG = re.compile(r"(?<![\w-])--[a-z][a-z-]+")
BUILT_BY_CMAKE = "build/release/plumbline"
BENCHMARKS = "build/release/bench/"
# The first pattern that fits a page counts. file-formats.md is a reference, which nobody reads from end to end.
MOST_WORDS = {"README.md": 700, "docs/methods/*": 1500, "docs/file-formats.md": 6000, "docs/*": 3000}


def lines_of(path):
    return enumerate(path.read_text().splitlines(), 1)


def outside_code(path):
    """Lines of a Markdown file that are not in a fenced block."""
    fenced = False
    for number, line in lines_of(path):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            yield number, line


def anchor_of(title):
    """The anchor that GitHub gives a heading."""
    kept = re.sub(r"[^\w\- ]", "", title.strip().lower())
    return kept.replace(" ", "-")


def anchors(path):
    return {anchor_of(line.lstrip("#")) for _, line in outside_code(path) if line.startswith("#")}


def link_problems(root, documents):
    for path in documents:
        for number, line in outside_code(path):
            for target in LINK.findall(line):
                if re.match(r"[a-z]+:", target):
                    continue
                name, _, anchor = target.partition("#")
                file = (path.parent / name).resolve() if name else path
                where = f"{path.relative_to(root)}:{number}"
                if not file.exists():
                    yield f"{where}: {target} does not exist"
                elif anchor and file.suffix == ".md" and anchor not in anchors(file):
                    yield f"{where}: {target} has no such heading"


def index_problems(root):
    for index in sorted([*(root / "docs").rglob("README.md"), *(root / "lab/notes").glob("README.md")]):
        folder = index.parent
        listed = set(LINK.findall(index.read_text()))
        for page in sorted(folder.glob("*.md")):
            if page != index and page.name not in listed:
                yield f"{index.relative_to(root)}: {page.name} is not listed"
            if folder.name == "adr" and page != index and not re.match(r"\d{4}-", page.name):
                yield f"{page.relative_to(root)}: the name must start with its number"


def length_problems(root):
    for page in [root / "README.md", *sorted((root / "docs").rglob("*.md"))]:
        name = page.relative_to(root).as_posix()
        words = len(page.read_text().split())
        most = next(most for pattern, most in MOST_WORDS.items() if fnmatch.fnmatch(name, pattern))
        if words > most:
            yield f"{name}: {words} words; at most {most}"


def equation_numbers(text):
    for cited in EQUATION.findall(text):
        for part in cited.split(", "):
            first, _, last = part.partition("-")
            yield from range(int(first), int(last or first) + 1)


def citation_problems(root, sources):
    explained = set()
    for page in (root / "docs").rglob("*.md"):
        explained.update(equation_numbers(page.read_text()))
    for path in sources:
        for number, line in lines_of(path):
            where = f"{path.relative_to(root)}:{number}"
            for document in DOCUMENT.findall(line):
                if not (root / document).is_file():
                    yield f"{where}: {document} does not exist"
            for equation in equation_numbers(line):
                if equation not in explained:
                    yield f"{where}: no page under docs/ explains eq. {equation}"


def known_commands(root):
    """Subcommand -> text of the sources that parse its flags."""
    names = re.findall(r'Command\{"(\w+)"', (root / "apps/main.cc").read_text())
    # Flags that several commands have.
    common = "".join((root / "apps" / file).read_text() for file in ("command_line.cc", "view_options.cc"))
    # The sources of `map` are map.cc and those of its own commands, map_info.cc and so on.
    files = {name: sorted((root / "apps").glob(f"{name}.cc")) +
             sorted((root / "apps").glob(f"{name}_*.cc")) for name in names}
    return {name: common + "".join(file.read_text() for file in files[name])
            for name in names} | {"help": ""}


def command_problems(root, documents):
    commands = known_commands(root)
    for path in documents:
        block = None
        for number, line in lines_of(path):
            fence = re.match(r"\s*```(\w*)", line)
            if fence:
                block = fence[1] if block is None else None
                continue
            words = line.split("  #")[0].split()
            if block != "sh" or not words:
                continue
            where = f"{path.relative_to(root)}:{number}"
            program = words[0].removeprefix("./")
            if program == BUILT_BY_CMAKE:
                name = words[1] if len(words) > 1 else "help"
                if name not in commands:
                    yield f"{where}: plumbline has no command {name}"
                    continue
                for flag in FLAG.findall(" ".join(words[2:])):
                    if f'"{flag}"' not in commands[name]:
                        yield f"{where}: plumbline {name} has no {flag}"
            elif program.startswith(BENCHMARKS):
                source = root / program.replace(BENCHMARKS, "lab/bench/")
                if not source.with_suffix(".cc").is_file():
                    yield f"{where}: there is no benchmark {words[0]}"
            # Programs of the system are not ours to check.
            elif "/" in words[0] and not program.startswith("/") and "data/" not in program:
                script = root / program
                if not script.is_file():
                    yield f"{where}: {words[0]} does not exist"
                    continue
                for flag in FLAG.findall(" ".join(words[1:])):
                    if flag not in script.read_text():
                        yield f"{where}: {words[0]} has no {flag}"


def test_name_problems(root, documents):
    known = set()
    for path in (root / "tests").rglob("*.cc"):
        known.update(re.findall(r"^TEST(?:_F|_P)?\((\w+), (\w+)\)", path.read_text(), re.MULTILINE))
    for path in documents:
        for number, line in lines_of(path):
            for name in TEST_NAME.findall(line):
                if name not in known:
                    yield f"{path.relative_to(root)}:{number}: there is no test {'.'.join(name)}"


def problems(root):
    documents = sorted([*root.glob("*.md"), *(root / "docs").rglob("*.md"), *(root / "lab/notes").glob("*.md")])
    sources = sorted(path for folder in ("plumbline", "worlds", "lab", "apps", "tests")
                     for path in (root / folder).rglob("*") if path.suffix in (".h", ".cc"))
    yield from link_problems(root, documents)
    yield from index_problems(root)
    yield from length_problems(root)
    yield from citation_problems(root, sources)
    yield from command_problems(root, documents)
    yield from test_name_problems(root, documents)


if __name__ == "__main__":
    found = list(problems(pathlib.Path(__file__).resolve().parent.parent))
    print("\n".join(found))
    sys.exit(1 if found else 0)
