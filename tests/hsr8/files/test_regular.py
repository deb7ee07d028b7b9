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


@pytest.mark.parametrize("kind", ["pipe", "/dev/zero", "/dev/null", "folder"])
def test_other_kinds_of_files_are_refused(tmp_path, kind):
    path = tmp_path / "x"
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    else:
        path.symlink_to(kind)
    with pytest.raises(OSError, match=r"not a regular file|Is a directory"):
        regular.read_bytes(path)
    with pytest.raises(UsageError, match=r"not a regular file|Is a directory"):
        list(read_lines(path, str))
    with pytest.raises(OSError, match=r"not a regular file|Is a directory"):
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
