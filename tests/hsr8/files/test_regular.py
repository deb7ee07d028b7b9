"""Only regular files of limited size are read; nothing else blocks or fills the memory."""

import os

import pytest

from hsr8.errors import UsageError
from hsr8.files import regular
from hsr8.files.json_lines import open_to_append, read_lines


def test_a_file_is_read_also_through_a_link(tmp_path):
    (tmp_path / "a.txt").write_text("ü")
    (tmp_path / "link").symlink_to("a.txt")
    assert regular.read_text(tmp_path / "link") == "ü"


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
        text = regular.read_text(tmp_path / "file")
    except OSError as error:
        text = error.strerror
    assert text == expected


@pytest.mark.parametrize("path", ["a\0b", "a" * 300, "none"])
def test_a_path_of_no_file_is_an_error_of_the_system(path):
    with pytest.raises(OSError, match=r"null|too long|No such file"):
        regular.read_bytes(path)


@pytest.mark.parametrize("kind", ["pipe", "/dev/zero", "/dev/null", "folder"])
def test_other_kinds_of_files_are_refused(tmp_path, kind):
    path = tmp_path / "x"
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    else:
        path.symlink_to(kind)
    with pytest.raises(OSError, match=r"not a regular file, got a"):
        regular.read_bytes(path)
    with pytest.raises(UsageError, match=r"not a regular file, got a"):
        list(read_lines(path, str))
    with pytest.raises(OSError, match=r"not a regular file, got a"):
        open_to_append(path)


def test_a_sparse_file_is_refused_by_its_content(tmp_path):
    path = tmp_path / "x"
    path.write_bytes(b"1\n")
    os.truncate(path, 60_000_000_000)
    with pytest.raises(OSError, match="larger than 64 MB"):
        regular.read_bytes(path)
    with pytest.raises(UsageError, match=r"x:2: the line is longer than 16 MB"):
        list(read_lines(path, str))


def test_lines_are_appended_after_the_last_whole_one_and_not_through_a_link(tmp_path):
    path = tmp_path / "x"
    path.write_bytes(b"1\n2\n3")
    with open_to_append(path) as file:
        with pytest.raises(BlockingIOError):
            open_to_append(path)
        file.write("4\n")
    assert path.read_bytes() == b"1\n2\n4\n"
    (tmp_path / "link").symlink_to(path)
    with pytest.raises(OSError, match="link"):
        open_to_append(tmp_path / "link")
