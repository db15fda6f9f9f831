#!/usr/bin/env python3
"""Makes the site of the documents with mkdocs and its theme material, and checks it.

    tools/make_site.py OUT [--api FOLDER] [--python FOLDER]    the site is in OUT/html; with the pages of the API
                                                               reference, and the reference of the package for
                                                               Python that lies in FOLDER (python_reference.py)

Pages, pictures and files that pages link to are copied as they lie in the repository, so that links hold. The
navigation follows docs/README.md: a section for each of its headings, with the pages listed there; a folder's
README.md brings the pages that it lists. Formulas are set by MathJax (Debian's libjs-mathjax), which is copied
along. Errors: what mkdocs warns of; a link or an anchor that leads nowhere; anything that a page would load
from another host; a page that the search does not know. Exit status: 0 made, 1 errors (one a line), 2 a program is missing.
"""
import argparse
import html.parser
import json
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent
LINK = re.compile(r"\[[^\]]*\]\(([^)\s#]+)(?:#[^)\s]*)?\)")
PYTHON_PAGE = "docs/python-reference.md"  # not in the repository
MKDOCS = "/usr/bin/mkdocs"  # Debian's, which knows Debian's theme, whatever else is in the PATH
MATHJAX = pathlib.Path("/usr/share/javascript/mathjax")
# TeX to SVG needs these and no fonts.
MATHJAX_PARTS = ["MathJax.js", "config/TeX-AMS_SVG.js", "extensions/MathEvents.js", "extensions/MathMenu.js",
                 "extensions/MathZoom.js", "extensions/TeX", "extensions/tex2jax.js", "jax/element",
                 "jax/input/TeX", "jax/output/SVG/autoload", "jax/output/SVG/config.js",
                 "jax/output/SVG/fonts/TeX", "jax/output/SVG/jax.js"]
FORMULAS_JS = """window.MathJax = {
  config: ["TeX-AMS_SVG.js"], showMathMenu: false, messageStyle: "none",
  tex2jax: {inlineMath: [["\\\\(", "\\\\)"]], displayMath: [["\\\\[", "\\\\]"]], processClass: "arithmatex",
            ignoreClass: "md-container"},
};
"""
# The theme makes formulas as narrow as can be, and MathJax then has no room to put them.
SITE_CSS = ".md-typeset div.arithmatex > * { width: auto; }\n"
# Elements that a browser loads by itself, and the attribute with the address.
LOADED = {"script": "src", "img": "src", "link": "href", "iframe": "src", "source": "src", "video": "src",
          "object": "data", "embed": "src"}


def links_of(page):
    """Files of the repository that a page links to, in order."""
    fenced, found = False, []
    for line in page.read_text().splitlines():
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            for target in LINK.findall(line):
                if not re.match(r"[a-z]+:", target):
                    found.append((page.parent / target).resolve())
    return found


def pages():
    return sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "lab/notes").glob("*.md")])


def copy_pages(folder):
    for page in pages():
        for file in [page, *(file for file in links_of(page) if file.is_file() and file.suffix != ".md")]:
            copy = folder / file.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, copy)


def copy_mathjax(folder):
    for part in MATHJAX_PARTS:
        source, copy = MATHJAX / part, folder / "mathjax" / part
        copy.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, copy)
        else:
            shutil.copyfile(source, copy)
    (folder / "formulas.js").write_text(FORMULAS_JS)
    (folder / "site.css").write_text(SITE_CSS)


def navigation(with_api, with_python):
    """The value of `nav` in mkdocs.yml; the API references are the last of the first section."""
    sections = re.split(r"^## (.*)$", (ROOT / "docs/README.md").read_text(), flags=re.MULTILINE)[1:]
    result = [{"Plumbline": "README.md"}]
    for title, text in zip(sections[::2], sections[1::2]):
        entries = []
        for target in LINK.findall(text):
            page = (ROOT / "docs" / target).resolve()
            entry = page.relative_to(ROOT).as_posix()
            if page.name == "README.md" and page.parent != ROOT:
                inner = [file.relative_to(ROOT).as_posix() for file in links_of(page)
                         if file.parent == page.parent and file.suffix == ".md"]
                heading = page.read_text().splitlines()[0].lstrip("# ")
                entries.append({heading: [entry, *dict.fromkeys(inner)]})
            else:
                entries.append(entry)
        result.append({title: entries})
    references = next(iter(result[1].values()))
    if with_api:
        references.append({"API reference": "api/index.html"})
    if with_python:
        references.append({"Python reference": PYTHON_PAGE})
    return result


