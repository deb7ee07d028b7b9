"""Sphinx configuration of the manual; `make docs` builds it into `build/docs`.

The pages are Markdown as GitHub shows it. The contents below are appended to the start page as the
tables of contents that Sphinx needs.
"""

import re

import hsr8  # before NumPy: it selects the arithmetic

CONTENTS = {
    "First steps": ("install", "tutorial"),
    "Concepts": ("concepts", "worlds", "vision", "belief", "gaze", "planning", "walking"),
    "How to": (
        *("python", "sweeps", "bench", "robots", "gym"),
        *("faults", "crowds", "circle", "export", "ros"),
    ),
    "Paper": ("equations", "figures"),
    "Reference": ("commands", "scenarios", "files", "metrics", "data", "api"),
    "Results": ("results/*",),
    "About": ("trust", "limitations", "architecture", "notes"),
}
"""Pages by part of the manual, in their order."""

project = "hsr8"
author = "hsr8 maintainers"
version = release = hsr8.__version__
root_doc = "README"
copyright = "2026, hsr8 maintainers; Apache License 2.0"
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",  # formulas without a network
]
html_theme = "furo"
html_title = f"hsr8 {release}"
myst_enable_extensions = ["dollarmath", "html_image"]
myst_heading_anchors = 3
napoleon_google_docstring = True
napoleon_use_ivar = True
autodoc_typehints = "none"
autodoc_member_order = "bysource"


def _with_contents(text: str) -> str:
    """Return the start page with the tables of contents of Sphinx."""
    trees = (
        f"```{{toctree}}\n:hidden:\n:glob:\n:caption: {caption}\n\n{chr(10).join(pages)}\n```\n"
        for caption, pages in CONTENTS.items()
    )
    return "\n".join([text, *trees])


def _with_downloads(text: str, depth: int) -> str:
    """Return a page in which links to Markdown files outside of the manual are downloads.

    Args:
        text: of the page.
        depth: of its folder below that of the manual.
    """
    up = rf"(?:\.\./){{{depth + 1},}}"
    link = rf"\[([^\]]+)\]\(({up}[^)#]+\.(?:md|cff))(?:#[^)]*)?\)"
    return re.sub(link, r"{download}`\1 <\2>`", text)


def _complete(app, name, source):
    """Prepare a page; see the event source-read of Sphinx."""
    source[0] = _with_downloads(source[0], name.count("/"))
    if name == root_doc:
        source[0] = _with_contents(source[0])


def setup(app):
    """Connect the event that completes the start page."""
    app.connect("source-read", _complete)
