import tomllib

import pytest
import tomlkit
from hypothesis import given
from hypothesis import strategies as st

from hsr8.files.text import lines_of
from hsr8.keys import depth

TEXT = '''\
name = "x"   # a = 1
text = """
[world]
radius = 3
"""
[world]
a.b = 1
"quoted key" = 2

[[world.mover]]
speed = 1
[world.mover.deep]
x = 1
[[world.mover]]
# A list over several lines.
speed = [
  1,
  2,
]
'''


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("name",), 1),
        (("text",), 2),
        (("world",), 6),
        (("world", "a", "b"), 7),
        (("world", "quoted key"), 8),
        (("world", "mover", 0, "speed"), 11),
        (("world", "mover", 0, "deep", "x"), 13),
        (("world", "mover", 1), 14),
        (("world", "mover", 1, "speed", 1), 16),
        (("world", "missing"), 6),
        (("missing",), None),
    ],
)
def test_a_key_has_the_first_line_of_its_statement_or_that_of_its_table(path, line, newline):
    assert lines_of(TEXT.replace("\n", newline), [path]).get(path) == line


keys = st.text(max_size=3) | st.sampled_from(["a", "b"])
texts = st.text(max_size=6) | st.sampled_from(['"', "'", "\\", '"""', "'''", "#", "]", "\n[a]\n"])
values = st.recursive(
    st.integers(-9, 9) | st.booleans() | texts,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(keys, inner, max_size=3),
)


def paths_of(value, path=()):
    """Paths of all keys and entries in a value."""
    entries = value.items() if isinstance(value, dict) else enumerate(value)
    for key, inner in entries:
        yield (*path, key)
        if isinstance(inner, dict | list):
            yield from paths_of(inner, (*path, key))


def first_line(text, path):
    """Line on which the shortest valid beginning of the text with the key ends."""
    rows = text.split("\n")
    for n in range(1, len(rows) + 1):
        try:
            data = tomllib.loads("\n".join([*rows[:n], ""]))
        except tomllib.TOMLDecodeError:
            continue
        if depth(data, path) == len(path):
            return n
    return None


@given(st.dictionaries(keys, values, max_size=4))
def test_a_key_is_within_the_shortest_beginning_of_the_text_that_has_it(table):
    text = tomlkit.dumps(table)
    data = tomllib.loads(text)
    paths = list(paths_of(data))
    lines = lines_of(text, paths)
    rows = text.split("\n")
    for path in paths:
        line, last = lines[path], first_line(text, path)
        assert line <= last
        before = "\n".join([*rows[: line - 1], ""])
        try:
            assert depth(tomllib.loads(before), path) < len(path)
        except tomllib.TOMLDecodeError:  # ends within a text or a list
            continue


@pytest.mark.parametrize("quotes", ["'''", '"""'])
def test_quotes_at_the_end_of_a_text_belong_to_it(quotes):
    text = f"a = {quotes}x{quotes[:2]}{quotes}\nb = 1\n"
    assert lines_of(text, [("b",)]) == {("b",): 2}
