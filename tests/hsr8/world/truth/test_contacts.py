import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.world.field.layout import Obstacle, standard_beacons
from hsr8.world.field.motion import Line
from hsr8.world.model.index import ModelIndex
from hsr8.world.truth.contacts import ContactWatch

BEACONS = standard_beacons((5.0, 5.0))
FAR = Obstacle((2.0, 2.0), 0.10, 0.40, "red")
AHEAD = Obstacle((0.15, 0.0), 0.10, 0.40, "red")
MOVER = Obstacle((0.15, 0.0), 0.10, 0.40, "blue", Line((0.15, 0.0), (0.0, 0.0)))


@pytest.fixture
def watched(world):
    """Build a watch over a robot at a position with a velocity."""

    def build(*obstacles, at=(0.0, 0.0, 0.245), velocity=(0.0, 0.0), beacons=BEACONS):
        layout, model = world(*obstacles, beacons=beacons)
        index = ModelIndex.of(model, load_robot("hsr8"), len(layout.static), len(layout.movers))
        data = mujoco.MjData(model)
        data.qpos[index.root_qpos : index.root_qpos + 3] = at
        data.qvel[index.root_dof : index.root_dof + 2] = velocity
        mujoco.mj_forward(model, data)
        watch = ContactWatch(model, index, layout)
        watch.watch(data)
        return watch, data, model, index

    return build


def distances(model, data, geoms, others):
    return [
        mujoco.mj_geomDistance(model, data, geom, other, 1.0, np.zeros(6))
        for geom in geoms.tolist()
        for other in others.tolist()
    ]


def test_a_contact_is_reported_once_per_geom(watched):
    watch, data, _, _ = watched(AHEAD)
    watch.watch(data)
    contacts = watch.take()
    assert {(c.obstacle, c.name, c.moving) for c in contacts} == {(0, "obstacle 0", False)}
    names = [c.robot_geom for c in contacts]
    assert len(set(names)) == len(names) > 0
    assert watch.take() == ()


@pytest.mark.parametrize(("speed", "closing"), [(0.3, True), (-0.3, False), (0.0, False)])
def test_a_contact_is_closing_if_the_robot_moves_towards_the_obstacle(watched, speed, closing):
    watch, *_ = watched(AHEAD, velocity=(speed, 0.0))
    assert {c.closing for c in watch.take()} == {closing}


def test_movers_are_reported_as_moving(watched):
    watch, *_ = watched(FAR, MOVER)
    assert {(c.obstacle, c.name, c.moving) for c in watch.take()} == {(1, "mover 1", True)}


@pytest.mark.parametrize("number", range(6))
def test_contact_with_a_beacon_has_its_number_and_name(watched, number):
    x, y = BEACONS[number].position
    watch, data, _, _ = watched(FAR, AHEAD, at=(x - 0.1, y, 0.245), velocity=(0.2, 0.0))
    name = f"beacon {BEACONS[number].name}"
    contacts = {(c.obstacle, c.name, c.moving, c.closing) for c in watch.take()}
    assert contacts == {(2 + number, name, False, True)}
    assert watch.clearance(data) < 0.0


@pytest.mark.parametrize("lifted", [0.0, 0.4])
def test_clearance_from_a_beacon_is_that_from_the_nearer_half(watched, lifted):
    x, y = BEACONS[0].position
    watch, data, model, index = watched(at=(x - 0.3, y, 0.245 + lifted))
    lower, upper = (
        min(distances(model, data, index.robot_geoms, half))
        for half in index.beacon_geoms[0][:, None]
    )
    assert watch.clearance(data) == min(lower, upper)
    assert (upper < lower) == (lifted > 0.0)


@pytest.mark.parametrize("seed", range(8))
def test_clearance_is_the_minimum_over_all_pairs_of_geoms(watched, seed):
    """Arms are longer than the chest is deep: the nearest axis may not be the nearest surface."""
    rng = np.random.default_rng(seed)
    angles, radii = rng.uniform(0.0, 6.3, 4), rng.uniform(0.3, 0.34, 4) + 0.3 * (seed % 2)
    centres = zip(radii * np.cos(angles), radii * np.sin(angles), strict=True)
    obstacles = [Obstacle(centre, 0.08, 0.30, "red") for centre in centres]
    watch, data, model, index = watched(*obstacles, beacons=())
    gaps = distances(model, data, index.robot_geoms, index.obstacle_geoms)
    assert watch.clearance(data) == pytest.approx(min(gaps), abs=1e-6)


def test_feet_in_the_air_have_no_load_and_no_centre_of_pressure(watched):
    watch, data, _, _ = watched(at=(0.0, 0.0, 1.0))
    load, pressure = watch.feet(data)
    assert load.tolist() == [0.0, 0.0]
    assert np.isnan(pressure).all()


def test_a_standing_robot_loads_both_feet(watched):
    watch, data, model, index = watched()
    for _ in range(400):
        mujoco.mj_step(model, data)
    load, pressure = watch.feet(data)
    under = np.zeros((2, 6))
    for i, geoms in enumerate(data.contact.geom.tolist()):
        force = np.zeros(6)
        mujoco.mj_contactForce(model, data, i, force)
        under[index.foot_geoms.index(max(geoms))] += force
    assert load.tolist() == under[:, 0].tolist()
    assert load.sum() == pytest.approx(9.81 * model.body("base_link").subtreemass[0], rel=0.05)
    assert load.min() > 0.2 * load.max()
    assert np.hypot(*(pressure - data.qpos[:2])) < 0.08
    watch.watch(data)
    assert watch.take() == ()
