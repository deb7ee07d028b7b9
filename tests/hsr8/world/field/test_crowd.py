from dataclasses import replace
from math import hypot

import numpy as np
import pytest

from hsr8.errors import ScenarioError
from hsr8.scenario.loader import load_scenario
from hsr8.world.field.crowd import MARGIN
from hsr8.world.field.generator import draw_layout
from hsr8.world.field.layout import Layout, Obstacle, Reactions
from hsr8.world.field.motion import Passage, Shuttle
from hsr8.world.field.moving_field import moving_field
from navigation.baselines.half_planes import orca_plane, solve

PERIOD, FAR = 0.02, (9.0, 9.0)
SPEED, RADIUS = 0.2, 0.12


def layout_of(*motions, static=(), sees_robot=True):
    people = (Obstacle(m.position(0.0), RADIUS, 0.3, "red", m) for m in motions)
    reactions = Reactions(crowd=True, sees_robot=sees_robot, robot_radius=RADIUS)
    return Layout(
        (5.0, 5.0), (*static, *people), (), (0.0, 0.0, 0.0), np.zeros((0, 2)), None, False,
        reactions=reactions,
    )  # fmt: skip


def walk(layout, seconds, robot=lambda _: FAR):
    """Positions of the people over time (t, n, 2)."""
    field, positions = moving_field(layout), []
    for k in range(round(seconds / PERIOD)):
        field.react(k * PERIOD, robot(k * PERIOD))
        positions.append(field.positions(k * PERIOD))
    return np.array(positions)


def min_gap(positions):
    """Minimum distance of the axes of two people."""
    first, second = np.triu_indices(positions.shape[1], 1)
    return float(np.hypot(*(positions[:, first] - positions[:, second]).T).min())


def circle_layout(seed, n, *settings):
    return draw_layout(load_scenario("circle", [f"world.circle.n={n}", *settings]), seed)


@pytest.mark.parametrize("n", [5, 10])
def test_people_on_a_circle_never_overlap_and_arrive(n):
    for seed in range(6):
        layout = circle_layout(seed, n)
        positions = walk(layout, 50.0)
        assert min_gap(positions) >= 2.0 * RADIUS
        goals = np.array([mover.motion.end for mover in layout.movers])
        assert np.hypot(*(positions[-1] - goals).T).max() < 0.1
        speeds = np.hypot(*np.moveaxis(np.diff(positions, axis=0), -1, 0)) / PERIOD
        assert speeds.max() <= SPEED + 1e-9


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_no_overlaps_in_500_worlds_of_5_and_10():
    for n in (5, 10):
        for seed in range(1000, 1500):
            assert min_gap(walk(circle_layout(seed, n), 40.0)) >= 2.0 * RADIUS, (n, seed)


def test_straight_motion_would_overlap():
    """The crowd is what keeps the people apart."""
    layout = replace(circle_layout(0, 10), reactions=Reactions())
    assert min_gap(walk(layout, 20.0)) < 2.0 * RADIUS


def test_starts_and_goals_are_opposite_and_apart():
    for seed in range(20):
        layout = circle_layout(seed, 8)
        starts = np.array([mover.motion.start for mover in layout.movers])
        ends = np.array([mover.motion.end for mover in layout.movers])
        assert ends == pytest.approx(-starts)
        assert np.abs(np.hypot(*starts.T) - 1.6).max() <= 0.2 * 2.0**0.5
        robot = np.array([layout.start[:2], layout.waypoints[0]])
        points = np.concatenate([starts, ends, robot])
        for points_of_kind in (starts, ends):
            gaps = np.hypot(*(points_of_kind[:, None] - points[None]).transpose(2, 0, 1))
            assert gaps[gaps > 0.0].min() >= 2.0 * RADIUS + 0.08


PASSAGE = Passage((-1.5, 0.0), (1.5, 0.0), SPEED)


@pytest.mark.parametrize("sees_robot", [True, False])
def test_only_a_visible_robot_is_avoided(sees_robot):
    layout = layout_of(PASSAGE, sees_robot=sees_robot)
    positions = walk(layout, 20.0, robot=lambda _: (0.0, 0.01))[:, 0]
    nearest = np.hypot(*(positions - (0.0, 0.01)).T).min()
    assert (nearest >= 2.0 * RADIUS) == sees_robot
    assert positions[-1] == pytest.approx(np.array(PASSAGE.end), abs=0.1)


def test_static_obstacles_are_avoided():
    post = Obstacle((0.0, 0.02), 0.1, 0.3, "green")
    positions = walk(layout_of(PASSAGE, static=(post,)), 20.0)[:, 0]
    assert np.hypot(*(positions - post.position).T).min() >= RADIUS + 0.1
    assert positions[-1] == pytest.approx(np.array(PASSAGE.end), abs=0.1)


@pytest.mark.parametrize("offset", [0.0, 1.5])
def test_a_shuttle_goes_back_and_forth(offset):
    lane = Shuttle((-0.5, 0.0), (0.5, 0.0), SPEED, offset)
    positions = walk(layout_of(lane), 40.0)[:, 0, 0]
    assert positions[0] == pytest.approx(lane.position(0.0)[0])
    assert np.sign(positions[20] - positions[0]) == (1.0 if offset < 1.0 else -1.0)
    turns = np.diff(np.sign(np.diff(positions)))
    assert 3 <= np.count_nonzero(turns) <= 10
    assert positions.max() > 0.4
    assert positions.min() < -0.4