def write_python_page(package, page):
    """Writes the reference of the package for Python; returns the problems."""
    done = subprocess.run(["/usr/bin/python3", "-B", ROOT / "tools/python_reference.py"], capture_output=True,
                          text=True, env={"PYTHONPATH": str(package.resolve())})
    page.write_text(done.stdout)
    return done.stderr.splitlines() if done.returncode else []


def search_problems(site, listed):
    """The index that the script of the search reads must have words of each page."""
    file = site / "search/search_index.json"
    index = json.loads(file.read_text()) if file.exists() else {"docs": []}
    found = {entry["location"].partition("#")[0] for entry in index["docs"] if entry["text"].strip()}
    if not list(site.glob("assets/javascripts/workers/search.*.js")):
        yield "the script of the search is missing"
    for page in sorted(listed):
        html = re.sub(r"(^|/)README\.md$", r"\1index.html", page).replace(".md", ".html")
        if html not in found and html.removesuffix("index.html") not in found:
            yield f"{page}: the search knows no word of it"


class Page(html.parser.HTMLParser):
    """Links, anchors and what is loaded, of one page of the site."""

    def __init__(self, text):
        super().__init__()
        self.links, self.anchors, self.loaded = [], set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        for name in ("id", "name"):
            if attributes.get(name):
                self.anchors.add(attributes[name])
        if tag == "a" and attributes.get("href"):
            self.links.append(attributes["href"])
        if tag in LOADED and attributes.get(LOADED[tag]) and attributes.get("rel") != "canonical":
            self.loaded.append(attributes[LOADED[tag]])


def site_problems(site):
    read = {path: Page(path.read_text()) for path in sorted(site.rglob("*.html"))}
    for path, page in read.items():
        if path.name == "404.html" or site / "api" in path.parents:  # of Doxygen's own making
            page.links = []
        for address in page.links + page.loaded:
            parts = urllib.parse.urlsplit(address)
            where = f"{path.relative_to(site)}: {address}"
            if parts.scheme or parts.netloc:
                if address in page.loaded and parts.scheme not in ("data", "javascript"):
                    yield f"{where} is loaded from another host"
                continue
            target = path.parent / urllib.parse.unquote(parts.path) if parts.path else path
            target = (site / parts.path.lstrip("/") if parts.path.startswith("/") else target).resolve()
            target = target / "index.html" if target.is_dir() else target
            if not target.is_file():
                yield f"{where} leads nowhere"
            elif parts.fragment and target in read and urllib.parse.unquote(
                    parts.fragment) not in read[target].anchors | {"__top", "top"}:
                yield f"{where} has no such anchor"
    for path in site.rglob("*.css"):
        for address in re.findall(r"(?:url\(|@import\s+)[\"']?((?:https?:)?//[^\"')\s]+)", path.read_text()):
            yield f"{path.relative_to(site)}: {address} is loaded from another host"


def make(out, api, python):
    shutil.rmtree(out, ignore_errors=True)
    (out / "pages").mkdir(parents=True)
    copy_pages(out / "pages")
    copy_mathjax(out / "pages")
    if api:
        shutil.copytree(api, out / "pages/api")
    problems = write_python_page(python, out / "pages" / PYTHON_PAGE) if python else []
    if problems:
        return problems
    nav = json.dumps(navigation(bool(api), bool(python)))
    (out / "mkdocs.yml").write_text((ROOT / "docs/mkdocs.yml").read_text() + "nav: " + nav + "\n")
    done = subprocess.run([MKDOCS, "build", "--quiet", "--config-file", out / "mkdocs.yml"],
                          capture_output=True, text=True)
    if done.returncode != 0:
        return (done.stdout + done.stderr).strip().splitlines()
    listed = set(re.findall(r"[\w/.-]+\.md", nav))
    missing = [f"{page.relative_to(ROOT)} is in no index that docs/README.md leads to" for page in pages()
               if page.relative_to(ROOT).as_posix() not in listed | {"docs/README.md"}]
    return missing + list(site_problems(out / "html")) + list(search_problems(out / "html", listed))


def main():
    parser = argparse.ArgumentParser(usage="tools/make_site.py OUT [--api FOLDER] [--python FOLDER]")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--api", type=pathlib.Path)
    parser.add_argument("--python", type=pathlib.Path)
    arguments = parser.parse_args()
    for needed in (MKDOCS, MATHJAX, "/usr/share/mkdocs/themes/material"):
        if not pathlib.Path(needed).exists():
            print(f"make_site.py: {needed} is missing (packages mkdocs, mkdocs-material, libjs-mathjax)",
                  file=sys.stderr)
            return 2
    problems = make(arguments.out.resolve(), arguments.api, arguments.python)
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
