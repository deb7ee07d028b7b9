from dataclasses import replace
from math import pi, radians
from types import SimpleNamespace

import numpy as np
import pytest

from hsr8.measure import metrics as module
from hsr8.world.field.certificate import Certificate
from navigation.parameters.navigation import MissionParameters

PATH = np.array([[0.0, 0.0, 0.0, 0.0], [4.0, 1.5, 0.0, 0.0], [9.0, 1.5, 1.0, 1.6]])

PROMISED = {
    "success",
    "collisions",
    "falls",
    "via_points_total",
    "via_points_passed",
    "goal_reached",
    "arrival_error_deg",
    "time_to_goal_s",
    "path_length_m",
    "min_clearance_m",
    "localization_rmse_m",
    "heading_rmse_deg",
    "nees_mean",
    "obstacle_speed_rmse_mps",
    "sim_time_s",
    "wall_time_s",
    "real_time_factor",
    "state_hash",
    "exit_reason",
}


@pytest.fixture
def measure(layout, tables_of):
    """Results of records, with a via point radius of 15 cm and a goal radius of 5 cm."""

    def measured(records, reason="timeout", world=layout, certificate=None):
        navigation = SimpleNamespace(mission=MissionParameters(r_via=0.15, r_goal=0.05))
        run = SimpleNamespace(
            **tables_of(records),
            manifest={"state_hash": "hash", "wall_time_s": 5.0},
            exit_reason=reason,
            scenario=lambda: SimpleNamespace(
                navigation=navigation,
                robot=SimpleNamespace(radius=0.12),
                recorder=SimpleNamespace(space_scale=None),
            ),
        )
        return module.measure(run, world, certificate)

    return measured


def test_all_keys_are_present_also_without_records(measure):
    results = measure([], "interrupted")
    assert set(results) >= PROMISED
    assert results["success"] is False
    assert results["localization_rmse_m"] is None


@pytest.mark.parametrize(
    ("certificate", "endless", "time", "length"),
    [
        (Certificate(True, 2, 2, 9.0, PATH), False, 9.0, 2.5),
        (Certificate(True, 1, 1, 9.0, PATH), False, None, None),  # not all points were checked
        (Certificate(False, 1, 2, 400.0), False, None, None),
        (Certificate(True, 2, 2, 9.0, PATH), True, None, None),
        (None, False, None, None),
    ],
)
def test_the_certified_path_counts_if_it_leads_to_the_goal(
    measure, layout, certificate, endless, time, length
):
    results = measure([], world=replace(layout, endless=endless), certificate=certificate)
    assert results["certified_time_s"] == time
    assert results["certified_length_m"] == length
    assert (results["spl"], results["stl"]) == ((None, None) if time is None else (0.0, 0.0))


def test_a_straight_walk(measure, walk):
    results = measure(walk(10.0))
    assert results["path_length_m"] == pytest.approx(2.0)
    assert results["sim_time_s"] == pytest.approx(10.0)
    assert results["localization_rmse_m"] == pytest.approx(0.0)
    assert results["obstacle_speed_rmse_mps"] == pytest.approx(0.0)
    assert results["min_clearance_m"] == 0.5
    assert results["time_standing_s"] == 0.0
    assert results["state_hash"] == "hash"
    assert results["real_time_factor"] == pytest.approx(2.0)
    assert results["max_tilt_deg"] == pytest.approx(np.degrees(np.hypot(0.01, 0.02)))


def test_sway_does_not_add_to_the_path(measure, fake):
    """Swaying by 2 cm at the pace of the gait, on the spot, the path stays short."""
    records = (
        fake.record(0.02 * k, (0.0, 0.02 * np.sin(2 * pi * k / 50), 0.0)) for k in range(501)
    )
    results = measure(records)
    assert results["path_length_m"] < 0.01
    assert results["time_standing_s"] == pytest.approx(10.0)


def test_localization_errors_are_root_mean_squares(measure, fake):
    """Two frames: 3 cm off along x and 10 deg, then 4 cm along y across the wrap at 180 deg."""
    poses = ((0.0, 0.0, 0.0), (0.0, 0.0, pi - 0.01))
    believed = ((0.03, 0.0, radians(10.0)), (0.0, 0.04, -pi + 0.01))
    covariance = np.diag([0.01**2, 0.02**2, 0.05**2])
    records = [
        fake.record(0.06 * i, pose, frame=fake.frame(0.06 * i, belief, pose_covariance=covariance))
        for i, (pose, belief) in enumerate(zip(poses, believed, strict=True))
    ]
    results = measure(records)
    assert results["localization_rmse_m"] == pytest.approx(np.sqrt((0.03**2 + 0.04**2) / 2))
    heading = np.sqrt((radians(10.0) ** 2 + 0.02**2) / 2)
    assert results["heading_rmse_deg"] == pytest.approx(np.degrees(heading))
    nees = (9 + (radians(10.0) / 0.05) ** 2 + 4 + (0.02 / 0.05) ** 2) / 2 / 3
    assert results["nees_mean"] == pytest.approx(nees)


