import numpy as np
import pytest

from navigation.motion.landmark_obstacles import LandmarkObstacles
from navigation.parameters.motion import LandmarkParameters

PLACES = {"north": (0.0, 2.8), "south": (0.0, -2.8), "east": (2.8, 0.0), "by": (2.2, 0.3)}
PARAMETERS = LandmarkParameters(attention_range=0.9)


@pytest.fixture
def landmarks():
    return LandmarkObstacles(PLACES, 0.05, PARAMETERS)


def test_they_are_those_in_range(landmarks):
    counts = set()
    for position in np.random.default_rng(0).uniform(-3, 3, (300, 2)):
        expected = {
            n for n, p in PLACES.items() if np.hypot(*(position - p)) < PARAMETERS.attention_range
        }
        assert {t.label for t in landmarks.near(position)} == expected
        counts.add(len(expected))
    assert counts >= {0, 1, 2}


def test_their_ids_are_negative_and_stay_the_same(landmarks):
    def ids(point):
        return {t.label: t.id for t in landmarks.near(np.array(point))}

    met = [ids(point) for point in PLACES.values()]
    assert len({id for some in met for id in some.values()}) == len(PLACES)
    assert all(id < 0 for some in met for id in some.values())
    assert met[2] == met[3]
