#!/usr/bin/env python3
"""links.py HTML: follows every link and every picture of the built site, anchors too, without a network. Says which lead nowhere."""
import html
import re
import sys
from pathlib import Path
from urllib.parse import unquote

SCRIPT = re.compile(r"<(script|pre|code)\b.*?</\1>", re.S)
GENERATED = ("library/", "genindex", "search", "_modules")


def anchors(text):
    return {html.unescape(a) for a in re.findall(r'\b(?:id|name)="([^"]+)"', text)}


def main():
    root = Path(sys.argv[1]).resolve()
    texts = {page: page.read_text(errors="replace") for page in root.rglob("*.html")}
    ids = {}
    wrong = []
    links = 0
    for page, text in texts.items():
        name = str(page.relative_to(root))
        if name.startswith(GENERATED):
            continue
        if "$" in re.sub(r"<[^>]*>", "", SCRIPT.sub("", text)):
            wrong.append(f"{name}: a formula was not read as one, there is a $ in the text")
        for target in re.findall(r'<(?:a|img|link)\b[^>]*?\b(?:href|src)="([^"]*)"', text):
            path, _, anchor = html.unescape(target).partition("#")
            if re.match(r"[a-z]+:|//", path):
                continue
            links += 1
            there = (page.parent / unquote(path.split("?")[0])).resolve() if path else page
            if not there.exists() or (there.is_dir() and not (there / "index.html").exists()):
                wrong.append(f"{name}: no {path}")
            elif anchor and there.suffix == ".html":
                if there not in ids:
                    ids[there] = anchors(texts.get(there, ""))
                if unquote(anchor) not in ids[there]:
                    wrong.append(f"{name}: no anchor #{anchor} in {there.relative_to(root)}")
    print("\n".join(sorted(set(wrong)) + [f"{len(texts)} pages, {links} links"]))
    sys.exit(1 if wrong else 0)


main()
