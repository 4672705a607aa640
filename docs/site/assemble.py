#!/usr/bin/env python3
"""assemble.py TALUS FOLDER: puts the sources of the site into FOLDER: every README.md and docs/*.md of the repository under its
own path, a page for each file that one of them links to, and the pages that are made: gallery, commands, lists."""
import fnmatch
import html
import os
import re
import subprocess
import sys
from pathlib import Path

import cases
import contents

ROOT = cases.ROOT
FENCE = re.compile(r"^(\s*)(```+|~~~+)")


def sources():
    """All Markdown of the repository that is no build output: paths without .md, by name."""
    skip = re.compile(r"(^|/)(build[^/]*|obj-[^/]*|runs|results|\.[^/]*|node_modules)(/|$)")
    paths = [p.relative_to(ROOT) for pattern in ("*.md", "[a-z]*/**/*.md") for p in ROOT.glob(pattern)]
    return sorted({str(p)[:-3] for p in paths if not skip.search(str(p))})


def page_of(target, pages):
    """The page, without .md, that shows a path of the repository; None where it is shown as it is."""
    if target == ROOT / "cases":
        return "gallery"
    if target.is_dir():
        target = target / "README.md"
    name = os.path.relpath(target, ROOT)
    if name == "README.md":
        return "index"
    if name.endswith(".md") and name[:-3] in pages:
        return name[:-3]
    if target.is_file() and target.suffix not in (".png", ".svg", ".gif"):
        return "files/" + name
    return None


