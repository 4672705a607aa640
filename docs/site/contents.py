"""In which part of the site a page stands. A page belongs to the first pattern that fits; what fits together is in order of
name. A new docs/*.md that nothing names stands under "Use", a new case in the gallery,
any other page under "Extend"."""

PARTS = [
    ("Learn", ["docs/tutorial/*", "gallery"]),
    ("Guide", ["docs/guide/choose", "docs/guide/resolution", "docs/guide/loads", "docs/guide/trust", "docs/guide/limits",
               "docs/guide/*"]),
    ("Use", ["docs/messages", "docs/sweep", "docs/calibrate", "docs/checkpoint", "docs/trust", "docs/python", "docs/*"]),
    ("Reference", ["docs/case-file", "lists", "docs/command-line", "commands", "library"]),
    ("Background", ["docs/theory", "docs/verification", "bench/README", "docs/scaling", "docs/decisions",
                    "docs/experiments/README", "CHANGELOG"]),
    ("Extend", ["CONTRIBUTING", "src/README", "*"]),
]

# Pages that stand below another one: the gallery has the cases, an overview its folder.
BELOW = [
    ("cases/*/README", "gallery"),
    ("docs/experiments/*", "docs/experiments/README"),
    ("src/*/README", "src/README"),
    ("src/*/*/README", "src/README"),
    ("docs/example/*", "library"),
    ("python/*", "docs/python"),
    ("docs/site/README", "CONTRIBUTING"),
    ("packaging/README", "CONTRIBUTING"),
    ("tests/*", "CONTRIBUTING"),
    ("bench/*", "bench/README"),
]
