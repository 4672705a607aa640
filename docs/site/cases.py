"""What the gallery says of each case: taken from its README.md, its case.yaml and times.tsv; nothing is listed here."""
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TIMES = Path(__file__).resolve().with_name("times.tsv")


def plain(markdown):
    """Markdown without its marks."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", markdown)
    return re.sub(r"[`*]", "", text)


def first_sentence(paragraph):
    """Up to the first full stop that ends a sentence; abbreviations end none, parentheses are left out."""
    text = re.sub(r" \([^()]*\)", "", " ".join(paragraph.split()))
    for end in re.finditer(r"[.?](?= |$)", text):
        if not re.search(r"(et al|e\.g|i\.e|fig|eq|sec)\.$", text[: end.end()]):
            return text[: end.start()] + ("?" if end.group() == "?" else ".")
    return text


def times():
    """{case: processor time in words} as measured, and with what it was measured from when to when."""
    rows, days = {}, {}
    for line in TIMES.read_text().splitlines() if TIMES.exists() else []:
        if line.startswith("#"):
            continue
        name, seconds, machine, day = line.split("\t")
        rows[name] = seconds + " s" if seconds[0].isdigit() else seconds
        days.setdefault(machine, set()).add(day)
    return rows, [f"{machine}, {min(d)}" + (f" to {max(d)}" if len(d) > 1 else "") for machine, d in sorted(days.items())]


GROUPS = ["Solids", "Contact", "Soil", "Grains and powders", "Other commands"]


class Case:
    """A folder of cases/ as the gallery sees it."""

    def __init__(self, folder):
        self.folder, self.name = folder, folder.name
        self.readme = (folder / "README.md").read_text()
        self.title = re.search(r"^# (.*)", self.readme, re.M).group(1)
        body = self.readme.split("\n", 1)[1]
        paragraphs = [p for p in re.split(r"\n\s*\n", body.strip("\n")) if not re.match(r"[`|!#>\s-]", p)]
        self.sentence = first_sentence(plain(paragraphs[0])) if paragraphs else self.title
        self.pictures = re.findall(r"!\[[^\]]*\]\(([^)\s]+)\)", self.readme)

    def value(self, key):
        """The first value of a key in the case file, wherever it stands; an empty text if there is none."""
        path = self.folder / "case.yaml"
        text = re.sub(r"#.*", "", path.read_text()) if path.exists() else ""
        found = re.search(rf"\b{key}: *([\w.-]*)", text)
        return (found.group(1) or "yes") if found else ""

    @property
    def words(self):
        """Method, kinematics, analysis and law, as the case file names them."""
        return [word for word in map(self.value, ("method", "kinematics", "type", "law", "formulation")) if word]

    @property
    def group(self):
        """What the case is about, told from its case file."""
        if not self.words:
            return "Other commands"
        if not re.match("neo-hookean|j2", self.value("law")):
            flows = self.value("type") == "dynamic" and self.value("friction_angle") != "0"
            return "Grains and powders" if flows else "Soil"
        return "Contact" if self.value("walls") or self.value("interfaces") else "Solids"

    @property
    def command(self):
        """The first command that the README shows and the remark behind it."""
        found = re.search(rf"^\s*(talus \w+ cases/{self.name}/\S+)([^#\n]*)(#.*)?$", self.readme, re.M)
        if found:
            return found.group(1), (found.group(3) or "").lstrip("# ").strip()
        return f"talus run cases/{self.name}/case.yaml", ""

    @property
    def stated_time(self):
        """The time that the remark behind the command states, in its words."""
        number = r"(?:a quarter of an?|half an?|an?|one|two|three|five|six|ten|some|a few|\d+)"
        found = re.findall(rf"\b((?:{number} )?(?:hours?|minutes?|seconds?|s)\b(?: or (?:more|so))?)", self.command[1])
        return found[-1] if found else ""

    @property
    def is_long(self):
        """Whether the README states more than a minute."""
        seconds = re.match(r"(\d+) s", self.stated_time)
        return bool(re.search(r"(?<!half a )(?<!quarter of a )(minute|hour)", self.stated_time)
                    or (seconds and int(seconds.group(1)) > 60))


def all_cases():
    """Every folder of cases/ with a README.md, by name."""
    return [Case(readme.parent) for readme in sorted(ROOT.glob("cases/*/README.md"))]
