import tomllib

from hsr8.scenario.toml_lines import locate, nearest

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
speed = [
  1,
  2,
]
'''


def test_every_key_is_found_on_its_line():
    lines = locate(TEXT, tomllib.loads(TEXT))
    assert lines[("name",)] == 1
    assert lines[("text",)] == 2
    assert lines[("world",)] == 6
    assert ("world", "radius") not in lines
    assert lines[("world", "a", "b")] == 7
    assert lines[("world", "quoted key")] == 8
    assert lines[("world", "mover", 0, "speed")] == 11
    assert lines[("world", "mover", 0, "deep", "x")] == 13
    assert lines[("world", "mover", 1)] == 14
    assert lines[("world", "mover", 1, "speed")] == 15


def test_what_has_no_line_takes_that_of_its_table():
    lines = locate(TEXT, tomllib.loads(TEXT))
    assert nearest(lines, ("world", "mover", 1, "speed", 1)) == 15
    assert nearest(lines, ("world", "missing")) == 6
    assert nearest(lines, ("missing",)) is None


def test_a_table_that_only_dots_tell_of_is_on_their_line():
    text = 'extends = "quick"\nwold.size = [3, 3]\n[a.b]\nc.d = 1\n[a]\n'
    lines = locate(text, tomllib.loads(text))
    assert lines[("wold",)] == 2
    assert lines[("a", "b", "c")] == 4
    assert lines[("a",)] == 5
