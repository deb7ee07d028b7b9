from dataclasses import replace
from math import pi

import numpy as np
import pytest

from hsr8.scenario.loader import load_scenario
from hsr8.world.field.generator import draw_layout
from hsr8.world.field.layout import Layout, Obstacle, Reactions
from hsr8.world.field.motion import Circle, Line, Passage, Shuttle
from hsr8.world.field.moving_field import SLOWING, YIELD_MARGIN, moving_field
from hsr8.world.field.wander import draw_wander

PERIOD, RADIUS, ROBOT = 0.02, 0.12, (0.0, 0.0)


def field_of(motions, radii=None, yields=True):
    """Movers around a robot of 0.12 m."""
    radii = [0.08] * len(motions) if radii is None else radii
    obstacles = tuple(
        Obstacle(m.position(0.0), r, 0.3, "red", m, yields=yields)
        for m, r in zip(motions, radii, strict=True)
    )
    reactions = Reactions(robot_radius=RADIUS)
    layout = Layout(
        (5.0, 5.0), obstacles, (), (0.0, 0.0, 0.0), np.zeros((0, 2)), None, False,
        reactions=reactions,
    )  # fmt: skip
    return moving_field(layout)


def random_motion(rng):
    """Lane that comes near the origin, at up to 0.3 m/s."""
    a, b = rng.uniform(-1.2, 1.2, (2, 2))
    speed = float(rng.uniform(0.03, 0.3))
    kind = rng.integers(5)
    if kind == 0:
        return Shuttle(tuple(a), tuple(b), speed, float(rng.uniform(0.0, 3.0)))
    if kind == 1:
        return Passage(tuple(a), tuple(-0.8 * a + 0.1 * b), speed, float(rng.uniform(0.0, 5.0)))
    if kind == 2:
        return Circle(tuple(a), float(np.hypot(*a)), speed, float(rng.uniform(-pi, pi)))
    if kind == 3:
        return Line(tuple(a), tuple(-speed * a / np.hypot(*a) + 0.02 * b))
    return draw_wander(rng, tuple(0.3 * a), 1.0, speed, 1.0)


def gaps(field, radii, seconds, robot=lambda _: ROBOT):
    """Minimum distance of the surfaces over time (n,)."""
    nearest = np.full(len(radii), np.inf)
    for k in range(round(seconds / PERIOD)):
        time = k * PERIOD
        field.react(time, robot(time))
        moments = time + np.linspace(0.0, PERIOD, 5)
        at = np.hypot(*np.moveaxis(field.positions(moments) - robot(time), -1, 0))
        nearest = np.minimum(nearest, (at - radii).min(axis=0) - RADIUS)
    return nearest


def test_no_mover_drives_into_a_standing_robot():
    """200 encounters, of which half would end in a contact without yielding."""
    rng = np.random.default_rng(0)
    motions, radii = [], []
    while len(motions) < 200:
        motion, radius = random_motion(rng), float(rng.uniform(0.05, 0.12))
        if np.hypot(*motion.position(0.0)) > radius + RADIUS + 0.02:
            motions.append(motion)
            radii.append(radius)
    radii = np.array(radii)
    assert (gaps(field_of(motions, radii, yields=False), radii, 30.0) < 0.0).sum() > 90
    assert (gaps(field_of(motions, radii), radii, 30.0) > 0.0).all()


SHUTTLE = Shuttle((-1.0, 0.0), (1.0, 0.0), 0.2)


def test_the_lane_stays_and_the_clock_goes_slower():
    field = field_of([SHUTTLE])
    clock = 0.0
    for k in range(1000):
        time = k * PERIOD
        field.react(time, (0.6, 0.0))
        ((x, y),), (now,) = field.positions(time), field.clocks(time)
        assert (x, y) == pytest.approx(SHUTTLE.position(now), abs=1e-12)
        assert clock <= now <= time + 1e-9
        clock = now
    assert clock < 8.0


def test_a_mover_slows_down_before_its_margin_and_waits_there():
    field = field_of([SHUTTLE])
    for k in range(700):
        field.react(k * PERIOD, (0.6, 0.0))
        ((x, _),), ((vx, _),) = field.positions(k * PERIOD), field.velocities(k * PERIOD)
        free = 0.6 - x - RADIUS - 0.08 - YIELD_MARGIN
        assert vx == pytest.approx(min(free / SLOWING, SHUTTLE.speed), abs=0.025)
    assert free == pytest.approx(0.0, abs=0.025)


def test_the_velocity_is_the_derivative_of_the_position():
    field = field_of([SHUTTLE])
    for k in range(400):
        time = k * PERIOD
        field.react(time, (0.3, 0.05))
        before, after = field.positions(np.array([time + 0.001, time + 0.011]))
        assert field.velocities(time + 0.005) == pytest.approx((after - before) / 0.01, abs=1e-9)


def test_a_mover_walks_on_when_the_robot_has_left_and_when_it_departs_from_it():
    field = field_of([SHUTTLE])
    for k in range(701):
        time = k * PERIOD
        field.react(time, (0.3, 0.0) if time < 10.0 else (0.3, 2.0))
        if time == 9.0:
            waiting = field.positions(time)
            assert field.velocities(time) == pytest.approx(np.zeros((1, 2)), abs=1e-3)
    assert abs(field.positions(14.0) - waiting).max() > 0.5
    behind = field_of([SHUTTLE])
    behind.react(0.0, (-1.15, 0.0))  # in reach, the mover departs
    assert behind.velocities(0.0) == pytest.approx(np.array([(0.2, 0.0)]))


def test_a_far_robot_changes_nothing():
    nominal = field_of([SHUTTLE], yields=False)
    field = field_of([SHUTTLE])
    times = np.arange(0.0, 30.0, PERIOD)
    for time in times.tolist():
        field.react(time, (0.0, 2.0))
        assert field.positions(time) == pytest.approx(nominal.positions(time), abs=1e-9)


def test_the_seed_draws_who_yields_and_the_world_stays():
    settings = ["world.beacons=true"]
    plain = [draw_layout(load_scenario("quick", settings), seed) for seed in range(10)]
    for fraction, low, high in ((0.0, 0.0, 0.0), (0.5, 0.2, 0.8), (1.0, 1.0, 1.0)):
        scenario = load_scenario("quick", [*settings, f"world.yield_fraction={fraction}"])
        drawn = [draw_layout(scenario, seed) for seed in range(10)]
        for one, other in zip(plain, drawn, strict=True):
            assert [replace(o, yields=False) for o in other.obstacles] == list(one.obstacles)
        movers = [mover.yields for layout in drawn for mover in layout.movers]
        assert low <= np.mean(movers) <= high
