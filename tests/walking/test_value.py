"""Immutable values."""

import pickle

from walking.foothold import Foothold
from walking.signals import comparable_value, value


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


def test_a_value_survives_a_copy_to_another_process():
    step = Foothold(left=True, x=0.1, y=0.2, yaw=0.3)
    assert pickle.loads(pickle.dumps(step)) == step
