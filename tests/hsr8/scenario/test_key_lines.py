import pytest

from hsr8.scenario.key_lines import line_of

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
def test_a_key_has_the_line_on_which_it_begins_or_that_of_its_table(path, line, newline):
    assert line_of(TEXT.replace("\n", newline), path) == line
