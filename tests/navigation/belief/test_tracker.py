from math import hypot

import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.belief.detections import in_world
from navigation.belief.tracker import Tracker
from navigation.belief.visibility import Viewpoint
from navigation.parameters.belief import TrackingParameters

DT = 0.06
EXACT = np.eye(3) * 1e-8
P = TrackingParameters()


class Stage:
    """A robot standing at the origin that sees what the test puts before it."""

    def __init__(self, view, observe, seed=0, parameters=None):
        self.view, self.observe = view, observe
        self.parameters = parameters or TrackingParameters()
        self.rng = np.random.default_rng(seed)
        self.tracker = Tracker(self.parameters, np.random.default_rng(seed + 1))
        self.time = 0.0
        self.tracks = ()

    def show(self, *locations, pan=0.0, noise=0.02, **details):
        """One frame with an obstacle detected at each place, (x, y) or (x, y, label)."""
        self.time += DT
        pose = np.zeros(3)
        observed = []
        for location in locations:
            label = location[2] if len(location) > 2 else "red"
            distance = hypot(location[0], location[1])
            error = self.rng.normal(0, [noise, noise / distance])
            sigma = (noise, noise / distance)
            observed.append(
                self.observe(pose, location[:2], label=label, noise=error, sigma=sigma, **details)
            )
        sightings = in_world(observed, pose, EXACT, max_pose_sigma=0.1)
        p = self.parameters
        viewpoint = Viewpoint.of(self.view(pan=pan), pose, p.detection_range, p.view_margin)
        self.tracks = self.tracker.update(
            self.time, sightings, viewpoint, np.zeros(len(sightings.radii), bool)
        )
        return self.tracks

    def watch(self, seconds, *movers, **details):
        """Frames with obstacles (x, y, vx, vy) going on from where they were."""
        start = self.time
        for _ in range(round(seconds / DT)):
            t = self.time + DT - start
            self.show(*((x + vx * t, y + vy * t) for x, y, vx, vy in movers), **details)
        return self.tracks

    def look_away(self, seconds):
        for _ in range(round(seconds / DT)):
            self.show(pan=1.57)
        return self.tracks


@pytest.fixture
def stage(view, observe):
    return Stage(view, observe)


def test_single_false_detections_leave_no_track(stage):
    for k in range(300):
        a = 0.6 * np.sin(12.9 * k)
        assert len(stage.show((1.5, a) if k % 30 == 0 else (1.0, 0.0))) <= 1
    assert len(stage.show((1.0, 0.0))) == 1


@pytest.mark.parametrize("seed", range(2))
def test_a_static_obstacle_is_static_after_two_seconds_and_never_moving(view, observe, seed):
    stage = Stage(view, observe, seed)
    stage.show((1.2, 0.2))
    verdicts = [stage.show((1.2, 0.2))[0].motion for _ in range(100)]
    assert Motion.MOVING not in verdicts
    assert Motion.STATIC not in verdicts[: int(stage.parameters.min_static_time / DT)]
    assert verdicts[-1] is Motion.STATIC
    (track,) = stage.tracks
    assert track.velocity.tolist() == [0.0, 0.0]
    assert np.hypot(*(track.position - (1.2, 0.2))) < 0.02
    assert np.linalg.eigvalsh(track.covariance)[0] > 0


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("speed", [0.06, 0.10, 0.14])
def test_a_mover_is_moving_within_two_seconds_and_never_static(view, observe, seed, speed):
    stage = Stage(view, observe, seed)
    for k in range(40):
        stage.show((1.2, -0.5 + speed * DT * k))
        assert all(t.motion is not Motion.STATIC for t in stage.tracks)
    (track,) = stage.tracks
    assert track.motion is Motion.MOVING
    assert np.hypot(*(track.velocity - (0.0, speed))) < 0.05


@pytest.mark.parametrize("seed", range(2))
def test_a_mover_that_stops_is_not_moving_after_rare_looks(view, observe, seed):
    """One noisy look per half second."""
    stage, interval = Stage(view, observe, seed), 0.5
    motions = []
    for k in range(40):
        stage.time += interval - DT
        tracks = stage.show((1.2, min(-0.4 + 0.1 * interval * k, 0.0)))
        motions += [t.motion for t in tracks]
    assert Motion.MOVING in motions
    assert Motion.MOVING not in motions[-10:]


def test_sway_of_the_body_does_not_make_obstacles_move(view, observe):
    """Pitch errors at the step frequency shift all ranges together."""
    stage = Stage(view, observe)
    for k in range(200):
        sway = 0.02 * np.sin(2 * np.pi * 1.5 * DT * k)
        stage.show((1.2 + sway, 0.0), (0.9 + sway, 0.5, "blue"), noise=0.015)
        assert all(t.motion is not Motion.MOVING for t in stage.tracks)
    assert [t.motion for t in stage.tracks] == [Motion.STATIC, Motion.STATIC]


def test_a_reversal_out_of_sight_turns_the_velocity_round(stage):
    stage.watch(3.0, (1.2, -0.4, 0.0, 0.12))
    stage.look_away(3.0)
    (track,) = stage.show((1.2, -0.2))
    assert track.id == 1
    assert track.motion is Motion.MOVING
    assert track.velocity[1] < -0.08


def test_neighbours_of_one_color_keep_their_identity(stage):
    stage.watch(3.0, (1.2, 0.0, 0.0, 0.0), (1.2, 0.4, 0.0, 0.0), (0.9, 0.2, 0.0, 0.0))
    locations = {t.id: t.position for t in stage.tracks}
    for k in range(100):
        shown = [(1.2, 0.0), (1.2, 0.4), (0.9, 0.2)]
        shown.pop(k % 4) if k % 4 < 3 else None
        stage.show(*shown)
    assert {t.id for t in stage.tracks} == set(locations)
    for t in stage.tracks:
        assert np.hypot(*(t.position - locations[t.id])) < 0.03


