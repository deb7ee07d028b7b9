import tomllib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.scenario.toml_writer import write_toml

# TOML integers have 64 bits, its text no lone surrogates.
text = st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
scalars = st.one_of(
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(allow_nan=False),
    text,
)
tables = st.recursive(
    st.dictionaries(text, scalars | st.lists(scalars, max_size=3), max_size=4),
    lambda inner: st.dictionaries(
        text, scalars | inner | st.lists(inner, min_size=1, max_size=3), max_size=4
    ),
    max_leaves=12,
)


@given(tables)
def test_what_is_written_is_read_back(table):
    assert tomllib.loads(write_toml(table)) == table


@given(st.lists(st.floats(allow_nan=False), min_size=1, max_size=3), st.integers(0, 2**31))
def test_numbers_of_numpy_are_written_as_numbers(values, number):
    given_ = {"array": np.array(values), "entries": list(np.array(values)), "n": np.int64(number)}
    read = tomllib.loads(write_toml(given_))
    assert read == {"array": values, "entries": values, "n": number}


def test_what_toml_cannot_say_is_an_error():
    with pytest.raises(TypeError, match="NoneType"):
        write_toml({"a": None})
