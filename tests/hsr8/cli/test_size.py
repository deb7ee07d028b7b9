import pytest

from hsr8.cli.size import parse_size
from hsr8.errors import UsageError


@pytest.mark.parametrize(("text", "size"), [("960x540", (960, 540)), (" 1280×720 ", (1280, 720))])
def test_sizes(text, size):
    assert parse_size(text) == size


@pytest.mark.parametrize("text", ["", "960", "960x541", "8x8", "10000x10000", "-960x540", "axb"])
def test_what_is_no_size_is_refused_with_an_example(text):
    with pytest.raises(UsageError, match="1280x720"):
        parse_size(text)