@pytest.mark.parametrize(
    ("contact", "lost", "counted"),
    [
        (None, (), range(6)),
        (2, (), range(2)),  # never relocalized
        (2, (3,), (0, 1, 4, 5)),  # relocalized in frame 4
        (2, (0, 1), (0, 1)),  # relocalized with the contact, not after it
        (2, (4, 5), (0, 1)),
        (0, (), ()),
    ],
)
def test_the_nees_excludes_frames_between_a_contact_and_the_next_relocalization(
    measure, fake, contact, lost, counted
):
    """The error of frame k is k + 1 standard deviations of 1 cm along x."""
    records = []
    for k in range(6):
        belief = (0.01 * (k + 1), 0.0, 0.0)
        frame = fake.frame(0.06 * k, belief, lost=k in lost)
        touching = (0,) if k == contact else ()
        records.append(fake.record(0.06 * k, contacts=touching, frame=frame))
    results = measure(records)
    squares = [(k + 1) ** 2 for k in range(6)]
    expected = np.mean([squares[k] / 3 for k in counted]) if counted else None
    assert results["nees_mean"] == (None if expected is None else pytest.approx(expected))
    assert results["localization_rmse_m"] == pytest.approx(0.01 * np.sqrt(np.mean(squares)))


def test_tracks_are_compared_with_the_nearest_obstacle_if_any(measure, fake):
    wrong = fake.track(2, 0.0, velocity=(0.03, 0.1))
    ghost = fake.track(0, 0.0, error=(-0.7, 1.0), velocity=(9.0, 9.0))
    frame = fake.frame(0.0, tracks=(wrong, ghost))
    results = measure([fake.record(0.0, frame=frame)])
    assert results["obstacle_speed_rmse_mps"] == pytest.approx(0.03)


def test_collisions_by_kind(measure, fake):
    touched = {10: (0,), 11: (0, 2), 12: (0,), 60: (2,)}
    records = (fake.record(0.02 * k, contacts=touched.get(k, ())) for k in range(100))
    results = measure(records)
    assert results["collisions"] == 3
    assert results["first_collision_s"] == pytest.approx(0.2)
    assert results["collisions_moving"] == 2
    assert results["collisions_static"] == 1
    assert results["collisions_at_fault"] == 1


def test_lying_is_one_fall_and_its_tilt_does_not_count(measure, fake):
    lying = fake.record(0.02, fallen=True)
    lying = replace(lying, walking=replace(lying.walking, roll=1.5))
    results = measure([fake.record(0.0), lying, replace(lying, time=0.04)], "fall")
    assert results["falls"] == 1
    assert results["success"] is False
    assert results["max_tilt_deg"] < 2.0


def _arrival(fake, via_at, goal_at, **more):
    """A via point passed at `via_at` and the mission done at `goal_at`."""
    return [
        fake.record(0.0, frame=fake.frame(0.0)),
        fake.record(5.0, via_at, frame=fake.frame(5.0, via_at, index=1)),
        fake.record(
            9.0, goal_at, frame=fake.frame(9.0, goal_at, index=1, is_goal=True, done=True), **more
        ),
    ]


def test_a_perfect_course_is_a_success(measure, fake):
    results = measure(_arrival(fake, (0.9, 0.0, 0.0), (1.5, 1.02, 1.1)), "goal")
    assert results["via_points_total"] == 1
    assert results["via_points_passed"] == 1
    assert results["goal_reached"] is True
    assert results["time_to_goal_s"] == 9.0
    assert results["arrival_error_deg"] == pytest.approx(np.degrees(0.1))
    assert results["success"] is True


def test_a_false_belief_does_not_count(measure, fake):
    """The robot believes that it passed and arrived, but it is 40 cm away."""
    results = measure(_arrival(fake, (1.0, 0.4, 0.0), (1.5, 1.4, 1.0)), "goal")
    assert results["via_points_passed"] == 0
    assert results["via_points_missed"] == 1
    assert results["goal_reached"] is False
    assert results["success"] is False


def test_a_wrong_heading_is_not_an_arrival(measure, fake):
    results = measure(_arrival(fake, (1.0, 0.0, 0.0), (1.5, 1.0, 1.4)), "goal")
    assert results["goal_reached"] is False


def test_a_collision_prevents_success(measure, fake):
    records = _arrival(fake, (1.0, 0.0, 0.0), (1.5, 1.0, 1.0), contacts=(0,))
    results = measure(records, "goal")
    assert results["goal_reached"] is True
    assert results["success"] is False


def test_an_endless_tour_counts_rounds_and_succeeds_at_its_end(measure, layout, fake):
    places = ((1.0, 0.0, 0.0), (1.5, 1.0, 0.0), (1.0, 0.0, 0.0))
    records = [
        fake.record(1.0 * i, p, frame=fake.frame(1.0 * i, p, index=i + 1))
        for i, p in enumerate(places)
    ]
    results = measure(records, "completed", replace(layout, endless=True))
    assert results["via_points_total"] == 2
    assert results["via_points_passed"] == 3
    assert results["goal_reached"] is False
    assert results["success"] is True


def test_saccades_are_large_changes_of_the_commanded_gaze(measure, fake):
    records = []
    for k, pan in enumerate((0.0, 0.05, 0.6, 0.6, -0.3)):
        frame = fake.frame(0.06 * k)
        gaze = replace(frame.gaze, pan=pan)
        frame = replace(frame, decision=replace(frame.decision, gaze=gaze))
        records.append(fake.record(0.06 * k, frame=frame))
    assert measure(records)["saccades_per_s"] == pytest.approx(2 / 0.24)


def test_the_head_travels_as_far_as_the_camera_turned(measure, fake):
    records = []
    for k, (pan, tilt) in enumerate(((0.0, 0.0), (0.3, -0.4), (0.3, -0.4), (0.0, -0.4))):
        frame = fake.frame(0.06 * k)
        view = replace(frame.measured.view, pan=pan, tilt=tilt)
        frame = replace(frame, measured=replace(frame.measured, view=view))
        records.append(fake.record(0.06 * k, frame=frame))
    assert measure(records)["head_travel_radps"] == pytest.approx((0.5 + 0.3) / 0.18)
