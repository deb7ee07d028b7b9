import numpy as np
import pytest

from navigation.belief.tracks import Tracks
from navigation.motion.landmark_obstacles import LandmarkObstacles
from navigation.parameters.motion import LandmarkParameters

PLACES = {"north": (0.0, 2.8), "south": (0.0, -2.8), "east": (2.8, 0.0), "by": (2.2, 0.3)}
RANGE = 0.9
PARAMETERS = LandmarkParameters(attention_range=RANGE)


@pytest.fixture
def landmarks():
    return LandmarkObstacles(PLACES, 0.05, PARAMETERS)


def test_near_ones_are_added_and_nothing_else_is_changed(landmarks, belief, track):
    rng = np.random.default_rng(0)
    counts = set()
    for _ in range(300):
        tracks = [track(point, id=i) for i, point in enumerate(rng.uniform(-2, 2, (3, 2)))]
        before = belief(tracks, rng.uniform(-3, 3, 3))
        after = landmarks.added_to(before)
        near = {
            n
            for n, p in PLACES.items()
            if np.hypot(*(before.pose[:2] - p)) < PARAMETERS.attention_range
        }
        counts.add(len(near))
        if not near:
            assert after is before
            continue
        added, kept = after.tracks[: len(near)], after.tracks[len(near) :]
        assert {t.label for t in added} == near
        assert [t.position.tolist() for t in kept] == [t.position.tolist() for t in tracks]
        assert (after.pose is before.pose, after.time) == (True, before.time)
    assert counts >= {0, 1, 2}


def test_they_are_static_at_their_known_positions(landmarks, belief):
    b = belief(pose=(2.3, 0.1, 1.0))
    added = Tracks.of(landmarks.added_to(b).tracks)
    assert added.position.tolist() == [list(PLACES["east"]), list(PLACES["by"])]
    assert added.static.all()
    assert LandmarkObstacles({}, 0.05, PARAMETERS).added_to(b) is b
    assert np.all(added.radius == 0.05)
    assert np.all(added.sigma < 0.01)


def test_their_ids_are_negative_and_stay_the_same(landmarks, belief):
    def ids(*pose):
        return {t.label: t.id for t in landmarks.added_to(belief(pose=(*pose, 0.0))).tracks}

    met = [ids(*point) for point in PLACES.values()]
    assert len({id for some in met for id in some.values()}) == len(PLACES)
    assert all(id < 0 for some in met for id in some.values())
    assert met[2] == met[3]
