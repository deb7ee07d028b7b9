from math import cos, pi, sin

import numpy as np
import pytest

from navigation.angles import wrap
from navigation.belief.map_relocalization import MapRelocalization
from navigation.parameters.belief import RelocalizationParameters

LABELS = ["red", "green", "red", "blue", "green", "red"]
PLACES = np.array([(1.5, 0.2), (0.9, 1.3), (-0.4, 1.6), (-1.4, 0.3), (-0.7, -1.2), (0.8, -1.0)])


def recognise(observe, frame, pose, indices, *, labels=LABELS, positions=PLACES, **parameters):
    relocalization = MapRelocalization(RelocalizationParameters(**parameters), 6.0)
    observed = frame(
        1.0, (4, 5, 6), [observe(pose, PLACES[i].tolist(), label=LABELS[i]) for i in indices]
    )
    relocalization.remember(observed.observations, observed)
    return relocalization.locate(observed, labels, positions)


@pytest.mark.parametrize("seed", range(3))
def test_four_landmarks_determine_the_pose(observe, frame, seed):
    rng = np.random.default_rng(seed)
    pose = np.array([*rng.uniform(-1, 1, 2), rng.uniform(-pi, pi)])
    result = recognise(observe, frame, pose.tolist(), rng.permutation(6)[:4].tolist())
    assert np.allclose(result[:2], pose[:2], atol=1e-6)
    assert wrap(float(result[2] - pose[2])) == pytest.approx(0.0, abs=1e-6)


def test_two_are_too_few(observe, frame):
    assert recognise(observe, frame, (0, 0, 0), [0, 1]) is None
    assert (
        recognise(observe, frame, (0, 0, 0), range(6), labels=[], positions=np.empty((0, 2)))
        is None
    )


def test_an_unmapped_constellation_is_not_matched(observe, frame):
    assert recognise(observe, frame, (0, 0, 0), range(4), positions=1.4 * PLACES) is None


def test_the_place_may_have_changed_by_as_much_as_is_tolerated(observe, frame):
    changed = PLACES + 0.04 * np.array([(1, 0), (-1, 0), (0, 1), (0, -1), (1, 0), (0, 1)])
    for tolerance, known in ((0.06, True), (0.02, False)):
        result = recognise(
            observe, frame, (0, 0, 0), range(6), positions=changed, match_distance=tolerance
        )
        assert (result is not None) == known


def test_an_ambiguous_constellation_is_rejected(observe, frame):
    angle = 2.0
    turn = np.array([[cos(angle), sin(angle)], [-sin(angle), cos(angle)]])
    twice = np.concatenate([PLACES, PLACES @ turn + (6.0, 1.0)])
    assert recognise(observe, frame, (0, 0, 0), range(4)) is not None
    assert (
        recognise(observe, frame, (0, 0, 0), range(4), labels=2 * LABELS, positions=twice) is None
    )
