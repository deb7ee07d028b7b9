"""Banned wording in documentation, docstrings, comments, messages and names.

    python scripts/check_words.py [PATH ...]
    python scripts/check_words.py --fragments [PATH ...]

lists every match with the suggested words. The rules: one term per concept, the terms of the field,
plain present-day English. ``--fragments`` lists the lines of arguments and attributes that are not
noun phrases ("pose: of the robot" for "pose: pose of the robot"), and their number by package.
"""

import ast
import io
import re
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("compilation", "hsr8", "navigation", "walking", "vision", "scripts", "examples")

BANNED = {
    r"what (?:stands?|moves?|it|has|had|was|were|falls?|comes?|they|happens|nobody)\b": "a noun: "
    "static obstacles, the recorded velocity",
    r"(?:^|[.:;] )what (?!if\b)[^?\n]{0,60}[^?](?:$|\.)": "a noun in place of a 'what' clause",
    r"(?<!there )(?:is|are|was|were) no (?!longer\b|more\b|less\b|later\b)\w+": "is not a, must be",
    r"ha(?:s|ve) no \w+ but": "has only",
    r"(?:tell|told|tells|telling) apart": "distinguish; no significant difference",
    r"of (?:one's|its|his|our|your|their) own": "its own ..., custom, user-defined",
    r"besides?": "next to; also, except",
    r"sooner": "earlier, faster",
    r"of late": "recently",
    r"anew": "again",
    r"heed(?:s|ed|ing)?": "respect, consider",
    r"mend(?:s|ed|ing)?": "fix, repair",
    r"for want of": "without",
    r"will not do": "is not valid",
    r"at the least": "at least",
    r"for good": "permanently",
    r"once more": "again",
    r"by how much": "the amount by which; the derivative of",
    r"pictures?": "image",
    r"things?": "object, obstacle, item",
    r"shares? of|as a share|_shares?": "fraction, ratio",
    r"great(?:er|est)?": "large, larger, more",
    r"tells?|told|telling": "report, show, return",
    r"hears?|heard": "receive, is notified of",
    r"says|said": "state, list, describe",
    r"nobody|somebody|anybody": "the noun that is meant; no user, no listener",
    r"likewise|ours": "the noun that is meant",
    r"the same(?=[.,;:)]|$)": "the same with its noun",
    r"set-points?": "setpoint",
    r"time-outs?": "timeout",
    r"way[- ]points?": "waypoint",
    r"(?:least|largest|smallest|greatest|biggest)_\w*": "min_, max_",
    r"(?:the|an?|its|their|this|that|same|other|any|no|every|each|whole|straight|long)"
    r" ways?(?! station)": "path, route, direction, method",
    r"(?:file|key|text|number|page|table|test|list|line|code|name|module)s? stands?": "is",
    r"\d+ (?!if )(?:\w+ )?an? (?:second|tick|level|frame|run|metre|minute|step|seed)": "per",
}
PATTERN = re.compile(
    "|".join(f"(?P<p{k}>(?<![\\w-])(?:{p})(?!\\w))" for k, p in enumerate(BANNED)),
    re.IGNORECASE | re.MULTILINE,
)
SUGGESTIONS = list(BANNED.values())
NAMES = {"found", "told", "said", "thing", "things", "law", "way", "place", "seen"}


def check_text(text: str) -> Iterator[tuple[int, str, str]]:
    """Banned phrases in prose.

    Args:
        text: prose; code between backticks is skipped.

    Yields:
        Line number from 0, phrase and suggestion.
    """
    prose = re.sub(
        r"(```.*?```|`[^`\n]*`)", lambda m: re.sub(r"[^\n]", "_", m[0]), text, flags=re.S
    )
    for match in PATTERN.finditer(prose):
        suggestion = SUGGESTIONS[int(str(match.lastgroup)[1:])]
        yield text.count("\n", 0, match.start()), match[0].strip(" .:;\n"), suggestion


