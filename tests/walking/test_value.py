import pickle

import pytest

from walking.foothold import Foothold
from walking.value import value


@value
class Pair:
    first: float
    second: tuple[int, ...] = ()


def test_values_are_equal_by_what_they_hold_and_serve_as_keys():
    assert Pair(1.0, (2,)) == Pair(1.0, (2,)) != Pair(1.0)
    assert len({Pair(1.0), Pair(1.0), Pair(2.0)}) == 2
    assert repr(Pair(1.0)) == "Pair(first=1.0, second=())"


def test_a_value_has_no_room_for_anything_else():
    with pytest.raises(AttributeError):
        Pair(1.0).third = 3.0


def test_a_value_survives_a_copy_to_another_process():
    step = Foothold(left=True, x=0.1, y=0.2, yaw=0.3)
    assert pickle.loads(pickle.dumps(step)) == step
