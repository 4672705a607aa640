#!/usr/bin/env python3
"""tutorial.py TALUS PAGE [--long]: does what a page of the tutorial says, in a new folder with `cases`, `build/talus`, and `talus` on the path.

Blocks of the page, in order: `sh` is run and must end with 0; `sh long` only with --long (then nothing else of the page is left
out); `sh fails` must not end with 0; `sh not-run` is for readers; `yaml NAME`, `python NAME` and so on are written into NAME. A
`text` block behind a command says what it prints: each line must be there, numbers to 0.5 %, `...` stands for lines left out."""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")
SKIPPED = 77


def blocks(text):
    """[(line, words behind the fence, contents)] of all fenced blocks."""
    found, lines, start = [], text.split("\n"), None
    for number, line in enumerate(lines):
        if line.startswith("```"):
            if start is None:
                start = number
            else:
                found.append((start + 1, lines[start][3:].split(), "\n".join(lines[start + 1: number]) + "\n"))
                start = None
    return found


def same(said, printed):
    """Whether a line says what was printed: the same words, numbers to 0.5 %; what ends in ... need only begin like it."""
    if said.endswith("..."):
        said = said[:-3].rstrip()
        count = len(said.split())
        printed = " ".join(printed.split()[:count])
    if NUMBER.sub("#", said).split() != NUMBER.sub("#", printed).split():
        return False
    pairs = zip(NUMBER.findall(said), NUMBER.findall(printed))
    return all(abs(float(a) - float(b)) <= 0.005 * max(abs(float(a)), abs(float(b))) for a, b in pairs)


def missing_modules(script, environment):
    """Modules that the page's Python needs and this machine lacks."""
    wanted = set(re.findall(r"^(?:import|from) (\w+)", script, re.M))
    return sorted(m for m in wanted
                  if subprocess.run(["python3", "-c", f"import {m}"], env=environment, capture_output=True, check=False).returncode)


class Page:
    def __init__(self, path, folder, environment):
        self.path, self.folder, self.environment, self.printed = path, folder, environment, ""

    def fail(self, line, what):
        sys.exit(f"{self.path}:{line}: {what}\n{self.printed}")

    def run(self, line, commands, must_fail):
        done = subprocess.run(["bash", "-e", "-c", commands], cwd=self.folder, env=self.environment, text=True, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
        self.printed = done.stdout
        if (done.returncode != 0) != must_fail:
            self.fail(line, f"exit code {done.returncode} of\n{commands}")

    def compare(self, line, said):
        printed = self.printed.split("\n")
        for text in said.rstrip("\n").split("\n"):
            if text.strip() not in ("", "...") and not any(same(text, other) for other in printed):
                self.fail(line, f"'{text}' was not printed, but")


def main():
    talus, path, long = Path(sys.argv[1]).resolve(), Path(sys.argv[2]), "--long" in sys.argv
    found = blocks(path.read_text())
    environment = {**os.environ, "PATH": f"{talus.parent}:/usr/bin:{os.environ['PATH']}", "OPENBLAS_NUM_THREADS": "1",
                   "TERM": "dumb", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
    lacking = missing_modules("".join(body for _, info, body in found if info[:1] == ["python"]), environment)
    if lacking:
        print(f"{path}: needs the Python modules {', '.join(lacking)}")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(ROOT / "cases", folder + "/cases")
        os.symlink(talus.parent, folder + "/build")
        page, ran = Page(path, folder, environment), False
        for line, info, body in found:
            kind, words = (info or [""])[0], info[1:]
            if kind == "sh":
                ran = "not-run" not in words and (long or "long" not in words)
                if ran:
                    page.run(line, body, "fails" in words)
            elif kind == "text":
                if ran:
                    page.compare(line, body)
            elif words:
                Path(folder, words[0]).write_text(body)


main()