def test_a_passage_waits_until_it_departs():
    positions = walk(layout_of(replace(PASSAGE, depart=4.0)), 8.0)[:, 0]
    assert (positions[: round(4.0 / PERIOD)] == PASSAGE.start).all()
    assert positions[-1, 0] > PASSAGE.start[0] + 0.5


def test_the_state_decides_the_future():
    layout = circle_layout(1, 5)
    a, b = moving_field(layout), moving_field(layout)
    for k in range(500):
        a.react(k * PERIOD, FAR)
        b.react(k * PERIOD, FAR)
        assert a.state_bytes() == b.state_bytes()
    b.react(500 * PERIOD, (0.0, 0.0))
    a.react(500 * PERIOD, FAR)
    assert a.state_bytes() != b.state_bytes()


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (["world.n_moving=2", 'world.motions=["circle"]'], "expected shuttle"),
        (["world.yield_fraction=0.5"], 'requires world.crowd = "none"'),
    ],
)
def test_a_crowd_needs_lanes_with_ends(settings, message):
    with pytest.raises(ScenarioError, match=message):
        load_scenario("circle", settings)


def test_one_decision_is_that_of_the_reference_implementation():
    """RVO2 by its Python binding, where it is installed."""
    pyrvo = pytest.importorskip("pyrvo")
    for seed in range(20):
        layout = circle_layout(seed, 10, "world.beacons=false")
        field = moving_field(layout)
        for k in range(150):
            before, velocities = field.positions(k * 0.5), field.velocities(k * 0.5)
            field.react(k * 0.5, FAR)
            sim = pyrvo.RVOSimulator(0.5, 10.0, 20, 10.0, 10.0, RADIUS + MARGIN, SPEED)
            for mover, (x, y), velocity in zip(
                layout.movers, before.tolist(), velocities.tolist(), strict=True
            ):
                agent = sim.add_agent((x, y))
                sim.set_agent_velocity(agent, tuple(velocity))
                dx, dy = mover.motion.end[0] - x, mover.motion.end[1] - y
                distance = np.hypot(dx, dy)
                speed = min(SPEED, distance / 2.0) / max(distance, 1e-9)
                sim.set_agent_pref_velocity(agent, (speed * dx, speed * dy))
            sim.do_step()
            reference = [sim.get_agent_velocity(i).to_tuple() for i in range(10)]
            assert field.velocities(k * 0.5) == pytest.approx(np.array(reference), abs=3e-5)


STEP, DISC = 0.25, 0.3  # of CrowdNav [s, m]


def crowdnav_start(seed):
    """Starts and goals (6, 2) of one of its test cases, robot first."""
    rng = np.random.RandomState(seed)
    starts, goals = [np.array([0.0, -4.0])], [np.array([0.0, 4.0])]
    while len(starts) < 6:
        angle, *noise = rng.random_sample(3).tolist()
        angle *= 2.0 * np.pi
        start = 4.0 * np.array([np.cos(angle), np.sin(angle)]) + np.array(noise) - 0.5
        if min(hypot(*(start - other)) for other in starts + goals) >= 2.0 * DISC + 0.2:
            starts.append(start)
            goals.append(-start)
    return np.array(starts), np.array(goals)


def crowdnav_decision(i, positions, velocities, goal):
    """Velocity of disc `i` by ORCA; the people do not see the robot."""
    offsets, relative = positions - positions[i], velocities[i] - velocities
    others = [j for j in range(6) if j != i and (i == 0 or j != 0)]
    planes = [
        orca_plane(
            offsets[j].tolist(), relative[j].tolist(), velocities[i].tolist(),
            radius=2.0 * (DISC + 0.01), horizon=5.0, footstep=STEP, responsibility=0.5,
        )
        for j in sorted(others, key=lambda j: hypot(*offsets[j]))
    ]  # fmt: skip
    preferred = goal - positions[i]
    return solve(planes, 0, (preferred / max(1.0, hypot(*preferred))).tolist(), 1.0)


def crowdnav_episode(seed):
    """Time of arrival of the robot; NaN after a collision, infinite after the time limit."""
    positions, goals = crowdnav_start(seed)
    velocities = np.zeros((6, 2))
    for step in range(1, 98):
        decided = np.array(
            [crowdnav_decision(i, positions, velocities, goals[i]) for i in range(6)]
        )
        # It detects collisions of the next position of the robot with the old velocities of people.
        gap, moved = positions[1:] - positions[0], STEP * (velocities[1:] - decided[0])
        part = -(gap * moved).sum(axis=1) / np.maximum((moved * moved).sum(axis=1), 1e-12)
        nearest = gap + np.clip(part, 0.0, 1.0)[:, None] * moved
        positions, velocities = positions + STEP * decided, decided
        if (np.hypot(*nearest.T) < 2.0 * DISC).any():
            return np.nan
        if hypot(*(positions[0] - goals[0])) < DISC:
            return STEP * step
    return np.inf


@pytest.mark.slow
def test_orca_reaches_the_published_row():
    """Chen et al., ICRA 2019, invisible robot: success 0.43, collision 0.57, 10.86 s."""
    times = np.array([crowdnav_episode(1000 + case) for case in range(500)])
    arrived = times[np.isfinite(times)]
    assert len(arrived) / 500 == pytest.approx(0.43, abs=0.005)
    assert np.isnan(times).mean() == pytest.approx(0.57, abs=0.005)
    assert arrived.mean() == pytest.approx(10.86, abs=0.005)
