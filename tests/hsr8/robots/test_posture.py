"""Posture of a description: SRDF states, clipping and names."""

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.errors import ModelError
from hsr8.robots.parts.posture import stated_posture
from hsr8.robots.parts.skeleton import clip_to_range
from tests.hsr8.robots.small_urdf import describe

SRDF = '<robot name="r"><group_state name="home" group="g">{}</group_state></robot>'


def stated(folder, text, state="home", **keys):
    (folder / "small.srdf").write_text(text)
    return stated_posture(describe(srdf="small.srdf", state=state, **keys), folder, mujoco.MjSpec())


@given(st.floats(-7, 7), st.floats(-3, 3), st.floats(0.01, 3))
def test_clipped_angles_are_inside_and_others_unchanged(angle, lower, width):
    clipped = clip_to_range(angle, lower, lower + width)
    assert lower <= clipped <= lower + width
    assert clipped == angle or not lower <= angle <= lower + width


def test_the_description_overrides_the_state(tmp_path):
    text = SRDF.format('<joint name="a" value="1"/><joint name="b" value="2"/>')
    assert stated(tmp_path, text, posture={"b": 0.5}) == {"a": 1.0, "b": 0.5}


def test_joints_of_several_values_are_left_out(tmp_path):
    assert stated(tmp_path, SRDF.format('<joint name="root" value="0 0 1"/>')) == {}


@pytest.mark.parametrize(
    ("text", "state", "reason"),
    [
        ("<robot", "home", "cannot be read"),
        (
            SRDF.format(""),
            "hom",
            "no group state 'hom'; did you mean 'home'?; expected one of home",
        ),
        (SRDF.format('<joint name="a" value="nan"/>'), "home", "got 'nan'; expected an angle"),
    ],
)
def test_wrong_files_are_refused(text, state, reason, tmp_path):
    with pytest.raises(ModelError, match=reason.replace("?;", r"\?;")):
        stated(tmp_path, text, state)


KEYED = """<mujoco><worldbody><body name="ball"><freejoint/><geom size=".1"/></body><body name="a">
<freejoint/><geom size=".1"/><body name="b"><joint name="one"/><geom size=".1"/><body name="c">
<joint name="two"/><geom size=".1"/></body></body></body></worldbody>
<keyframe><key name="home" qpos="0 0 0 1 0 0 0 0 0 0 1 0 0 0 0.25 -0.5"/></keyframe></mujoco>"""


def test_a_keyframe_of_the_model_is_a_state(tmp_path):
    spec = mujoco.MjSpec.from_string(KEYED)
    angles = stated_posture(describe(state="home", posture={"two": 1.0}), tmp_path, spec)
    assert angles == {"one": 0.25, "two": 1.0}
    key = spec.compile().key("home")
    np.testing.assert_allclose(key.qpos[-2:], (0.25, -0.5))
    with pytest.raises(ModelError, match=r"state: the model has no keyframe 'hom'; did you mean"):
        stated_posture(describe(state="hom"), tmp_path, spec)
