"""Text files in UTF-8, and TOML."""

import pytest

from hsr8.files.text import read_text


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("\ufeffa = 1".encode(), "a = 1"),
        ("ä".encode(), "ä"),
        ("a".encode("utf-16"), "wrong encoding, got UTF-16; expected UTF-8"),
        ("aä".encode("latin-1"), "wrong encoding, got byte 0xe4 at 1; expected UTF-8"),
    ],
)
def test_text_is_utf_8_with_or_without_a_mark(content, expected, tmp_path):
    (tmp_path / "file").write_bytes(content)
    try:
        text = read_text(tmp_path / "file")
    except OSError as error:
        text = error.strerror
    assert text == expected


@pytest.mark.parametrize("path", ["a\0b", "a" * 300, "none"])
def test_a_path_of_no_file_is_an_error_of_the_system(path):
    with pytest.raises(OSError, match=r"null|too long|No such file"):
        read_text(path)
