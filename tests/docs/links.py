#!/usr/bin/env python3
"""links.py ROOT: every link of the repository's Markdown leads to a file that is there, and to a heading that it has."""
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(sys.argv[1]).resolve()
SKIP = re.compile(r"(^|/)(build[^/]*|runs|results|\.[^/]*)(/|$)")


def prose(text):
    """A text without blocks and spans of code."""
    text = re.sub(r"^(```+|~~~+).*?^\1\s*$", "", text, flags=re.S | re.M)
    text = re.sub(r"^ {4}.*$", "", text, flags=re.M)
    return re.sub(r"`[^`\n]*`", lambda span: re.sub(r"[\[\]()]", "", span.group()), text)


def slugs(path):
    """The anchors of a page's headings, as GitHub and the site make them."""
    seen, out = {}, set()
    fenced = re.sub(r"^(```+|~~~+).*?^\1\s*$", "", path.read_text(), flags=re.S | re.M)
    for heading in re.findall(r"^#+ +(.*?) *$", fenced, re.M):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", words.lower()).replace(" ", "-")
        out.add(slug + (f"-{seen[slug]}" if slug in seen else ""))
        seen[slug] = seen.get(slug, 0) + 1
    return out


def main():
    wrong, count = [], 0
    pages = [p for p in sorted(ROOT.rglob("*.md")) if not SKIP.search(str(p.relative_to(ROOT)))]
    for page in pages:
        for target in re.findall(r"\]\(([^)\s]+)\)", prose(page.read_text())):
            if re.match(r"[a-z]+:", target):
                continue
            count += 1
            path, _, anchor = target.partition("#")
            there = (page.parent / path).resolve() if path else page
            if there.is_dir() and anchor:
                there = there / "README.md"
            if not there.exists():
                wrong.append(f"{page.relative_to(ROOT)}: no {target}")
            elif anchor and there.suffix == ".md" and anchor not in slugs(there):
                wrong.append(f"{page.relative_to(ROOT)}: no heading for {target}")
    print("\n".join(wrong + [f"{len(pages)} pages, {count} links"]))
    sys.exit(1 if wrong else 0)


main()
