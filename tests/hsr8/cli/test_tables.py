import io

import pytest
from rich.console import Console

from hsr8.cli import tables


def printed(table):
    stream = io.StringIO()
    Console(file=stream, width=200).print(table)
    return [
        [cell.strip() for cell in line.split("│")[1:-1]]
        for line in stream.getvalue().replace("┃", "│").splitlines()
        if "│" in line.replace("┃", "│")
    ]


@pytest.mark.parametrize(
    ("key", "value", "label", "text"),
    [
        ("speed_mps", 0.123456, "speed [m/s]", "0.1235"),
        ("path_length_m", 12.0, "path length [m]", "12"),
        ("saccades_per_s", 3.5, "saccades per s", "3.5"),
        ("met", True, "met", "yes"),
        ("point", [1, 2.5], "point", "1, 2.5"),
        ("points", [(1, 2), (3, 4)], "points", "(1, 2), (3, 4)"),
        ("by", {"l_knee": 3, "at": [1, 2]}, "by", "l_knee 3, at (1, 2)"),
        ("text", "[markup]", "text", "[markup]"),
        ("renderer", "llvmpipe (256 bits)", "renderer", "llvmpipe (256 bits)"),
    ],
)
def test_labels_have_units_and_values_are_short(key, value, label, text):
    assert printed(tables.facts({key: value})) == [[label, text]]
    assert printed(tables.rows([{key: value}])) == [[label], [text]]


def test_keys_without_a_value_are_left_out():
    assert printed(tables.facts({"a": None, "b": [], "c": {}, "d": 0})) == [["d", "0"]]
    assert printed(tables.rows([{"a": None}])) == [["a"], ["-"]]
