from math import cos, sin

import numpy as np
import pytest

from hsr8.errors import UsageError
from hsr8.recorder.limit_bits import LIMITS
from hsr8.recorder.log.walk_layer import GAIT
from hsr8.render import walk_panels
from hsr8.render.walk_figure import TIME_PANELS, draw, save
from hsr8.render.walking_table import COLUMNS, WalkingTable
from walking.command_limits import Limit
from walking.phase import Phase

STEP, SPEED, TURN = 0.34, 0.2, 0.5


@pytest.fixture(scope="module")
def table():
    """An arc of 6 s: every foot stands for one step and a fifth, the body sways."""
    time = np.arange(0.0, 6.0, 0.02)
    yaw = TURN * time
    columns = {name: np.zeros(len(time)) for name in COLUMNS}
    x, y = SPEED / TURN * np.sin(yaw), SPEED / TURN * (1.0 - np.cos(yaw))
    sway = 0.02 * np.sin(np.pi * time / STEP)
    columns["robot_x"], columns["robot_y"] = x - sway * np.sin(yaw), y + sway * np.cos(yaw)
    columns["robot_yaw"] = (yaw + np.pi) % (2 * np.pi) - np.pi
    step = np.floor(time / STEP + 1e-9)
    columns["steps"] = step
    double = time / STEP - step < 0.2
    columns["phase"] = np.where(double, 1.0, np.where(step % 2 == 0, 2.0, 3.0))
    for foot, side, parity in (("left", 0.042, 0), ("right", -0.042, 1)):
        k = np.where(step % 2 == parity, step, np.where(double, step - 1, step + 1))
        at = TURN * (k + 0.5) * STEP
        columns[f"{foot}_x"] = SPEED / TURN * np.sin(at) - side * np.sin(at)
        columns[f"{foot}_y"] = SPEED / TURN * (1.0 - np.cos(at)) + side * np.cos(at)
        columns[f"{foot}_yaw"] = at
        columns[f"{foot}_z"] = np.where((step % 2 != parity) & ~double, 0.02, 0.0)
    columns["limits"][50:60] = 1 << LIMITS.index(Limit.BALANCE)
    columns["push_fx"][100:103] = 5.0
    columns["push_impulse"][100:103], columns["push_begin"][100:103] = 0.25, 1.985
    joints = [f"{side}_{k}" for side in ("left", "right") for k in range(6)]
    columns |= {f"torque_{joint}": np.zeros(len(time)) for joint in joints}
    groups = {"hip": (0, 1, 2), "knee": (3,), "ankle": (4, 5)}
    limits = dict.fromkeys(joints, 6.0)
    return WalkingTable(time, columns, (0.01, 0.0525, 0.03), limits, groups)


def test_every_phase_has_a_color_and_a_name():
    assert set(walk_panels.LANES) == set(walk_panels.PHASE_NAMES) == set(Phase)
    assert set(GAIT) == {str(phase) for phase in Phase}


def test_a_foot_is_in_contact_between_its_swings(table):
    for foot in ("left", "right"):
        stands = walk_panels.contacts(table, foot)
        assert len(stands) in (9, 10)
        for first, last in stands:
            assert np.ptp(table[f"{foot}_x"][first : last + 1]) == 0.0
            assert table[f"{foot}_z"][first : last + 1].max() == 0.0


def test_a_sole_is_drawn_at_its_contact(table):
    rows = walk_panels.contacts(table, "left")[3]
    corners = walk_panels.outline(table, "left", rows)
    yaw = table["left_yaw"][rows[0]]
    middle = [
        table["left_x"][rows[0]] + 0.01 * cos(yaw),
        table["left_y"][rows[0]] + 0.01 * sin(yaw),
    ]
    assert corners.mean(axis=0) == pytest.approx(middle)
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    assert sorted(sides) == pytest.approx([0.06, 0.06, 0.105, 0.105])


def test_the_walking_frame_follows_the_path_without_the_sway(table):
    local = walk_panels.WalkingFrame(table).to_local(table.points("robot"))[20:-20]
    assert np.abs(local[:, 0]).max() < 0.004
    assert local[:, 1].max() == pytest.approx(0.02, abs=0.004)


def test_the_achieved_velocity_is_that_of_the_arc(table):
    time, rates = walk_panels.achieved_velocity(table)
    assert rates == pytest.approx(np.tile([SPEED, 0.0, TURN], (len(time), 1)), abs=0.012)


@pytest.mark.parametrize("what", ["walking", "footsteps", "tilt"])
def test_every_plot_is_drawn(table, what, tmp_path):
    figure = draw(table, what, "a walk")
    save(figure, tmp_path / "plot.png")
    assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")
    wanted = {"walking": 11, "footsteps": 1}.get(what) or len(TIME_PANELS[what]) + 1
    panels = [axes for part in (figure.subfigs or [figure]) for axes in part.axes]
    assert len(panels) == wanted
    if what != "footsteps":
        assert panels[-1].get_xlim() == pytest.approx((0.0, 5.98))
        assert [t.get_text() for t in panels[-1].get_yticklabels()] == ["gait phase", "balance"]


def test_figures_are_reproducible(table, tmp_path):
    for name in ("one.svg", "two.svg"):
        save(draw(table, "tilt", "a walk"), tmp_path / name)
    assert (tmp_path / "one.svg").read_bytes() == (tmp_path / "two.svg").read_bytes()


def test_a_few_records_are_not_plotted(table):
    with pytest.raises(UsageError, match="only 2 records"):
        draw(table.window(1.0, 1.02), "walking", "a walk")
