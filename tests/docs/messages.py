#!/usr/bin/env python3
"""messages.py ROOT: every message that docs/messages.md explains (a heading in code, … for what varies) is one of the sources."""
import re
import sys
from pathlib import Path

ROOT = Path(sys.argv[1]).resolve()


def literals():
    """All string literals of src, neighbours joined as the compiler joins them; formats are … like in the headings."""
    text = ""
    for source in sorted(ROOT.glob("src/**/*.[ch]")):
        code = re.sub(r'"\s*(?:PRI\w+|PetscInt_FMT)\s*"', "", source.read_text())
        for match in re.finditer(r'"(?:[^"\\]|\\.)*"(?:\s*"(?:[^"\\]|\\.)*")*', code):
            text += re.sub(r'"\s*"', "", match.group()).strip('"') + "\n"
    return re.sub(r"%%", "%", re.sub(r"%[-+.*\d]*l*[sdgfu]|%", "…", text))


def main():
    said, wrong, count = literals(), [], 0
    for heading in re.findall(r"^### `(.*)`$", (ROOT / "docs" / "messages.md").read_text(), re.M):
        count += 1
        pieces = [piece.strip() for piece in re.split("…", heading) if len(piece.strip()) > 7]
        wrong += [f"docs/messages.md: no source says '{piece}'" for piece in pieces if piece not in said]
    print("\n".join(wrong + [f"{count} messages"]))
    sys.exit(1 if wrong else 0)


main()
