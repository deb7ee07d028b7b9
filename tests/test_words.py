"""The project is written in plain technical English: banned words, each with suggested ones.

One term per concept, the terms of the field, plain present-day English.
"""

import ast
import io
import re
import tokenize
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("compilation", "hsr8", "navigation", "walking", "vision", "scripts", "examples")
PAGES = (*sorted(ROOT.glob("*.md")), *sorted(ROOT.glob("docs/**/*.md")))

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
    "(?<![\\w-])(?:" + "|".join(f"(?P<p{k}>{p})" for k, p in enumerate(BANNED)) + r")(?!\w)",
    re.IGNORECASE | re.MULTILINE,
)
SUGGESTIONS = list(BANNED.values())
NAMES = {"found", "told", "said", "thing", "things", "law", "way", "place", "seen"}
CODE = re.compile(r"(```.*?```|`[^`\n]*`)", re.DOTALL)


def banned_in(text, first_line=1):
    """Return line, phrase and suggestion of the banned words of prose, without its code."""
    prose = CODE.sub(lambda match: re.sub(r"[^\n]", "_", match[0]), text)
    return [
        f"{first_line + text.count(chr(10), 0, match.start())}: {match[0].strip()!r} -> "
        f"{SUGGESTIONS[int(match.lastgroup[1:])]}"
        for match in PATTERN.finditer(prose)
    ]


def banned_in_python(source):
    """Return those of the comments, texts and names of Python code."""
    lines = []
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            lines += banned_in(token.string[1:].strip(), token.start[0])
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
            lines += banned_in(node.value, node.lineno)
        stored = isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
        name = node.id if stored else getattr(node, "arg", None) or getattr(node, "name", None)
        if isinstance(node, ast.Name | ast.arg | ast.FunctionDef | ast.ClassDef) and name in NAMES:
            lines.append(f"{node.lineno}: name {name!r} -> a name from the domain")
    return lines


@pytest.mark.parametrize("package", PACKAGES)
def test_code_has_no_banned_words(package):
    findings = [
        f"{file.relative_to(ROOT)}:{line}"
        for file in sorted((ROOT / package).rglob("*.py"))
        for line in banned_in_python(file.read_text(encoding="utf-8"))
    ]
    assert not findings, "\n".join(findings)


def test_pages_have_no_banned_words():
    findings = [
        f"{page.relative_to(ROOT)}:{line}"
        for page in PAGES
        for line in banned_in(page.read_text(encoding="utf-8"))
    ]
    assert not findings, "\n".join(findings)
