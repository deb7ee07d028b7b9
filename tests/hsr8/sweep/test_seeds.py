from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.errors import UsageError
from hsr8.sweep.seeds import parse_seeds, parse_values


@settings(max_examples=30)
@given(st.lists(st.integers(0, 2**63 - 1), min_size=1, max_size=20, unique=True))
def test_a_list_of_seeds_is_read_back(seeds):
    assert parse_seeds(",".join(map(str, seeds))) == tuple(seeds)


def test_ranges_leave_their_end_out_and_mix_with_lists():
    assert parse_seeds("1000:1003") == (1000, 1001, 1002)
    assert parse_seeds("0:2, 9,4:5") == (0, 1, 9, 4)


@pytest.mark.parametrize("text", ["", "a", "3:3", "1,,2", "1,1", "1:", "0:99999999"])
def test_other_seeds_are_refused(text):
    with pytest.raises(UsageError, match="--seeds"):
        parse_seeds(text)


@settings(max_examples=40)
@given(st.text("0123456789:, -x", max_size=12))
def test_any_text_is_seeds_or_refused(text):
    with suppress(UsageError):
        assert parse_seeds(text)


def test_values_keep_commas_within_brackets_and_quotes():
    assert parse_values("camera.period_ms=40, 80") == ("camera.period_ms", ("40", "80"))
    assert parse_values("world.radius=[0.1,0.2],[0.2,0.3]")[1] == ("[0.1,0.2]", "[0.2,0.3]")
    assert parse_values('a="x,y",z')[1] == ('"x,y"', "z")
    for text in ("a", "=1", "a=", "a=1,", "a=1,1"):
        with pytest.raises(UsageError, match="--vary"):
            parse_values(text)
