import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.errors import UsageError
from hsr8.file_format import check_magic
from hsr8.version import VERSION

MAGIC = b"HSR8XYZ4"


@given(rest=st.binary(max_size=9))
def test_the_known_format_passes(rest):
    check_magic(MAGIC + rest, MAGIC, "f", "list")


@given(number=st.sampled_from([d for d in range(36) if d != 4]), rest=st.binary(max_size=9))
def test_another_format_is_refused_with_both_numbers(number, rest):
    digit = np.base_repr(number, 36).encode()
    with pytest.raises(UsageError) as caught:
        check_magic(MAGIC[:-1] + digit + rest, MAGIC, "a/f", "list")
    assert str(caught.value) == (
        f"a/f: list of format {number}, hsr8 {VERSION} reads format 4: "
        "run the scenario again, or use the version of hsr8 that wrote it"
    )


@given(content=st.binary(max_size=12) | st.integers(0, 7).map(lambda n: MAGIC[:n]))
def test_any_other_content_is_refused(content):
    if content[:7] != MAGIC[:7] or not content[7:8].isalnum():
        with pytest.raises(UsageError, match="not a list"):
            check_magic(content, MAGIC, "f", "list")
