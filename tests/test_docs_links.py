"""Links, anchors, images and named files of every Markdown file exist."""

import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
IGNORED = {".venv", "runs", "sweeps", "build", "dist"}
PAGES = sorted(
    page.relative_to(ROOT)
    for page in ROOT.rglob("*.md")
    if not any(part in IGNORED or part.startswith(".") for part in page.relative_to(ROOT).parts)
)
LINK = re.compile(r"\]\(<?([^)\s>]+)>?[^)]*\)|(?:src|href)=\"([^\"]+)\"|^\[[^\]]+\]: (\S+)", re.M)
CODE = re.compile(r"^```.*?^```|`[^`\n]*`", re.M | re.S)


def links(text: str) -> list[str]:
    """Targets within the repository, as they are written."""
    targets = ["".join(found) for found in LINK.findall(CODE.sub("", text))]
    return [t for t in targets if not re.match(r"[a-z]+:", t)]


@cache
def anchors(page: Path) -> set[str]:
    """The headings' names, as GitHub forms them."""
    lines = re.findall(
        r"^#+ (.*)$", re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S), re.M
    )
    words = (re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", line).lower().strip() for line in lines)
    return {re.sub(r"[^\w\- ]", "", line).replace(" ", "-") for line in words}


def leads_somewhere(page: Path, target: str) -> bool:
    path, _, anchor = target.partition("#")
    file = page.parent / path if path else page
    if not file.exists():
        return False
    return not anchor or file.suffix != ".md" or anchor in anchors(file)


@pytest.mark.parametrize("page", PAGES, ids=str)
def test_links_lead_somewhere(page):
    page = ROOT / page
    assert [t for t in links(page.read_text()) if not leads_somewhere(page, t)] == []


def test_every_page_of_the_documentation_is_in_its_index():
    index = ROOT / "docs" / "README.md"
    listed = {(index.parent / t.partition("#")[0]).resolve() for t in links(index.read_text())}
    for page in (ROOT / "docs").glob("*.md"):
        assert page == index or page in listed, page.name


# The changelog is history; the names in equations.md are relative to other folders and have a test.
PRESENT = [page for page in PAGES if page.name not in ("CHANGELOG.md", "equations.md")]


@pytest.mark.parametrize("page", PRESENT, ids=str)
def test_names_of_the_code_exist(page):
    named = re.findall(r"`(\w[\w/]*/\w+\.py)(?:::(\w+))?`", (ROOT / page).read_text())
    for file, name in named:
        defined = rf"^(class|def) {name}\b" if name else ""
        assert re.search(defined, (ROOT / file).read_text(), re.M), f"{file}::{name}"
