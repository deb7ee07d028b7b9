"""Properties of every mode of the gaze."""

from typing import get_args

import numpy as np
import pytest

from navigation.belief.tracks import Tracks
from navigation.decision import MotionDecision
from navigation.parameters.gaze import GazeMode
from navigation.parameters.navigation import NavigationParameters
from navigation.scene import Scene

P, PAPER = NavigationParameters.extended(), NavigationParameters.paper()
MODES = get_args(GazeMode)
DELIBERATE = ["risk", "integrated"]
ODD = {"step": 0.13, "max_pan": 1.5, "min_tilt": -1.0, "max_tilt": 0.27}
WALK = MotionDecision(np.array([0.15, 0.0, 0.1]))


@pytest.fixture
def crowded(belief, track):
    """Returns the belief of the k-th frame among obstacles, some lost and the ground half seen."""

    def make(k, order=1, **details):
        rng = np.random.default_rng(k)
        cloud = (rng.uniform(-1.0, 1.0, (4, 2)), np.zeros((4, 2)), np.full(4, 0.25))
        tracks = [
            track(c, (0.1, 0.0), age=1.0, id=i, sigma=0.05, particles=cloud if i == 2 else None)
            for i, c in enumerate(rng.uniform(-1.5, 1.5, (6, 2)))
        ]
        details = {"time": 0.37 * k, "confidence": lambda x, y: 0.5, **details}
        return belief(tracks[::order], **details)

    return make


@pytest.mark.parametrize("changes", [{}, ODD], ids=["default", "no multiple of the step"])
@pytest.mark.parametrize("mode", MODES)
def test_every_gaze_stays_within_the_limits_of_the_head(mode, changes, gaze, crowded):
    choose = gaze(mode=mode, **changes)
    p = choose.parameters.gaze
    for k in range(12):
        decision = choose(crowded(k))
        assert abs(decision.pan) <= p.max_pan + 1e-9
        assert p.min_tilt - 1e-9 <= decision.tilt <= p.max_tilt + 1e-9
        assert np.isfinite(decision.gaze_map).all()
        assert decision.gaze_map.min() >= 0.0


@pytest.mark.parametrize("moved_by", ["head", "body"])
@pytest.mark.parametrize("mode", MODES)
def test_the_same_memory_and_scene_give_the_same_gaze(mode, moved_by, gaze, crowded):
    """Deciding twice, or after the decisions of other frames, changes nothing."""
    choose = gaze(mode=mode, moved_by=moved_by, max_pan=1.0)
    decided = []
    for k in range(8):
        memory, scene = choose.memory, choose.scene(crowded(k, lost=k > 5), motion=WALK)
        decided.append((memory, scene, *choose.planner.choose(memory, scene, WALK)))
        choose.memory = decided[-1][3]
    for memory, scene, decision, after in decided[::-1]:
        again, later = choose.planner.choose(memory, scene, WALK)
        assert same(again, decision)
        assert same(later, after)


@pytest.mark.parametrize("mode", MODES)
def test_the_memory_of_the_start_holds_nothing_of_the_frames_before(mode, gaze, crowded):
    """After a relocalization, densities and directions of the former pose are wrong."""
    used, fresh = gaze(mode=mode), gaze(mode=mode)
    for k in range(6):
        used(crowded(k, pose=(0.7, 0.2, 0.4)), motion=WALK)
    used.memory = used.planner.begin()
    for k in range(6, 10):
        b = crowded(k)
        assert same(used(b, motion=WALK), fresh(b, motion=WALK))


@pytest.mark.parametrize("p", [P, PAPER], ids=["extended", "paper"])
def test_the_order_of_tracks_is_irrelevant(p, gaze, crowded):
    for k in range(5):
        one, other = gaze(p)(crowded(k)), gaze(p)(crowded(k, order=-1))
        assert (one.pan, one.tilt) == pytest.approx((other.pan, other.tilt))
        assert one.gaze_map == pytest.approx(other.gaze_map)


@pytest.mark.parametrize("mode", DELIBERATE)
def test_the_gaze_ignores_landmarks_as_obstacles(mode, gaze, crowded, track):
    choose, b = gaze(mode=mode), crowded(0)
    known = Tracks.of([track((0.6, 0.5), id=-1)])
    plain = choose.scene(b)
    among = Scene.of(b, plain.task, choose.parameters, body=np.zeros(3), landmarks=known)
    assert among.landmarks == 1
    one, _ = choose.planner.choose(choose.memory, plain, None)
    other, _ = choose.planner.choose(choose.memory, among, None)
    assert same(one, other)


@pytest.mark.parametrize("mode", DELIBERATE)
def test_the_mirror_image_of_a_world_is_looked_at_from_the_other_side(mode, gaze, belief, track):
    def world(side):
        tracks = [track((0.4, 0.8 * side), (-0.05, -0.1 * side), sigma=0.1, age=1.5)]
        unseen = belief(tracks, confidence=lambda x, y: 0.2 if side * y > 0 else 1.0)
        beacons = {"cyan/yellow": (0.5, 2.9 * side)}
        return gaze(mode=mode, beacons=beacons)(unseen, target=(0.2, 2.0 * side))

    left, right = world(1.0), world(-1.0)
    assert left.pan > 0.1
    assert right.pan == pytest.approx(-left.pan, abs=P.gaze.step + 1e-9)
    assert right.gaze_map == pytest.approx(left.gaze_map[:, ::-1])


@pytest.mark.parametrize("mode", MODES)
def test_deliberate_gazes_and_stops_keep_their_direction_while_the_body_turns(mode, gaze, crowded):
    assert gaze(mode=mode)(crowded(0)).stabilized == (mode not in ("fixed", "triangle"))


def same(one, other):
    """Return whether two values, tuples or arrays have the same content."""
    if hasattr(one, "__slots__") and type(one).__module__.startswith("navigation"):
        names = type(one).__dataclass_fields__
        return all(same(getattr(one, name), getattr(other, name)) for name in names)
    if isinstance(one, tuple):
        return all(same(a, b) for a, b in zip(one, other, strict=True))
    if isinstance(one, np.ndarray):
        return one.tobytes() == other.tobytes()
    return one == other
