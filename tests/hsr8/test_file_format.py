import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.errors import UsageError
from hsr8.file_format import check_number
from hsr8.version import VERSION


@given(number=st.integers().filter(lambda n: n != 4))
def test_another_format_is_refused_with_both_numbers(number):
    check_number(4, 4, "a", "run folder")
    with pytest.raises(UsageError) as caught:
        check_number(number, 4, "a", "run folder")
    assert str(caught.value) == (
        f"a: run folder of format {number}, hsr8 {VERSION} reads format 4: "
        "run the scenario again, or use the version of hsr8 that wrote it"
    )
