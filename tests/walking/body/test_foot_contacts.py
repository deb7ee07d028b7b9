"""Contacts, gait phase and footsteps from the loads of the feet."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.observer import FootContacts
from walking.parameters import CONTROL_PERIOD, GRAVITY, GaitParameters
from walking.state import Phase

MASS = 5.0
WEIGHT = MASS * GRAVITY
GAIT = GaitParameters()
STEP = round(GAIT.footstep_time / CONTROL_PERIOD)
ON, OFF, BOTH = (WEIGHT, 0.0), (0.0, WEIGHT), (0.5 * WEIGHT, 0.5 * WEIGHT)


def after(*stretches):
    contacts = FootContacts(MASS, GAIT)
    for loads, ticks in stretches:
        for _ in range(ticks):
            contacts.update(*loads)
    return contacts


@given(st.lists(st.floats(0.2, 0.8), min_size=1, max_size=100))
def test_a_robot_that_shifts_its_weight_stands(fractions):
    contacts = after(*(((f * WEIGHT, (1.0 - f) * WEIGHT), 1) for f in fractions))
    assert contacts.phase is Phase.STANDING
    assert contacts.step_count == 0


@pytest.mark.parametrize(("loads", "phase"), [(ON, "left"), (OFF, "right"), (BOTH, "standing")])
def test_the_phase_is_that_of_the_loaded_foot(loads, phase):
    assert after((loads, STEP)).phase == phase


def test_every_landing_is_one_footstep():
    stride = ((ON, STEP), (BOTH, 5), (OFF, STEP), (BOTH, 5))
    contacts = after(*stride, *stride)
    assert contacts.step_count == 4
    assert contacts.phase is Phase.DOUBLE_SUPPORT
    assert after(*stride, (BOTH, STEP + 1)).phase is Phase.STANDING


def test_a_foot_unloaded_for_a_moment_makes_no_footstep():
    short = int(GAIT.min_swing_time / CONTROL_PERIOD) - 1
    assert after((ON, short), (BOTH, 20)).step_count == 0


@given(st.integers(0, 2**32 - 1))
def test_noise_of_an_unloaded_foot_makes_no_footstep(seed):
    noise = np.random.default_rng(seed).normal(0.0, 0.02 * WEIGHT, 200)
    contacts = after((ON, STEP), *(((WEIGHT, abs(n)), 1) for n in noise))
    assert contacts.phase is Phase.LEFT_SUPPORT
    assert contacts.step_count == 0


def test_a_robot_in_the_air_keeps_its_phase():
    assert after((ON, 3), ((0.0, 0.0), 10)).phase is Phase.LEFT_SUPPORT
