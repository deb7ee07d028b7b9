"""TOML of bounded cost."""

import pytest

from hsr8.files.toml import MAX_COMMAS, MAX_KEYS, TomlError, parse_toml


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a = 1\na = 2\n", "invalid TOML: Cannot overwrite a value"),
        ("a = " + "[" * 40_000, "invalid TOML: nested too deeply"),
        ("[" + "a." * 40 + "b]", "invalid TOML: nested too deeply, a key of more than 32 parts"),
        ("'a'.\"a\". b ." * 11 + "a = 1", "invalid TOML: nested too deeply"),
        ("a = 1\n" * (MAX_KEYS + 1), "too many keys or values"),
        ("a = [" + "1," * (MAX_COMMAS + 1) + "]", "too many keys or values"),
        ("a = [[1], {b = 0x" + "f" * 9000 + "}]", "invalid TOML: an integer of 36000 bits"),
        ("[a.'" + "b" * 1000 + "']\n" * 2, "invalid TOML: "),
    ],
)
def test_texts_of_unbounded_cost_are_refused_in_one_short_line(text, expected):
    with pytest.raises(TomlError) as error:
        parse_toml(text)
    assert str(error.value).startswith(expected)
    assert len(str(error.value)) < 400


@pytest.mark.parametrize(
    "text", ["a.b = 1", "a = 'x." + "y." * 50 + "z'", "a = -9223372036854775808"]
)
def test_other_texts_are_tables(text):
    assert list(parse_toml(text)) == ["a"]
