import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.scenario.fault import Disturbance, Push, RandomPushes
from hsr8.world.body.pushes import Pusher, ScheduledPush, schedule
from hsr8.world.field.layout import Layout
from hsr8.world.model.assembly import Optics, assemble

TICK = 0.005
EMPTY = Layout((4.0, 4.0), (), (), (0.0, 0.0, 0.0), np.zeros((0, 2)), None, endless=False)


@pytest.fixture(scope="module")
def model():
    return assemble(load_robot("hsr8"), EMPTY, "vision", Optics())


def rng():
    return np.random.default_rng(3)


@pytest.mark.parametrize("duration", [0.005, 0.05, 0.123])
def test_the_impulse_is_kept_whatever_the_ticks_make_of_the_duration(duration):
    asked = [Push(kind="push", start=1.0, duration=duration, magnitude=0.7)]
    (push,) = schedule(Disturbance(), 10.0, TICK, rng(), asked)
    assert push.force * push.ticks * TICK == pytest.approx(0.7)
    assert push.first == 200


def test_drawn_pushes_are_as_asked_and_in_order():
    asked = Disturbance(
        random=RandomPushes(start=4.0, interval=(1.0, 2.0), impulse=(0.3, 0.4)),
    )
    given = [Push(kind="push", start=start, magnitude=5.0) for start in (20.0, 2.0)]
    pushes = schedule(asked, 60.0, TICK, rng(), given)
    assert pushes == schedule(asked, 60.0, TICK, rng(), given)
    first = [push.first for push in pushes]
    assert first == sorted(first)
    drawn = [p for p in pushes if p.force * p.ticks * TICK < 1.0]
    assert len(drawn) >= 28
    assert all(0.3 <= p.force * p.ticks * TICK <= 0.4 for p in drawn)
    gaps = np.diff([p.first for p in drawn]) * TICK
    assert gaps.min() >= 0.99
    assert gaps.max() <= 2.01


@pytest.mark.parametrize(("heading", "wanted"), [(0.0, (0.0, 6.0)), (np.pi / 2, (-6.0, 0.0))])
def test_a_push_acts_in_its_ticks_only_and_from_the_robots_side(model, heading, wanted):
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    push = ScheduledPush(3, 2, 6.0, np.pi / 2, "torso_link")
    pusher = Pusher(model, [push], TICK)
    body = model.body("torso_link").id
    for tick in range(8):
        pusher.apply(data, tick, heading)
        force = data.xfrc_applied[body]
        acts = tick in (3, 4)
        assert force[:2] == pytest.approx(wanted if acts else (0.0, 0.0), abs=1e-12)
        active = pusher.take()
        assert len(active) == acts
        if acts:
            assert active[0].impulse == pytest.approx(6.0 * 2 * TICK)
            assert active[0].begin == pytest.approx(0.015)
            assert "90 deg" in active[0].text()
    assert np.all(data.xfrc_applied == 0.0)


def test_pushes_at_once_add_up_and_a_point_makes_a_moment(model):
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    pushes = [
        ScheduledPush(0, 4, 1.0, 0.0, "torso_link", (0.0, 0.0, 0.1)),
        ScheduledPush(2, 4, 2.0, 0.0, "torso_link"),
    ]
    pusher = Pusher(model, pushes, TICK)
    applied = []
    for tick in range(7):
        pusher.apply(data, tick, 0.0)
        applied.append(data.xfrc_applied[model.body("torso_link").id].copy())
    forces, moments = np.array(applied)[:, 0], np.array(applied)[:, 4]
    assert forces.tolist() == [1.0, 1.0, 3.0, 3.0, 2.0, 2.0, 0.0]
    assert moments == pytest.approx([0.1] * 4 + [0.0] * 3)
