import argparse

import pytest
from hypothesis import given
from hypothesis import strategies as st
from study_page import add_seeds, seeds_of


def parsed(*words):
    parser = argparse.ArgumentParser()
    add_seeds(parser, range(3))
    return parser.parse_args(words).seeds


@given(first=st.integers(0, 5000), count=st.integers(1, 50))
def test_a_range_is_the_same_closed_or_half_open(first, count):
    seeds = tuple(range(first, first + count))
    assert seeds_of(f"{first}-{first + count - 1}") == seeds
    assert seeds_of(f"{first}:{first + count}") == seeds


def test_words_add_up_and_none_is_the_default():
    assert parsed() == [0, 1, 2]
    assert parsed("--seeds", "1000", "1001") == [1000, 1001]
    assert parsed("--seeds", "0-2", "7,9", "20:22") == [0, 1, 2, 7, 9, 20, 21]


@pytest.mark.parametrize("word", ["five", "9-5", "1-", "3:3", "-4"])
def test_what_is_no_seed_is_refused(word):
    with pytest.raises(ValueError, match="seeds"):
        seeds_of(word)


def test_a_study_refuses_it_too(capsys):
    with pytest.raises(SystemExit) as end:
        parsed("--seeds", "five")
    assert end.value.code == 2
    assert "--seeds" in capsys.readouterr().err
