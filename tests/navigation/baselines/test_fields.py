import numpy as np

from navigation.baselines.fields import PotentialField
from navigation.parameters.planner import ApfParameters

P = ApfParameters()


def desired(planning, *tracks, **details):
    return PotentialField(P).desired(planning(tracks, **details))


def test_an_approaching_mover_repels_more_and_a_leaving_one_does_not(planning, track):
    still, towards, away = (
        desired(planning, track((0.6, 0.02), v)).velocity[0]
        for v in ((0.0, 0.0), (-0.1, 0.0), (0.3, 0.0))
    )
    assert towards < still
    assert away >= still


def test_exactly_head_on_the_robot_swerves_to_one_side_and_does_not_stand(walker, task, track):
    """Attraction and repulsion would cancel on the line without the tangential part."""
    for velocity in ((0.0, 0.0), (-0.1, 0.0)):
        walk, swerved, slow = walker("apf"), 0.0, 0
        for step in range(40):
            x = 1.2 + 0.34 * step * velocity[0]
            walk.step(task((2.2, 0.0)), [track((x, 0.0), velocity)])
            swerved = max(swerved, abs(walk.pose[1]))
            slow = slow + 1 if np.hypot(*walk.body[:2]) < 0.02 else 0
            assert slow < 3
            assert walk.distance((x + 0.34 * velocity[0], 0.0)) > 0.2
            if walk.pose[0] > x + 0.2:
                break
        assert walk.pose[0] > x
        assert swerved > 0.1
