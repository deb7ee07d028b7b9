import numpy as np
import pytest

from navigation.gaze.scene import gaze_scene
from navigation.gaze.unseen_ground_vote import unseen_ground_vote
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints

P = NavigationParameters.extended()
SAMPLES = SamplePoints.polar(P.evaluation, P.gaze.max_pan)


@pytest.mark.parametrize("path", [-2.5, -0.4, 0.0, 1.0])
def test_unseen_ground_ahead_votes_within_the_pan_limit(path, belief):
    fresh, unseen = (
        gaze_scene(
            belief(pose=(1.0, 0.5, 0.3), confidence=lambda x, y, c=c: c),
            None, SAMPLES, np.zeros((0, 2)), P,
        )
        for c in (1.0, 0.0)
    )  # fmt: skip
    (vote,) = unseen_ground_vote(unseen, path, 0.8, P)
    assert vote.value.tolist() == [0.8]
    assert vote.pan == pytest.approx(np.clip(path, -P.gaze.max_pan, P.gaze.max_pan))
    middle = 0.5 * (P.unseen_ground.near + P.unseen_ground.far)
    assert unseen.camera_height / -np.tan(vote.tilt) == pytest.approx(middle)
    assert unseen_ground_vote(fresh, path, 0.8, P) == []