def test_a_mover_survives_passing_behind_another_obstacle(stage):
    stage.watch(3.0, (1.4, -0.4, 0.0, 0.12), (0.8, 0.0, 0.0, 0.0))
    ids = {t.id for t in stage.tracks}
    for k in range(60):
        y = -0.04 + 0.12 * DT * k
        shown = [(0.8, 0.0)] if y < 0.28 else [(0.8, 0.0), (1.4, y)]
        stage.show(*shown, noise=0.015)
    assert {t.id for t in stage.tracks} == ids
    assert any(t.motion is Motion.MOVING for t in stage.tracks)


def test_a_lost_mover_becomes_particles_that_go_on_or_turn_back(stage):
    stage.watch(3.0, (1.0, -0.4, 0.0, 0.12))
    stage.look_away(5.0)
    (track,) = stage.tracks
    cloud = track.particles
    assert track.motion is Motion.MOVING
    assert len(cloud.weights) == stage.parameters.particles
    assert cloud.weights.sum() == pytest.approx(1.0)
    assert np.median(cloud.positions[:, 1]) > 0.25
    assert np.hypot(*(cloud.positions - track.last_seen).T).max() < 1.5
    stage.look_away(stage.parameters.forget_time)
    assert not stage.tracks


@pytest.mark.parametrize("seed", range(2))
def test_a_refuted_mover_goes_on_where_enough_of_the_places_tried_are_out_of_view(
    view, observe, seed
):
    def tracks(**changes):
        """It walks to the border of the view and is lost; then its place is looked at in vain."""
        stage = Stage(view, observe, seed, TrackingParameters(**changes))
        stage.watch(3.0, (1.0, 0.3, 0.0, 0.12))
        stage.look_away(1.0)
        for _ in range(30):
            stage.show()
        return stage.tracks

    assert not tracks(candidates_per_particle=1)
    assert len(tracks(candidates_per_particle=20)) == 1
    assert len(tracks(candidates_per_particle=1, min_existence=1e-12)) == 1


def test_a_static_track_ends_when_its_place_is_seen_empty_but_not_when_hidden(stage):
    stage.watch(4.0, (1.2, 0.0, 0.0, 0.0))
    stage.look_away(20.0)
    assert len(stage.tracks) == 1
    for _ in range(40):
        stage.show((0.6, 0.0, "blue"), pan=0.0)
    assert sorted(t.label for t in stage.tracks) == ["blue", "red"]
    for _ in range(40):
        stage.show((0.6, 0.5, "blue"), pan=0.0)
    assert "red" not in [t.label for t in stage.tracks]


@pytest.mark.parametrize("flag", ["cut", "occluded"])
def test_a_partly_visible_obstacle_changes_the_radius_only_if_precise(stage, flag):
    stage.watch(2.0, (1.0, 0.0, 0.0, 0.0))
    radius = stage.tracks[0].radius
    for _ in range(20):
        stage.show((1.0, 0.0), radius=0.02, radius_sigma=1.1 * P.max_radius_sigma, **{flag: True})
    assert stage.tracks[0].radius == radius
    for _ in range(20):
        stage.show((1.0, 0.0), radius=0.07, radius_sigma=0.1 * P.max_radius_sigma, **{flag: True})
    assert stage.tracks[0].radius == pytest.approx(0.07, abs=0.002)


def test_a_part_is_placed_by_the_radius_that_the_track_knows(view, observe):
    """Only its near side is visible: a larger radius places the axis farther away."""
    locations = []
    for slope in (0.0, 1.0):
        stage = Stage(view, observe)
        stage.watch(4.0, (1.0, 0.0, 0.0, 0.0), radius=0.06, radius_sigma=0.002)
        details = {"cut": True, "radius": 0.08, "radius_sigma": 0.02, "by_radius": (slope, 0.0)}
        for _ in range(100):
            stage.show((1.02, 0.0), noise=0.025, **details)
        (track,) = stage.tracks
        locations.append(float(track.position[0]))
    assert locations[0] - locations[1] == pytest.approx(0.02, abs=0.01)
    assert locations[1] == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("seed", range(2))
def test_a_turn_in_view_is_seen_within_a_second_by_noisy_looks(view, observe, seed):
    stage = Stage(view, observe, seed)
    stage.watch(4.0, (1.0, -0.4, 0.0, 0.1), noise=0.03)
    (track,) = stage.watch(1.0, (1.0, 0.0, 0.0, -0.1), noise=0.03)
    assert track.velocity[1] < 0.0


def test_a_detection_on_free_floor_is_assigned_to_the_lost_mover(view, observe):
    ids = []
    for freed in (False, True):
        stage = Stage(view, observe)
        stage.watch(3.0, (1.0, -0.4, 0.0, 0.12))
        stage.look_away(8.0)
        observed = in_world(
            [observe(np.zeros(3), (1.6, -0.8))],
            np.zeros(3),
            EXACT,
            max_pose_sigma=0.1,
        )
        viewpoint = Viewpoint.of(view(), np.zeros(3), 2.2, P.view_margin)
        for k in range(1, 4):
            tracks = stage.tracker.update(
                stage.time + k * DT, observed, viewpoint, np.array([freed])
            )
        ids.append([t.id for t in tracks if t.visible])
    assert ids == [[2], [1]]
