import os
import signal

import pytest

from hsr8.cli.output_file import parse_size, require_file_name, writing
from hsr8.errors import UsageError
from hsr8.process.signals import like_ctrl_c


def test_a_file_that_cannot_be_written_is_reported_with_its_option(tmp_path):
    file = tmp_path / "none" / "x.png"
    with (
        pytest.raises(UsageError, match=rf"--out {file}: cannot be written: No such file"),
        writing("--out", file),
    ):
        file.write_bytes(b"")


def test_suffix_and_folder_are_checked(tmp_path):
    require_file_name("--image", tmp_path / "x.PNG", (".png",))
    for file, reason in (
        (tmp_path / "x.jpg", r"--image .*x\.jpg: wrong suffix; expected \.png"),
        (tmp_path / "none" / "x.png", "no folder"),
    ):
        with pytest.raises(UsageError, match=reason):
            require_file_name("--image", file, (".png",))
    (tmp_path / "y.png").mkdir()
    with pytest.raises(UsageError, match="it is a folder"):
        require_file_name("--image", tmp_path / "y.png", (".png",))


@pytest.mark.parametrize(("text", "size"), [("960x540", (960, 540)), (" 1280×720 ", (1280, 720))])
def test_sizes(text, size):
    assert parse_size(text) == size


def test_sigterm_interrupts():
    with pytest.raises(KeyboardInterrupt), like_ctrl_c():
        os.kill(os.getpid(), signal.SIGTERM)


def test_the_handlers_are_restored():
    before = signal.getsignal(signal.SIGTERM)
    with like_ctrl_c():
        assert signal.getsignal(signal.SIGTERM) is not before
    assert signal.getsignal(signal.SIGTERM) is before
