from types import SimpleNamespace

import numpy as np
import pytest

from hsr8.measure.social import social_metrics

RADIUS, MOVER = 0.12, 2  # of the robot; index of the mover in the layout
HEIGHT_RATIO = 0.30 / 1.7


@pytest.fixture
def measure(layout, fake, tables_of):
    """Results of poses of the robot and positions of the mover, functions of time, over 4 s."""

    def measured(pose, mover, *, velocity=(0.0, 0.0), scale=None, collisions=(), end=4.0):
        scenario = SimpleNamespace(
            robot=SimpleNamespace(radius=RADIUS), recorder=SimpleNamespace(space_scale=scale)
        )
        records = []
        for time in np.arange(0.0, end + 1e-9, 0.02):
            positions = np.array([(9.0, 9.0), (9.0, 8.0), mover(time)])
            velocities = np.array([(0.0, 0.0), (0.0, 0.0), velocity])
            frame = fake.frame(time, pose(time), index=0)
            records.append(
                fake.record(
                    time,
                    pose(time),
                    frame=frame,
                    obstacle_positions=positions,
                    obstacle_velocities=velocities,
                )
            )
        tables = tables_of(records)
        return social_metrics(
            tables["records"], tables["frames"], layout, scenario, list(collisions)
        )

    return measured


def still(x=0.0, y=0.0):
    return lambda _: (x, y, 0.0)


@pytest.mark.parametrize("scale", [None, 1.0])
@pytest.mark.parametrize(
    ("distance", "space"), [(0.3, "intimate"), (0.9, "personal"), (2.5, "social"), (4.0, None)]
)
def test_a_standing_mover_is_in_one_space(measure, scale, distance, space):
    factor = HEIGHT_RATIO if scale is None else scale
    gap = RADIUS + factor * distance
    results = measure(still(), lambda _: (gap, 0.0), scale=scale)
    spaces = {s: results[f"{s}_space_intrusions"] for s in ("intimate", "personal", "social")}
    assert spaces == {s: float(s == space) for s in spaces}
    assert results["space_compliance"] == float(distance >= 0.5)
    assert results["minimum_distance_to_people_m"] == pytest.approx(gap - RADIUS)
    assert results["avg_distance_to_closest_person_m"] == pytest.approx(gap - RADIUS - 0.08)


def test_intrusions_are_fractions_of_the_time(measure):
    """The mover retreats at 0.3 m/s: half of the 4 s below 0.6 m, which is literal metres here."""
    results = measure(still(), lambda t: (RADIUS + 0.45 + 0.3 * (t - 2.0), 0.0), scale=1.0)
    assert results["intimate_space_intrusions"] == pytest.approx(0.5, abs=0.01)
    assert results["personal_space_intrusions"] == pytest.approx(0.5, abs=0.01)


def test_the_time_to_collision_is_that_of_a_simulated_approach(measure):
    """Both move at constant velocity; the contact is found on a fine grid of time."""
    own, speed = np.array([0.2, 0.05]), np.array([-0.3, -0.1])
    start = np.array([2.9, 0.8])
    results = measure(
        lambda t: (*(own * t), 0.0), lambda t: tuple(start + speed * t), velocity=tuple(speed)
    )
    times = np.arange(0.0, 20.0, 1e-4)
    gap = np.hypot(*(start[:, None] + np.outer(speed - own, times))) - RADIUS - 0.08
    contact = times[gap <= 0.0][0]
    assert results["min_time_to_collision_s"] == pytest.approx(contact - 4.0, abs=1e-3)


def test_parallel_and_departing_movers_have_no_time_to_collision(measure):
    walk = measure(lambda t: (0.2 * t, 0.0, 0.0), lambda t: (0.2 * t, 1.0), velocity=(0.2, 0.0))
    away = measure(still(), lambda t: (1.0 + t, 0.0), velocity=(1.0, 0.0))
    assert walk["min_time_to_collision_s"] is away["min_time_to_collision_s"] is None
    assert measure(still(), lambda _: (0.1, 0.0))["min_time_to_collision_s"] == 0.0


def test_a_straight_walk_to_the_target_is_regular_and_smooth(measure):
    """The first waypoint of the layout is at (1, 0)."""
    straight = measure(lambda t: (0.2 * t, 0.0, 0.0), lambda _: (9.0, 0.0))
    assert straight["path_irregularity_rad"] == pytest.approx(0.0, abs=1e-12)
    assert straight["avg_overacceleration_mps3"] == pytest.approx(0.0, abs=1e-12)
    assert straight["cumulative_heading_changes_rad"] == 0.0
    away = measure(lambda t: (-0.2 * t, 0.0, 0.0), lambda _: (9.0, 0.0))
    assert away["path_irregularity_rad"] == pytest.approx(np.pi)


def test_jerk_and_turns_of_a_cubic_path(measure):
    """x = j t³ / 6 has the jerk j; the heading turns at 0.2 rad/s and back across the wrap."""
    results = measure(
        lambda t: (0.1 * t**3 / 6.0, 0.0, np.pi - 0.2 + 0.2 * t), lambda _: (9.0, 9.0)
    )
    assert results["avg_overacceleration_mps3"] == pytest.approx(0.1)
    assert results["cumulative_heading_changes_rad"] == pytest.approx(0.8)


def test_collisions_with_movers_have_a_cause(measure):
    def contact(**change):
        return SimpleNamespace(**({"moving": True, "closing": True} | change))

    results = measure(
        still(),
        lambda _: (1.0, 0.0),
        collisions=[
            contact(),
            contact(closing=False),
            contact(closing=False),
            contact(moving=False),
        ],
    )
    assert results["robot_on_person_collision"] == 1
    assert results["person_on_robot_collision"] == 2


def test_without_records_nothing_is_measured(measure):
    results = measure(still(), lambda _: (1.0, 0.0), end=-1.0)
    counts = {"robot_on_person_collision", "person_on_robot_collision"}
    assert {k: v for k, v in results.items() if v is not None} == dict.fromkeys(counts, 0)