def check_python(source: str) -> Iterator[tuple[int, str, str]]:
    """Banned phrases in strings and comments of Python code, and banned names of variables."""
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            for _, phrase, suggestion in check_text(token.string[1:].strip()):
                yield token.start[0], phrase, suggestion
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
            for line, phrase, suggestion in check_text(node.value):
                yield node.lineno + line, phrase, suggestion
        for name in _names(node):
            if name in NAMES:
                yield getattr(node, "lineno", 0), f"name `{name}`", "a name from the domain"


ENTRIES = re.compile(r"^( *)(?:Args|Attributes|Returns):\n((?:\1 +.*\n|\n)+)", re.MULTILINE)
FRAGMENT = re.compile(
    r"(?:of|in|on|at|by|to|for|from|with|without|within|along|across|after|before|between|until|per"
    r"|that|which|whose|where|when|also|as|if|is|are|was|has|have|may)\b",
    re.IGNORECASE,
)


def entries(source: str) -> Iterator[tuple[int, str, str]]:
    """Arguments and attributes that docstrings describe.

    Args:
        source: Python code.

    Yields:
        Line number, name and description.
    """
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            continue
        if ast.get_docstring(node, clean=False) is None:
            continue
        docstring = node.body[0]
        assert isinstance(docstring, ast.Expr)
        text = ast.get_docstring(node, clean=False) or ""
        for section in ENTRIES.finditer(text + "\n"):
            first = section[2]
            indent = len(first) - len(first.lstrip())
            for match in re.finditer(
                rf"^ {{{indent}}}(\*{{0,2}}\w[\w, ]*): (.*)", first, re.MULTILINE
            ):
                offset = text.count("\n", 0, section.start(2) + match.start())
                yield docstring.lineno + offset, match[1], match[2]


def fragments(source: str) -> tuple[list[str], int]:
    """Fragments among the lines of arguments and attributes.

    Args:
        source: Python code.

    Returns:
        The fragments with their line numbers, and the number of all lines.
    """
    every = list(entries(source))
    bad = [f"{line}: {name}: {text}" for line, name, text in every if FRAGMENT.match(text)]
    return bad, len(every)


def check_file(path: Path) -> list[str]:
    """Findings in a file, one line each: place, phrase, suggestion."""
    text = path.read_text(encoding="utf-8")
    check = check_python if path.suffix == ".py" else _check_page
    where = path.relative_to(ROOT) if path.is_relative_to(ROOT) else path
    return [f"{where}:{line}: {phrase!r} -> {hint}" for line, phrase, hint in check(text)]


def _check_page(text: str) -> Iterator[tuple[int, str, str]]:
    for line, phrase, suggestion in check_text(text):
        yield line + 1, phrase, suggestion


def _names(node: ast.AST) -> Iterator[str]:
    match node:
        case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name):
            yield name
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            yield name


def files(paths: list[Path]) -> list[Path]:
    """Python files and pages below the paths, except this one, which lists the banned words."""
    return [
        file
        for path in paths
        for file in ([path] if path.is_file() else sorted(path.rglob("*")))
        if file.suffix in (".py", ".md") and file.is_file() and not file.samefile(__file__)
    ]


def report_fragments(paths: list[Path]) -> None:
    """Print all fragments, and their number by folder."""
    summary = []
    for path in paths:
        total = count = 0
        for file in files([path]):
            if file.suffix == ".py":
                lines, number = fragments(file.read_text(encoding="utf-8"))
                for line in lines:
                    print(f"{file.relative_to(ROOT)}:{line}")
                total, count = total + number, count + len(lines)
        summary.append(f"{path.relative_to(ROOT)}: {count} of {total} lines are fragments")
    print("\n".join(summary))


def main() -> int:
    """Check the paths on the command line; return the exit code."""
    words = sys.argv[1:]
    paths = [Path(word).resolve() for word in words if word != "--fragments"]
    if "--fragments" in words:
        report_fragments(paths or [ROOT / package for package in PACKAGES])
        return 0
    pages = [ROOT / "docs", ROOT / "models", *ROOT.glob("*.md")]
    every = files(paths or [*(ROOT / package for package in PACKAGES), *pages])
    findings = [line for file in every for line in check_file(file)]
    print("\n".join([*findings, f"{len(findings)} findings"]))
    return bool(findings)


if __name__ == "__main__":
    sys.exit(main())
