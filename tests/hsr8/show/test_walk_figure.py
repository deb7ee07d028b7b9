from dataclasses import replace
from math import cos, sin
from types import SimpleNamespace

import numpy as np
import pytest

from hsr8.errors import UsageError
from hsr8.recording.derived import walk_of
from hsr8.robots.loaded import load_robot
from hsr8.show import walk_panels
from hsr8.show.log.walking import GAIT
from hsr8.show.walk_figure import TIME_PANELS, draw, save
from hsr8.world.truth.truth import ActivePush
from walking.command import Limit, VelocityCommand
from walking.state import Phase

STEP, SPEED, TURN = 0.34, 0.2, 0.5


def foot_pose(time, side, parity):
    """Planned pose of a foot on the arc: x, y, height, yaw."""
    step = np.floor(time / STEP + 1e-9)
    double = time / STEP - step < 0.2
    k = step if step % 2 == parity else step - 1 if double else step + 1
    at = TURN * (k + 0.5) * STEP
    x, y = SPEED / TURN * np.sin(at), SPEED / TURN * (1.0 - np.cos(at))
    height = 0.02 if step % 2 != parity and not double else 0.0
    return [x - side * np.sin(at), y + side * np.cos(at), height, at]


def record_of(fake, k):
    """Record of a robot whose odometry does not drift."""
    time = 0.02 * k
    step, yaw = np.floor(time / STEP + 1e-9), TURN * time
    sway = 0.02 * np.sin(np.pi * time / STEP)
    x, y = SPEED / TURN * np.sin(yaw), SPEED / TURN * (1.0 - np.cos(yaw))
    pose = (x - sway * np.sin(yaw), y + sway * np.cos(yaw), (yaw + np.pi) % (2 * np.pi) - np.pi)
    push = ActivePush(0, 1.985, 0.05, "torso_link", 0.0, np.zeros(3), np.array([5.0, 0.0, 0.0]))
    record = fake.record(time, pose, pushes=(push,) if 100 <= k < 103 else ())
    support = Phase.LEFT_SUPPORT if step % 2 == 0 else Phase.RIGHT_SUPPORT
    feet = np.array([foot_pose(time, 0.042, 0), foot_pose(time, -0.042, 1)])
    limited = SimpleNamespace(limits=(Limit.BALANCE,), commanded=VelocityCommand(0.2, 0.0, 0.0))
    walking = replace(
        record.walking,
        phase=Phase.DOUBLE_SUPPORT if time / STEP - step < 0.2 else support,
        step_count=int(step),
        balance=replace(record.walking.balance, feet=feet),
        command_limits=limited if 50 <= k < 60 else None,
    )
    return replace(record, walking=walking)


@pytest.fixture(scope="module")
def robot():
    return load_robot("hsr8").model


@pytest.fixture(scope="module")
def records(fake, tables_of):
    """An arc of 6 s: every foot stands for one step and a fifth, the body sways."""
    return tables_of([record_of(fake, k) for k in range(300)])["records"]


@pytest.fixture(scope="module")
def walk(records, robot):
    return walk_of(records, robot)


def test_every_phase_has_a_color_and_a_name():
    assert set(walk_panels.LANES) == set(walk_panels.PHASE_NAMES) == set(Phase)
    assert set(GAIT) == set(Phase)


def test_a_foot_is_in_contact_between_its_swings(walk):
    for foot in (0, 1):
        stands = walk_panels.contacts(walk, foot)
        assert len(stands) in (9, 10)
        for first, last in stands:
            poses = walk.feet[first : last + 1, foot]
            assert np.ptp(poses[:, 0]) < 1e-12
            assert poses[:, 2].max() == 0.0


def test_a_sole_is_drawn_at_its_contact(walk, robot):
    rows, sole = walk_panels.contacts(walk, 0)[3], robot.sole
    corners = walk_panels.outline(walk, 0, rows)
    x, y, _, yaw = walk.feet[rows[0], 0]
    middle = [x + sole.centre * cos(yaw), y + sole.centre * sin(yaw)]
    assert corners.mean(axis=0) == pytest.approx(middle)
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    size = sorted([2 * sole.half_width, 2 * sole.half_length] * 2)
    assert sorted(sides) == pytest.approx(size)


def test_the_walking_frame_follows_the_path_without_the_sway(walk):
    local = walk_panels.WalkingFrame(walk).to_local(walk.pose[:, :2])[20:-20]
    assert np.abs(local[:, 0]).max() < 0.004
    assert local[:, 1].max() == pytest.approx(0.02, abs=0.004)


def test_the_achieved_velocity_is_that_of_the_arc(walk):
    time, rates = walk_panels.achieved_velocity(walk)
    assert len(time) == 17
    assert rates[1:] == pytest.approx(np.tile([SPEED, 0.0, TURN], (len(time) - 1, 1)), abs=0.012)


@pytest.mark.parametrize("what", ["walking", "footsteps", "tilt"])
def test_every_plot_is_drawn(records, robot, layout, what, tmp_path):
    figure = draw(records, robot, layout, what, "a walk")
    save(figure, tmp_path / "plot.png")
    assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")
    wanted = {"walking": 11, "footsteps": 1}.get(what) or len(TIME_PANELS[what]) + 1
    panels = [axes for part in (figure.subfigs or [figure]) for axes in part.axes]
    assert len(panels) == wanted
    if what != "footsteps":
        assert panels[-1].get_xlim() == pytest.approx((0.0, 5.98))
        assert [t.get_text() for t in panels[-1].get_yticklabels()] == ["gait phase", "balance"]


def test_figures_are_reproducible(records, robot, layout, tmp_path):
    for name in ("one.svg", "two.svg"):
        save(draw(records, robot, layout, "tilt", "a walk"), tmp_path / name)
    assert (tmp_path / "one.svg").read_bytes() == (tmp_path / "two.svg").read_bytes()


def test_a_few_records_are_not_plotted(records, robot, layout):
    with pytest.raises(UsageError, match="only 2 records"):
        draw(records.window(1.0, 1.02), robot, layout, "walking", "a walk")
