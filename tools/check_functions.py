#!/usr/bin/env python3
"""Checks that functions are short and take few parameters.

A function definition, from the first line of its signature to its closing brace, has at most MOST_LINES
lines and at most MOST_PARAMETERS parameters. Those that have more are listed in
tools/function_exceptions.txt with what they have; the list may only shrink: a function that has more
than its row says is a problem, and so is a row that says more than its function has.
Exit status: 0 clean, 1 problems (one a line, file:line).

    tools/check_functions.py --list    prints the rows that the list would need
"""
import pathlib
import re
import sys

MOST_LINES = 60
MOST_PARAMETERS = 6
FOLDERS = ("plumbline", "worlds", "lab", "apps", "python", "examples", "fuzz", "tests")
EXCEPTIONS = "tools/function_exceptions.txt"

NOT_CODE = re.compile(r"""
    //[^\n]*                                   # comment to the end of the line
  | /\*.*?\*/                                  # comment
  | R"(?P<delimiter>[^(\s]*)\(.*?\)(?P=delimiter)"   # raw string
  | "(?:\\.|[^"\\\n])*"                        # string
  | (?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'        # character, not a separator of digits
  | ^[ \t]*\#(?:[^\n]*\\\n)*[^\n]*             # preprocessor
    """, re.VERBOSE | re.DOTALL | re.MULTILINE)
PAIRS = {"(": ")", "[": "]", "{": "}"}
# What comes before a parenthesis that does not hold the parameters of a function.
NOT_NAMES = {"noexcept", "requires", "decltype", "alignas", "if", "for", "while", "switch", "explicit",
             "__attribute__", "sizeof"}


class Function:
    def __init__(self, name, line, lines, parameters):
        self.name, self.line, self.lines, self.parameters = name, line, lines, parameters


def code_of(text):
    """The text with everything that is no code blanked, lines kept."""
    return NOT_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)


def closing(code, start):
    """Index of the bracket that closes the one at `start`."""
    open_bracket, close_bracket, depth = code[start], PAIRS[code[start]], 0
    for match in re.finditer(f"[{re.escape(open_bracket + close_bracket)}]", code[start:]):
        depth += 1 if match[0] == open_bracket else -1
        if depth == 0:
            return start + match.start()
    return len(code) - 1


def without_template(head):
    """The head of a declaration without `template <...>` before it."""
    head = head.strip()
    while re.match(r"template\s*<", head):
        depth, end = 0, head.index("<")
        for end in range(head.index("<"), len(head)):
            depth += {"<": 1, ">": -1}.get(head[end], 0)
            if depth == 0:
                break
        head = head[end + 1:].strip()
        head = re.sub(r"^requires\b[^()]*(\([^()]*\))?\s*", "", head)
    return head


def parameter_list(head):
    """(name, parameters, what follows them) of a function's head; None where it is none."""
    depth, position = 0, 0
    while position < len(head):
        character = head[position]
        if character == "<" and re.search(r"\w\s*$", head[:position]):
            depth += 1
        elif character == ">" and depth and head[position - 1] != "-":
            depth -= 1
        elif character == "=" and depth == 0 and not re.search(r"operator[^\w\s]*$", head[:position]):
            return None
        elif character == "(":
            end = closing(head, position)
            name = re.search(r"(operator\s*(?:\(\)|[^\w\s(]+|\w+)|~?\w+)\s*$", head[:position])
            if head[:position].endswith("operator"):  # operator()
                position = end + 1
                continue
            if name and depth == 0 and name[1] not in NOT_NAMES:
                return name[1], head[position + 1:end], head[end + 1:]
            position = end
        position += 1
    return None


def count_parameters(text):
    if not text.strip() or text.strip() == "void":
        return 0
    count, depth = 1, 0
    for index, character in enumerate(text):
        if character in "([{<":
            depth += 1
        elif character in ")]}" or (character == ">" and text[index - 1] != "-"):
            depth -= 1
        elif character == "," and depth == 0:
            count += 1
    return count


