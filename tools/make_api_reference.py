#!/usr/bin/env python3
"""Makes the API reference of the library with Doxygen, from the headers of cmake/public_headers.txt.

    tools/make_api_reference.py BUILD OUT     BUILD: a configured build folder; the pages are in OUT/html

Doxygen reads copies of the headers: comments before a declaration begin with `///` there and comments behind
one with `///<`; lines that are indented within a comment are tables and formulas, and stay as they are typed.
The description of an option is the help that the program prints. What lets the program read and name options,
states and enumerators is left out (docs/adr/0007-options-visitor.md).

Types, functions and enumerations without a description are errors, and so is whatever else Doxygen warns of.
Plain data members of a described struct may go without. Exit status: 0 made, 1 errors (one a line,
file:line), 2 Doxygen is missing.
"""
import pathlib
import re
import shutil
import subprocess
import sys

COMMENT = re.compile(r"^(\s*)//(?!/) ?(.*)$")
TRAILING = re.compile(r"^(\s*(?!//)\S.*?)  // (.*)$")
ESCAPED = str.maketrans({character: "\\" + character for character in "\\@<>&#%$"})
# Functions that nobody calls by hand; with the line `template <...>` before them.
VISITORS = re.compile(r"^(?:template <[^\n]*>\n)?(?:constexpr auto EnumNames|void VisitFields)\(.*?\n}\n", re.DOTALL | re.MULTILINE)
FIELDS = re.compile(r"^void VisitFields\(Visitor&& visit, (\w+)& o\) \{\n(.*?)\n}\n", re.DOTALL | re.MULTILINE)
FIELD = re.compile(r"visit\(\s*\"\w+\",\s*o\.(\w+),\s*((?:\"(?:\\.|[^\"\\])*\"\s*)+)")
MEMBER = re.compile(r"^  [\w:<>, ]+ (\w+)(?: = [^;]*)?;$")
# "file:line: error|warning: Member x (variable) of struct y is not documented."
PLAIN_DATA = re.compile(r"Member \w+ \(variable\) of (?:struct|class) \S+ is not documented\.$")


def text_of(line):
    parts = line.split("`")
    if len(parts) % 2 == 0:  # a lonely quote
        return line.translate(ESCAPED)
    return "".join(f"<code>{part.translate(ESCAPED)}</code>" if index % 2 else part.translate(ESCAPED)
                   for index, part in enumerate(parts))


def block_of(comments, marker):
    """The lines of one comment; tables and formulas between <pre> and </pre>."""
    result, in_table = [], False
    for indent, text in comments:
        table = text.startswith("  ") or (in_table and not text)
        line = text.translate(ESCAPED) if table else text_of(text)
        if table and not in_table:
            line = "<pre>" + line
        if in_table and not table:
            result[-1] += "</pre>"
        in_table = table
        result.append(f"{indent}{marker} {line}")
    if in_table:
        result[-1] += "</pre>"
    return result


def with_option_help(text):
    """The text with the help of options behind the fields that have no comment."""
    helps = {struct: {name: " ".join("".join(re.findall(r'"((?:\\.|[^"\\])*)"', help_text)).split())
                      for name, help_text in FIELD.findall(body)}
             for struct, body in FIELDS.findall(text)}
    lines, struct = text.splitlines(), None
    for index, line in enumerate(lines):
        opened = re.match(r"^struct (\w+) \{$", line)
        struct = opened[1] if opened else None if line == "};" else struct
        member = MEMBER.match(line)
        if struct in helps and member and member[1] in helps[struct]:
            before = lines[index - 1].strip()
            if not before.startswith("//"):
                lines[index] += "  // " + helps[struct][member[1]]
    return "\n".join(lines) + "\n"


def for_doxygen(text):
    """The lines of a header as Doxygen is to read them, as many as before."""
    text = with_option_help(text)
    lines = VISITORS.sub(lambda match: "\n" * match[0].count("\n"), text).splitlines()
    index = 0
    while index < len(lines):
        line = lines[index]
        trailing, comment = TRAILING.match(line), COMMENT.match(line)
        if not trailing and not comment:
            yield line
            index += 1
            continue
        comments = [("", trailing[2]) if trailing else (comment[1], comment[2])]
        index += 1
        while index < len(lines):
            further = COMMENT.match(lines[index])
            if not further or (trailing and len(further[1]) != len(trailing[1]) + 2):
                break
            comments.append((further[1], further[2]))
            index += 1
        if comments[0][1].startswith("SPDX"):
            yield from [""] * len(comments)
        elif trailing:
            block = block_of(comments, "///<")
            yield f"{trailing[1]}  {block[0]}"
            yield from block[1:]
        else:
            yield from block_of(comments, "///")


def public_headers(root):
    for line in (root / "cmake/public_headers.txt").read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            yield line.strip()


def run_doxygen(root, build, out):
    """The warnings of Doxygen."""
    copies = out / "headers"
    shutil.rmtree(copies, ignore_errors=True)
    for header in public_headers(root):
        source = root / "plumbline" / header
        if not source.is_file():
            source = build / "generated/plumbline" / header
        copy = copies / "plumbline" / header
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text("\n".join(for_doxygen(source.read_text())) + "\n")
    version = (build / "generated/plumbline/version.h").read_text()
    settings = (root / "docs/Doxyfile").read_text() + "\n".join([
        f"PROJECT_NUMBER = {re.search(r'PLUMBLINE_VERSION .([0-9.]+)', version)[1]}",
        f'OUTPUT_DIRECTORY = "{out}"', f'STRIP_FROM_PATH = "{copies}"',
        f'STRIP_FROM_INC_PATH = "{copies}"', f'INPUT = "{root}/docs/api.dox" "{copies}"',
        f'WARN_LOGFILE = "{out}/warnings.txt"', ""])
    subprocess.run(["doxygen", "-"], input=settings, text=True, check=True)
    return [line.replace(str(copies) + "/", "") for line in (out / "warnings.txt").read_text().splitlines()]


def main():
    if len(sys.argv) != 3:
        print("usage: tools/make_api_reference.py BUILD OUT", file=sys.stderr)
        return 2
    if not shutil.which("doxygen"):
        print("make_api_reference.py: doxygen is not installed", file=sys.stderr)
        return 2
    root = pathlib.Path(__file__).resolve().parent.parent
    out = pathlib.Path(sys.argv[2]).resolve()
    out.mkdir(parents=True, exist_ok=True)
    problems = [line for line in run_doxygen(root, pathlib.Path(sys.argv[1]).resolve(), out)
                if not PLAIN_DATA.search(line)]
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
