from dataclasses import dataclass, field
from typing import Annotated

import numpy as np
import pytest
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import Records, record, record_class, record_type, records

PART = record_type(weight=float, used=bool)
WHOLE = record_type(flag=bool, parts=(PART, 2), matrix=(float, 2, 3))


@compiled
def total(wholes):
    """Return the sum of the weights in use; set the flags."""
    weight = 0.0
    for i in range(len(wholes)):
        whole = wholes[i]
        whole.flag = True
        for j in range(2):
            if whole.parts[j].used:
                weight += whole.parts[j].weight
    return weight


def test_compiled_code_reads_and_changes_nested_records():
    wholes = np.zeros(3, WHOLE)
    wholes["parts"]["weight"] = np.arange(6.0).reshape(3, 2)
    wholes["parts"]["used"][:, 1] = True
    assert total(wholes) == total.py_func(wholes) == 1.0 + 3.0 + 5.0
    assert wholes["flag"].all()
    assert wholes[1].parts[1].weight == 3.0


def test_attributes_of_arrays_are_refused_as_names():
    with pytest.raises(TypeError, match="size"):
        record_type(size=float)


@dataclass(frozen=True)
class Parameters:
    name: str = "name"
    count: int = 3
    rate: float = 0.5
    more: dict = field(default_factory=dict)


def test_a_record_of_parameters_has_their_numbers():
    (row,) = record(Parameters(), extra=2.0)
    assert row.dtype.names == ("count", "rate", "extra")
    assert (row.count, row.rate, row.extra) == (3.0, 0.5, 2.0)


@record_class
class Part:
    weight: float
    used: bool


@record_class
class Whole:
    flag: bool
    parts: Annotated[Records[Part], 2]
    matrix: Annotated[NDArray[np.float64], 2, 3]


def test_a_class_of_annotated_fields_is_the_type_of_its_records():
    assert Whole == WHOLE
    assert records(Whole, 2).shape == (2,)


def test_the_numbers_of_a_dataclass_are_a_record():
    @record_class
    class Owner:
        own: Parameters
        left: Part

    assert Owner["own"].names == ("count", "rate")
    assert Owner["left"] == PART


def test_a_field_that_is_not_a_number_is_refused():
    with pytest.raises(TypeError, match="str"):

        @record_class
        class Named:
            name: str
