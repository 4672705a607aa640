"""Sphinx: the pages that assemble.py has put together, in the theme furo, with formulas set by KaTeX at build time."""
import json
import os
import shutil
import subprocess
from pathlib import Path

from docutils.nodes import SkipNode
from sphinx.util.logging import getLogger

HERE = Path(__file__).resolve().parent
logger = getLogger(__name__)
KATEX = Path("/usr/share/javascript/katex")

project = "talus"
version = release = os.environ.get("TALUS_VERSION", "")
html_title = f"talus {version}".strip()
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
root_doc = "index"
myst_enable_extensions = ["dollarmath"]
myst_dmath_double_inline = True
myst_heading_anchors = 6
smartquotes = False
html_theme = "furo"
html_static_path = [str(HERE / "static")]
html_css_files = ["talus.css", "katex/katex.min.css"]
html_extra_path = ["_extra"]
exclude_patterns = ["_extra"]
html_math_renderer = "katex"
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False
highlight_language = "text"
html_theme_options = {"navigation_with_keys": True}


class Katex:
    """A process of Node.js that sets one formula after another."""

    def __init__(self):
        self.process = None

    def set(self, node, display):
        source = node.astext()
        if not self.process:
            self.process = subprocess.Popen(["node", str(HERE / "katex.js")], stdin=subprocess.PIPE,
                                            stdout=subprocess.PIPE, text=True,
                                            env={**os.environ, "NODE_PATH": "/usr/share/nodejs"})
        self.process.stdin.write(json.dumps({"source": source, "display": display}) + "\n")
        self.process.stdin.flush()
        answer = json.loads(self.process.stdout.readline())
        if "error" in answer:
            logger.warning("%s in the formula '%s'", answer["error"], source, location=node)
        return answer.get("html", "")


katex = Katex()


def visit_inline(translator, node):
    translator.body.append(katex.set(node, False))
    raise SkipNode


def visit_block(translator, node):
    translator.body.append(f'<div class="formula">{katex.set(node, True)}</div>\n')
    raise SkipNode


def copy_katex(app, exception):
    """The style and the fonts of the formulas stand beside the pages: nothing is fetched when they are read."""
    if not exception:
        folder = Path(app.outdir) / "_static" / "katex"
        (folder / "fonts").mkdir(parents=True, exist_ok=True)
        shutil.copy(KATEX / "katex.min.css", folder)
        for font in (KATEX / "fonts").glob("*.woff2"):
            shutil.copy(font, folder / "fonts")


def open_one_branch(app, page, template, context, doctree):
    """The tree beside a page is open where the page stands: all of it, for each of 150 pages, is half of the time of a build."""
    whole = context.get("toctree")
    if whole:
        context["toctree"] = lambda **options: whole(**{**options, "collapse": True})


def setup(app):
    app.connect("html-page-context", open_one_branch, priority=100)  # before the theme asks for it
    app.add_html_math_renderer("katex", (visit_inline, None), (visit_block, None))
    app.connect("build-finished", copy_katex)