class Site:
    def __init__(self, talus, out):
        self.talus, self.out = talus, out
        self.pages = [name for name in sources() if name != "README"] + ["gallery", "commands", "lists", "library"]
        self.written = set()

    def write(self, name, text):
        """A page; what has not changed is left alone, so that Sphinx need not read it again."""
        self.put(name + ".md", text.encode())

    def put(self, name, content):
        path = self.out / name
        self.written.add(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_bytes() != content:
            path.write_bytes(content)

    def remove_others(self):
        """Pages of an earlier time that are no more."""
        for path in [p for p in self.out.rglob("*") if p.is_file() and p not in self.written]:
            path.unlink()

    def link(self, folder, page, words, target):
        """The Markdown of a link of a page in `folder` of the repository as the site has it."""
        path, _, anchor = target.partition("#")
        place = (ROOT / folder / path).resolve()
        there = None if re.match(r"[a-z]+:", target) or not path else page_of(place, self.pages)
        if there is None and path and place.is_dir():
            return words  # a folder that has no page
        if there is None:
            return f"[{words}]({target})"
        here = os.path.dirname(page) or "."
        if there.startswith("files/"):
            self.put("_extra/" + there + ".txt", (ROOT / there[len("files/"):]).read_bytes())
            words = re.sub("`([^`]*)`", r"<code>\1</code>", words)
            return f'<a href="{os.path.relpath(there, here)}.txt">{words}</a>'
        return f"[{words}]({os.path.relpath(there, here)}.md{'#' + anchor if anchor else ''})"

    def rewrite(self, name, text):
        """The links of a Markdown text of the page `name`; a path in `code` that is a case or a page becomes a link, too."""
        folder, page = os.path.dirname(name), "index" if name == "README" else name

        def linked(match):
            return self.link(folder, page, *match.groups())

        def named(match):
            path = match.group(1).rstrip("/")
            there = page_of(ROOT / path, self.pages)
            if not there or there.startswith("files/") or there == page:
                return match.group(0)
            return f"[{match.group(0)}]({os.path.relpath(there, folder or '.')}.md)"

        lines, fence = [], None
        for line in text.split("\n"):
            mark = FENCE.match(line)
            if mark and not fence:
                fence = mark.group(2)
                # What follows the language is for the test of the tutorial.
                line = re.sub(r"^(\s*[`~]+\w+).*", r"\1", line)
            elif mark and line.strip().startswith(fence):
                fence = None
            elif not fence and not line.startswith("    "):
                line = re.sub(r"(?<!!)\[((?:[^\[\]`]|`[^`]*`)*)\]\(([^)\s]+)\)", linked, line)
                line = re.sub(r"(?<!\[)`((?:docs|cases)/[\w./-]+)`(?!\])", named, line)
            if not fence and re.match(r"\s*\$\$", line):
                lines.append("")  # the parser knows displayed formulas only as paragraphs of their own
            lines.append(line)
            if not fence and re.search(r"\$\$\s*$", line) and len(line.strip()) > 2:
                lines.append("")
        return "\n".join(lines)

    def copy_pages(self):
        below, _ = self.order()
        for name in [name for name in self.pages if (ROOT / (name + ".md")).exists()]:
            text = (ROOT / (name + ".md")).read_text()
            self.write(name, self.rewrite(name, text) + self.case_file(name) + toctree(below.get(name, []), None))
        for pattern in ("docs/**/*.png", "cases/*/*.png", "docs/**/*.gif", "cases/*/*.gif"):
            for picture in ROOT.glob(pattern):
                self.put(picture.relative_to(ROOT), picture.read_bytes())

    def case_file(self, name):
        """What stands below a case's README: its case file, and the other files of the folder."""
        folder = ROOT / os.path.dirname(name)
        case = folder / "case.yaml"
        if folder.parent != ROOT / "cases" or not folder.is_dir():
            return ""
        others = [p.name for p in sorted(folder.iterdir()) if p.suffix in (".yaml", ".geo", ".py") and p != case]
        text = "\n\n## The files\n\n"
        if others:
            links = [self.link(folder, name, other, other) for other in others]
            text += f"Beside the case file: {', '.join(links)}.\n\n"
        return text + (f"`case.yaml`:\n\n```yaml\n{case.read_text()}```\n" if case.exists() else "")

    def run(self, *words):
        return subprocess.run([self.talus, *words], capture_output=True, text=True, check=True).stdout

    def make_commands(self):
        overview = self.run("help")
        words = re.findall(r"^  (\w+)  ", overview.split("commands:")[1], re.M)
        text = f"# Commands\n\nWhat each command says of itself with `--help`.\n\n```text\n{overview}```\n"
        for word in words:
            text += f"\n## talus {word}\n\n```text\n{self.run(word, '--help')}```\n"
        self.write("commands", text)

    def make_lists(self):
        """What a case file can name, as `talus list` says it."""
        things = re.search(r"talus list (\S+)", self.run("list", "--help")).group(1).split("|")
        text = "# What a case file can name\n\nThe output of `talus list`; how the names are used says\n[the case file](docs/case-file.md).\n"
        for thing in things:
            link = {"laws": "The equations: [theory, section 4](docs/theory.md#4-laws).\n\n"}.get(thing, "")
            text += f"\n## {thing.capitalize()}\n\n{link}```text\n{self.run('list', thing)}```\n"
        self.write("lists", text)

    def make_library(self):
        header = self.link("", "library", "talus.h", "include/talus.h")
        self.write("library", f"# The C library\n\nAll that the program does is open to a program of your own through one header, {header}:\n"
                   "<a href=\"library/index.html\">its reference, by Doxygen</a>, is a part of this site.\n"
                   + toctree(self.order()[0].get("library", []), None))

    def make_gallery(self):
        seconds, notes = cases.times()
        text = ["---", "hide-toc: true", "---", "# Gallery", "", "Every case of `cases/`: what it is, the command that computes it, and the time it takes.",
                "A case is a text file and a page that says what came out; the picture leads there.", "",
                "Times: processor time of the command, measured by `make gallery`"
                + (f" ({'; '.join(notes)})" if notes else "") + "; in words where the case's page states it.", "",
                ""]
        everything = cases.all_cases()
        for group in cases.GROUPS:
            text += [f"## {group}", "", '<div class="gallery">']
            text += [self.card(case, seconds.get(case.name)) for case in everything if case.group == group]
            text += ["</div>", ""]
        self.write("gallery", "\n".join(text) + toctree(self.order()[0]["gallery"], None))

    def card(self, case, seconds):
        page = f"cases/{case.name}/README.html"
        command, _ = case.command
        picture = ""
        if case.pictures:
            source = os.path.normpath(f"cases/{case.name}/{case.pictures[0]}")
            self.put("_extra/" + source, (ROOT / source).read_bytes())
            picture = f'<a href="{page}"><img loading="lazy" src="{source}" alt="{html.escape(case.title, quote=True)}"></a>'
        time = seconds or case.stated_time
        return (f'<div class="case"><p class="picture">{picture}</p><p class="title"><a href="{page}">{html.escape(case.title)}</a></p>'
                f'<p>{html.escape(case.sentence)}</p><p class="words">{html.escape(", ".join(case.words))}</p>'
                f'<p class="command"><code>{html.escape(command)}</code>'
                f'<span class="time">{html.escape(time)}</span></p></div>')

    def order(self):
        """{page: its pages below} and the pages of each part, by contents.py."""
        below, parts, rest = {}, [], []
        for page in self.pages:
            for pattern, parent in contents.BELOW:
                if fnmatch.fnmatchcase(page, pattern) and page != parent and parent in self.pages:
                    below.setdefault(parent, []).append(page)
                    break
            else:
                rest.append(page)
        named = {pattern for _, patterns in contents.PARTS for pattern in patterns if "*" not in pattern}
        for caption, patterns in contents.PARTS:
            mine = []
            for pattern in patterns:
                mine += [page for page in sorted(rest) if page not in mine
                         and (page == pattern or (page not in named and fnmatch.fnmatchcase(page, pattern)))]
            rest = [page for page in rest if page not in mine]
            parts.append((caption, mine))
        return below, parts

    def make_index(self):
        """README.md is the first page; the contents of all others hang on it."""
        _, parts = self.order()
        index = self.rewrite("README", (ROOT / "README.md").read_text())
        self.write("index", index + "".join(toctree(pages, caption) for caption, pages in parts))


def toctree(pages, caption):
    if not pages:
        return ""
    head = "\n```{toctree}\n:hidden:\n:titlesonly:\n" + (f":caption: {caption}\n" if caption else "")
    return head + "".join(f"/{page}\n" for page in pages) + "```\n"


def main():
    site = Site(os.path.abspath(sys.argv[1]), Path(sys.argv[2]))
    site.make_index()
    site.copy_pages()
    site.make_commands()
    site.make_lists()
    site.make_library()
    site.make_gallery()
    site.remove_others()


main()