def functions_of(text):
    code = code_of(text)
    scopes, head_start, position = [], 0, 0  # scopes: names of the classes around
    while position < len(code):
        character = code[position]
        if character == "(" or character == "[":
            position = closing(code, position)
        elif character == ";" or re.match(r"(?:public|private|protected)\s*:(?!:)", code[position:position + 12]):
            position = code.index(":", position) if character != ";" else position
            head_start = position + 1
        elif character == "}":
            if scopes:
                scopes.pop()
            head_start = position + 1
        elif character == "{":
            head = without_template(code[head_start:position])
            if re.match(r"(inline\s+)?namespace\b|extern\b\s*$", head):
                scopes.append("")
                head_start = position + 1
            elif re.match(r"(class|struct|union)\b", head) and not re.search(r"\)\s*(const)?\s*$", head):
                name = re.match(r"(?:class|struct|union)\s+(?:alignas\s*\(\w+\)\s*)?([\w:]*)", head)
                scopes.append(name[1])
                head_start = position + 1
            else:
                found = parameter_list(head)
                in_initializers = found and re.match(r"[^{]*?(?<!:):(?!:)", found[2]) and re.search(
                    r"[\w>]\s*$", head)
                end = closing(code, position)
                if found and not in_initializers:
                    start = head_start + len(code[head_start:position]) - len(
                        code[head_start:position].lstrip())
                    first = code.count("\n", 0, start) + 1
                    last = code.count("\n", 0, end) + 1
                    qualified = re.search(r"([\w:]*::)?\s*$", head[:head.index(found[0] + "(")
                                          if found[0] + "(" in head else 0])
                    prefix = (qualified[1] or "") if qualified else ""
                    name = "::".join([scope for scope in scopes if scope] + [prefix + found[0]])
                    if re.match(r"TEST(_F|_P)?$|BENCHMARK", found[0]):
                        name = ".".join(found[1].replace(" ", "").split("\n")[0].split(","))
                    yield Function(name, first, last - first + 1, count_parameters(found[1]))
                position = end
                if not in_initializers:
                    head_start = end + 1
        position += 1


def all_functions(root):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".h", ".cc"):
                for function in functions_of(path.read_text()):
                    yield path.relative_to(root).as_posix(), function


def excess(function):
    """The row of a function that is too long or takes too much: lines or - , parameters or - ."""
    lines = str(function.lines) if function.lines > MOST_LINES else "-"
    parameters = str(function.parameters) if function.parameters > MOST_PARAMETERS else "-"
    return None if lines == parameters == "-" else f"{lines} {parameters}"


def read_exceptions(root):
    rows = {}
    for number, line in enumerate((root / EXCEPTIONS).read_text().splitlines(), 1):
        if line.strip() and not line.startswith("#"):
            path, name, numbers = line.split(maxsplit=2)
            rows[path, name] = (number, " ".join(numbers.split()))
    return rows


def problems(root):
    rows = read_exceptions(root)
    for path, function in all_functions(root):
        wanted = excess(function)
        number, listed = rows.get((path, function.name), (None, None))
        if wanted is None or listed == wanted:
            if wanted is not None:
                del rows[path, function.name]
            continue
        where = f"{path}:{function.line}: {function.name}"
        has = f"{function.lines} lines, {function.parameters} parameters"
        if listed is None:
            yield f"{where} has {has}; at most {MOST_LINES} and {MOST_PARAMETERS}"
        else:
            yield f"{where} has {has}; {EXCEPTIONS}:{number} says {listed}"
            del rows[path, function.name]
    for (path, name), (number, _) in rows.items():
        yield f"{EXCEPTIONS}:{number}: {path} {name} needs no exception"


if __name__ == "__main__":
    repository = pathlib.Path(__file__).resolve().parent.parent
    if sys.argv[1:] == ["--list"]:
        for file, found in all_functions(repository):
            if excess(found):
                print(file, found.name, excess(found))
        sys.exit(0)
    problems_found = list(problems(repository))
    print("\n".join(problems_found))
    sys.exit(1 if problems_found else 0)
