import pytest

from hsr8.cli.output_file import require_png, writing
from hsr8.errors import UsageError


def test_a_file_that_cannot_be_written_is_told_with_its_option(tmp_path):
    file = tmp_path / "none" / "x.png"
    with (
        pytest.raises(UsageError, match=rf"--out {file}: cannot be written: No such file"),
        writing("--out", file),
    ):
        file.write_bytes(b"")


def test_other_errors_are_left_alone(tmp_path):
    with pytest.raises(ZeroDivisionError), writing("--out", tmp_path / "x"):
        raise ZeroDivisionError


def test_a_picture_is_a_png_in_a_folder_that_is_there(tmp_path):
    require_png("--picture", tmp_path / "x.PNG")
    with pytest.raises(UsageError, match=r"--picture .*x\.jpg: give a file that ends in \.png"):
        require_png("--picture", tmp_path / "x.jpg")
    with pytest.raises(UsageError, match="there is no folder"):
        require_png("--picture", tmp_path / "none" / "x.png")
