"""The rehearsal of a walk."""

import pytest

from walking import published_state_kernel
from walking.body import estimation_kernel, head_kernel, leg_kernel
from walking.footsteps import foothold_kernel, stride_kernel
from walking.gait import swing_foot_kernel, swing_kernel
from walking.parameters import WalkingParameters
from walking.pattern import support_kernel, zmp_kernel
from walking.warm_up import warm_up


@pytest.mark.parametrize(
    ("module", "name"),
    [
        (zmp_kernel, "plan"),
        (zmp_kernel, "follow"),
        (foothold_kernel, "plan_walk"),
        (swing_kernel, "react"),
        (swing_foot_kernel, "advance"),
        (support_kernel, "clip"),
        (support_kernel, "fraction"),
        (support_kernel, "depth"),
        (estimation_kernel, "estimate"),
        (leg_kernel, "pose"),
        (leg_kernel, "offsets"),
        (head_kernel, "advance"),
        (head_kernel, "camera_pose"),
        (published_state_kernel, "show"),
        (published_state_kernel, "incline"),
        (stride_kernel, "strides"),
        (stride_kernel, "stance_after"),
        (stride_kernel, "clear"),
    ],
)
def test_it_calls_what_a_tick_calls(robot, monkeypatch, module, name):
    calls, kernel = [], getattr(module, name)

    def counted(*arguments):
        calls.append(arguments)
        return kernel(*arguments)

    monkeypatch.setattr(module, name, counted)
    warm_up(robot, WalkingParameters())
    assert calls
