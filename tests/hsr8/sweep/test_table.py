import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.files.tables import flatten
from hsr8.sweep.folder import write_table

VALUES = (
    st.none() | st.booleans() | st.integers(-(2**60), 2**60) | st.floats() | st.text(max_size=3)
)
ROWS = st.lists(st.dictionaries(st.sampled_from("abc"), VALUES, min_size=1), min_size=1, max_size=4)


@settings(max_examples=25, deadline=None)
@given(rows=ROWS)
def test_any_mixture_of_values_has_a_table(rows, tmp_path_factory):
    file = tmp_path_factory.mktemp("table") / "runs.parquet"
    write_table(file, rows)
    table = pq.read_table(file)
    assert table.num_rows == len(rows)
    for name in table.column_names:
        null = [value is None for value in table[name].to_pylist()]
        assert null == [row.get(name) is None for row in rows]


@pytest.mark.parametrize(
    ("values", "back"),
    [
        ([1, 2], [1, 2]),
        ([1, 0.5, None], [1.0, 0.5, None]),
        ([True, None], [True, None]),
        ([1, "a"], ["1", "a"]),
        (["a", "b\udcff"], ["a", r"b\udcff"]),
    ],
)
def test_a_column_has_one_type(tmp_path, values, back):
    write_table(tmp_path / "t", [{"x": value} for value in values])
    assert pq.read_table(tmp_path / "t")["x"].to_pylist() == back


def test_a_full_disk_leaves_the_old_table_alone(tmp_path, monkeypatch):
    def full(_):
        raise OSError(28, "No space left on device")

    file = tmp_path / "runs.parquet"
    write_table(file, [{"seed": 1}])
    before = file.read_bytes()
    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OSError, match="No space"):
        write_table(file, [{"seed": 2}])
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [before]


def test_nested_results_are_flatten():
    assert flatten({"a": {"b": 1, "c": {"d": 2}}, "e": 3}) == {"a.b": 1, "a.c.d": 2, "e": 3}
