"""The YAML that talus itself writes (resolved cases), and JSON for it to read.

Readers for all of YAML take `on` for true and `1e-3` for a text; this one knows the core schema of YAML 1.2:
block mappings and lists, flow collections, plain and quoted texts, comments.
"""

import json
import re

_NUMBER = re.compile(r"[-+]?(\.\d+|\d+(\.\d*)?)([eE][-+]?\d+)?$")
_WORDS = {"null": None, "~": None, "": None, "true": True, "false": False, ".inf": float("inf"),
          "-.inf": float("-inf"), ".nan": float("nan")}
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r"}


def scalar(text):
    """The value of a plain scalar.

    >>> [scalar(word) for word in ("1e+06", "8", "end", "true")]
    [1000000.0, 8, 'end', True]
    """
    if text in _WORDS:
        return _WORDS[text]
    if not _NUMBER.match(text):
        return text
    return float(text) if re.search("[.eE]", text) else int(text)


class _Flow:
    """Reads one value that may be a flow collection, from a text that begins with it."""

    def __init__(self, text):
        self.text, self.at = text, 0

    def skip(self):
        while self.at < len(self.text) and self.text[self.at] in " \n":
            self.at += 1

    def peek(self):
        self.skip()
        return self.text[self.at:self.at + 1]

    def quoted(self):
        mark, out = self.text[self.at], []
        self.at += 1
        while self.text[self.at] != mark or (mark == "'" and self.text[self.at + 1:self.at + 2] == "'"):
            char = self.text[self.at]
            if char == "\\" and mark == '"':
                self.at += 1
                char = _ESCAPES.get(self.text[self.at], self.text[self.at])
            elif char == mark:
                self.at += 1
            out.append(char)
            self.at += 1
        self.at += 1
        return "".join(out)

    def plain(self, ends):
        start = self.at
        while self.at < len(self.text) and not re.match(ends, self.text[self.at:]):
            self.at += 1
        return scalar(self.text[start:self.at].strip())

    def value(self, ends=r"\s*$|\s+#"):
        mark = self.peek()
        if mark and mark in "\"'":
            return self.quoted()
        if mark == "[":
            return self.collection("]", lambda: self.value(r"[,\]]"), list)
        if mark == "{":
            return self.collection("}", self.pair, dict)
        return self.plain(ends)

    def pair(self):
        key = self.value(r":(\s|$)|[,}]")
        if self.peek() != ":":
            return key, None
        self.at += 1
        return key, self.value(r"[,}]")

    def collection(self, end, read, kind):
        items = []
        self.at += 1
        while self.peek() != end:
            if not self.peek():
                raise ValueError(f"'{end}' is missing")
            items.append(read())
            if self.peek() == ",":
                self.at += 1
        self.at += 1
        return kind(items)


_KEY = re.compile(r"""("(?:[^"\\]|\\.)*"|[^\s"'#\[{][^#]*?):(?:\s+(?!\#)(.*)|\s*(?:\#.*)?)$""")


class _Block:
    def __init__(self, text):
        lines = [line.rstrip() for line in text.splitlines()]
        self.lines = [(len(line) - len(line.lstrip()), line.lstrip()) for line in lines
                      if line.strip() and not line.lstrip().startswith(("#", "---"))]
        self.at = 0

    def value(self, indent):
        """What stands at the present line and is indented at least so far; None if nothing is."""
        if self.at == len(self.lines) or self.lines[self.at][0] < indent:
            return None
        here, line = self.lines[self.at]
        if line.startswith("- ") or line == "-":
            return self.items(here)
        if _KEY.match(line):
            return self.mapping(here)
        self.at += 1
        return _Flow(line).value()

    def items(self, indent):
        out = []
        while self.at < len(self.lines) and self.lines[self.at][0] == indent and self.lines[self.at][1][:1] == "-":
            rest = self.lines[self.at][1][1:]
            if rest.strip():
                self.lines[self.at] = (indent + 1 + len(rest) - len(rest.lstrip()), rest.lstrip())
            else:
                self.at += 1
            out.append(self.value(indent + 1))
        return out

    def mapping(self, indent):
        out = {}
        while self.at < len(self.lines) and self.lines[self.at][0] == indent:
            match = _KEY.match(self.lines[self.at][1])
            if not match:
                raise ValueError(f"no key: {self.lines[self.at][1]}")
            key, rest = _Flow(match.group(1)).value(r"$"), match.group(2)
            self.at += 1
            list_here = self.at < len(self.lines) and self.lines[self.at][1][:1] == "-"
            out[key] = _Flow(rest).value() if rest else self.value(indent if list_here else indent + 1)
        return out


def loads(text):
    """A resolved case as dicts, lists, numbers and texts.

    >>> loads("grid:\\n  counts: [8, 8]\\n  size: 0.5  # m\\nbodies:\\n  - name: block\\n    at: {x: 0}\\n")
    {'grid': {'counts': [8, 8], 'size': 0.5}, 'bodies': [{'name': 'block', 'at': {'x': 0}}]}
    """
    return _Block(text).value(0)


def key(name):
    """A key as a text. Readers of YAML 1.1, such as PyYAML, take the key `on` for true, and `off` for false.

    >>> key("grid"), key(True)
    ('grid', 'on')
    """
    return {True: "on", False: "off"}[name] if isinstance(name, bool) else str(name)


def plain(value):
    """Numbers and arrays of NumPy, paths and tuples as what JSON knows.

    >>> plain({"size": np.float64(0.5), "min": np.zeros(2), "mesh": ("a", 1)})
    {'size': 0.5, 'min': [0.0, 0.0], 'mesh': ['a', 1]}
    """
    if isinstance(value, dict):
        return {key(name): plain(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if hasattr(value, "__fspath__"):
        return value.__fspath__()
    if value is not None and not isinstance(value, (str, int, float)):
        raise TypeError(f"a case holds dicts, lists, numbers and texts, not {type(value).__name__}: {value!r}")
    if isinstance(value, float) and not abs(value) < float("inf"):
        raise ValueError(f"a case cannot hold {value}")
    return value


def one_line(value):
    """A value as it stands behind ``--set KEY=``."""
    return json.dumps(plain(value), ensure_ascii=False)


def dumps(document):
    """JSON with a key a line, and the path of the key in each line.

    >>> text, keys = dumps({"method": "mpm", "bodies": [{"name": "block"}]})
    >>> print(text)
    {
      "method": "mpm",
      "bodies": [
        {
          "name": "block"
        }
      ]
    }
    >>> keys[5]
    'bodies[0].name'
    """
    lines, keys = [], {}

    def add(text, path):
        lines.append(text)
        keys[len(lines)] = path

    def is_flat(value):
        return not isinstance(value, (dict, list)) or not any(isinstance(item, (dict, list)) for item in value) and \
            not (isinstance(value, dict) and value)

    def write(value, path, indent, head, tail):
        if is_flat(value):
            add(" " * indent + head + json.dumps(value, ensure_ascii=False) + tail, path)
            return
        named = isinstance(value, dict)
        add(" " * indent + head + "{["[not named], path)
        for i, item in enumerate(value):
            below = (f"{path}.{item}" if path else item) if named else f"{path}[{i}]"
            write(value[item] if named else item, below, indent + 2,
                  json.dumps(item, ensure_ascii=False) + ": " if named else "", "," if i + 1 < len(value) else "")
        add(" " * indent + "}]"[not named] + tail, path)

    write(plain(document), "", 0, "", "")
    return "\n".join(lines), keys
