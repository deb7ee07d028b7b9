"""The project is written in plain technical English: see `check_words` for the banned words."""

from pathlib import Path

import pytest
from check_words import PACKAGES, ROOT, check_file, check_python, check_text, files, fragments

PAGES = files([ROOT / "docs", ROOT / "models", *ROOT.glob("*.md")])


@pytest.mark.parametrize("package", PACKAGES)
def test_docstrings_comments_and_messages_have_no_banned_words(package: str) -> None:
    findings = [line for file in files([ROOT / package]) for line in check_file(file)]

    assert not findings, "\n".join(findings)


@pytest.mark.parametrize("package", PACKAGES)
def test_lines_of_arguments_and_attributes_are_noun_phrases(package: str) -> None:
    sources = [file for file in files([ROOT / package]) if file.suffix == ".py"]
    results = [fragments(file.read_text(encoding="utf-8")) for file in sources]
    lines = [line for bad, _ in results for line in bad]

    assert len(lines) <= 0.02 * sum(number for _, number in results), "\n".join(lines)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_pages_have_no_banned_words(page: Path) -> None:
    assert not check_file(page), "\n".join(check_file(page))


@pytest.mark.parametrize(
    ("text", "suggestion"),
    [
        ("It avoids what stands there.", "static obstacles"),
        ("The camera is no sensor of this kind.", "is not a"),
        ("Not told apart.", "no significant difference"),
        ("A planner of one's own.", "custom"),
        ("The key stands in the file.", "is"),
        ("10 pushes a level.", "per"),
        ("The largest_step bounds it.", "max_"),
        ("The set-points of a tick.", "setpoint"),
        ("On the way it turns.", "path"),
    ],
)
def test_banned_words_are_reported_with_a_suggestion(text: str, suggestion: str) -> None:
    ((_, _, hint),) = check_text(text)

    assert suggestion in hint


@pytest.mark.parametrize(
    "text",
    [
        "Return the ZMP of the planned motion (2,) [m].",
        "There is no log in this folder.",
        "Whether the robot stands; what if it falls?",
        "The key `least_time` of version 1.",
    ],
)
def test_plain_text_passes(text: str) -> None:
    assert not list(check_text(text))


def test_python_is_checked_in_docstrings_comments_messages_and_names() -> None:
    source = '"""Mend it."""\nfound = f"nobody answers {1}"  # a picture\nplain = "found"\n'

    phrases = {phrase for _, phrase, _ in check_python(source)}

    assert phrases == {"Mend", "name `found`", "nobody", "picture"}


def test_lines_of_arguments_that_are_not_noun_phrases_are_fragments():
    source = '''class Robot:
    """Robot.

    Attributes:
        pose: of the robot in the world (3,)
            [m, m, rad].
        radius: radius of the robot [m].
    """

    def walk(self, speed, *legs):
        """Walk.

        Args:
            speed: mean speed, along the path:
                of the trunk [m/s].
            *legs: that walk.
        """
'''

    lines, number = fragments(source)

    assert lines == ["5: pose: of the robot in the world (3,)", "16: *legs: that walk."]
    assert number == 4
