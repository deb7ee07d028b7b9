"""Records and values: types of fields, copies, and parameters by name."""

import numpy as np

from compilation.value import comparable_value, value
from walking.constants import parameters_record
from walking.data import Data, Plan
from walking.model import FootholdRecord
from walking.parameters import WalkingParameters


def test_an_assigned_record_is_a_copy_and_a_read_one_is_shared():
    plans = np.zeros(2, Plan)
    plans[0].steps[0].x = 1.0
    plans[1] = plans[0]
    plans[0].steps[0].x = 2.0
    assert plans[1].steps[0].x == 1.0
    landing = plans[0].steps[0]
    landing.y = 3.0
    assert plans[0].steps[0].y == 3.0
    assert np.zeros(1, Data)[0].limbs.feet.dtype.names[:2] == ("x", "y")
    assert FootholdRecord.names == ("left", "x", "y", "yaw")


def test_parameters_have_their_names_and_values():
    parameters = WalkingParameters()
    values = parameters_record(parameters)[0]
    sections = vars(parameters).keys() & set(values.dtype.names)
    assert {"gait", "pattern", "limits"} <= sections
    for section in sections:
        for name in values[section].dtype.names:
            assert values[section][name] == getattr(getattr(parameters, section), name)


@value
class Pair:
    first: float
    second: tuple[int, ...] = ()


@comparable_value
class Numbers:
    first: float


def test_a_value_compares_by_identity_a_comparable_one_by_content():
    one = Pair(1.0)
    assert one == one != Pair(1.0)
    assert Numbers(1.0) == Numbers(1.0) != Numbers(2.0)
    assert repr(one) == "Pair(first=1.0, second=())"
