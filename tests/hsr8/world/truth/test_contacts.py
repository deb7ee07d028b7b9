import mujoco
import numpy as np
import pytest

from hsr8.world.field.layout import Obstacle, standard_beacons
from hsr8.world.field.motion import Line
from hsr8.world.model.index import ModelIndex
from hsr8.world.truth.contacts import ContactWatch

BEACONS = standard_beacons((5.0, 5.0))


@pytest.fixture
def placed(world):
    """A watch over a robot whose base is put somewhere, with a velocity."""

    def place(*obstacles, at=(0.0, 0.0, 0.245), velocity=(0.0, 0.0), beacons=BEACONS):
        layout, model = world(*obstacles, beacons=beacons)
        index = ModelIndex.of(model, len(layout.static), len(layout.movers))
        data = mujoco.MjData(model)
        data.qpos[index.root_qpos : index.root_qpos + 3] = at
        data.qvel[index.root_dof : index.root_dof + 2] = velocity
        mujoco.mj_forward(model, data)
        return ContactWatch(model, index, layout), data, model

    return place


AHEAD = Obstacle((0.15, 0.0), 0.10, 0.40, "red")


def test_every_touch_is_told_once_and_says_what_touched(placed):
    watch, data, _ = placed(AHEAD)
    watch.watch(data)
    watch.watch(data)
    contacts = watch.take()
    assert contacts
    assert {(c.obstacle, c.name) for c in contacts} == {(0, "obstacle 0")}
    assert not any(c.moving for c in contacts)
    names = [c.robot_geom for c in contacts]
    assert len(set(names)) == len(names)
    assert watch.take() == ()


@pytest.mark.parametrize(("speed", "closing"), [(0.3, True), (-0.3, False), (0.0, False)])
def test_the_robot_closes_a_gap_only_when_it_walks_into_it(placed, speed, closing):
    watch, data, _ = placed(AHEAD, velocity=(speed, 0.0))
    watch.watch(data)
    assert {c.closing for c in watch.take()} == {closing}


def test_what_can_move_is_told_from_what_cannot(placed):
    mover = Obstacle((0.15, 0.0), 0.10, 0.40, "blue", Line((0.15, 0.0), (0.0, 0.0)))
    far = Obstacle((2.0, 2.0), 0.10, 0.40, "red")
    watch, data, _ = placed(far, mover)
    watch.watch(data)
    contacts = watch.take()
    assert {(c.obstacle, c.name) for c in contacts} == {(1, "mover 1")}
    assert all(c.moving for c in contacts)


def test_without_a_touch_there_is_none(placed):
    watch, data, _ = placed(Obstacle((1.0, 0.0), 0.10, 0.40, "red"))
    watch.watch(data)
    assert watch.take() == ()


def test_clearance_falls_as_the_obstacle_nears_and_is_that_of_the_body(placed):
    found = []
    for x in (2.0, 0.8, 0.5, 0.4):
        watch, data, _ = placed(Obstacle((x, 0.0), 0.10, 0.40, "red"))
        found.append(watch.clearance(data))
    assert found == sorted(found, reverse=True)
    assert -np.diff(found) == pytest.approx([1.2, 0.3, 0.1], abs=1e-3)
    assert found[3] < 0.3  # the body is wider than its axis


def test_without_obstacles_and_beacons_there_is_room_without_end(placed):
    watch, data, _ = placed(beacons=())
    assert watch.clearance(data) == np.inf


@pytest.mark.parametrize("number", range(6))
def test_a_beacon_is_touched_as_what_stands_and_has_a_name(placed, number):
    obstacles = (Obstacle((0.0, 0.0), 0.10, 0.40, "red"), Obstacle((1.0, 0.0), 0.10, 0.40, "red"))
    beacon = BEACONS[number]
    x, y = beacon.position
    watch, data, _ = placed(*obstacles, at=(x - 0.1, y, 0.245), velocity=(0.2, 0.0))
    watch.watch(data)
    contacts = watch.take()
    assert {(c.obstacle, c.name) for c in contacts} == {(2 + number, f"beacon {beacon.name}")}
    assert not any(c.moving for c in contacts)
    assert all(c.closing for c in contacts)
    assert watch.clearance(data) < 0.0


@pytest.mark.parametrize("lifted", [0.0, 0.4])
def test_clearance_from_a_beacon_is_that_from_the_nearer_half(placed, lifted):
    x, y = BEACONS[0].position
    watch, data, model = placed(at=(x - 0.3, y, 0.245 + lifted))
    index = ModelIndex.of(model, 0, 0)
    lower, upper = (
        min(
            mujoco.mj_geomDistance(model, data, own, half, 0.5, np.zeros(6))
            for own in index.robot_geoms.tolist()
        )
        for half in index.beacon_geoms[0].tolist()
    )
    assert watch.clearance(data) == min(lower, upper)
    assert (upper < lower) == (lifted > 0.0)


def test_feet_in_the_air_carry_nothing_and_have_no_centre_of_pressure(placed):
    watch, data, _ = placed(at=(0.0, 0.0, 1.0))
    load, pressure = watch.feet(data)
    assert load.tolist() == [0.0, 0.0]
    assert np.isnan(pressure).all()


def test_a_robot_that_stands_carries_its_weight_on_both_feet_and_on_no_obstacle(placed):
    watch, data, model = placed()
    for _ in range(400):
        mujoco.mj_step(model, data)
    load, pressure = watch.feet(data)
    assert load.sum() == pytest.approx(9.81 * model.body("base_link").subtreemass[0], rel=0.05)
    assert load.min() > 0.2 * load.max()
    assert np.hypot(*(pressure - data.qpos[:2])) < 0.08
    watch.watch(data)
    assert watch.take() == ()


@pytest.mark.parametrize("seed", range(8))
def test_clearance_is_the_least_distance_of_any_geom_from_any_obstacle(placed, seed):
    """Arms reach out farther than the chest: what is nearest to the middle may be farther off."""
    rng = np.random.default_rng(seed)
    turns, away = rng.uniform(0.0, 6.3, 4), rng.uniform(0.3, 0.34, 4) + 0.3 * (seed % 2)
    obstacles = [
        Obstacle((r * np.cos(turn), r * np.sin(turn)), 0.08, 0.30, "red")
        for turn, r in zip(turns, away, strict=True)
    ]
    watch, data, model = placed(*obstacles, beacons=())
    index = ModelIndex.of(model, 4, 0)
    distances = [
        mujoco.mj_geomDistance(model, data, geom, other, 1.0, np.zeros(6))
        for geom in index.robot_geoms.tolist()
        for other in index.obstacle_geoms.tolist()
    ]
    assert watch.clearance(data) == pytest.approx(min(distances), abs=1e-6)
