from dataclasses import replace

import numpy as np
import pytest

from hsr8.recorder.fingerprints import CHANNELS, DECISIONS, decision_fingerprints, fingerprints


@pytest.mark.parametrize(
    ("change", "channel"),
    [
        ({"pose": np.array([0.0, 0.0, 1e-300])}, "pose"),
        ({"pose_covariance": np.eye(3)}, "pose covariance"),
        ({"tracks": ()}, "tracks"),
        ({"lost": True}, "state"),
    ],
)
def test_a_change_affects_only_its_channel(fake, change, channel):
    before = fake.frame(0.06).estimate
    after = replace(before, **change)
    differ = [
        name
        for name, a, b in zip(CHANNELS, fingerprints(before), fingerprints(after), strict=True)
        if a != b
    ]
    assert differ == [channel]


@pytest.mark.parametrize(
    ("part", "change", "channel"),
    [
        ("task", {"heading": 1e-300}, "task"),
        ("task", {"index": 1}, "task"),
        ("motion", {"situation": "brake"}, "motion"),
        ("motion", {"extended_radii": ()}, "motion"),
        ("motion", {"virtual_obstacles": ()}, "motion"),
        ("gaze", {"pan": -0.0}, "gaze"),
        ("belief", {"lost": True}, "belief at the decision"),
    ],
)
def test_a_change_of_a_decision_affects_only_its_channel(fake, part, change, channel):
    before = fake.frame(0.06).decision
    before = replace(before, gaze=replace(before.gaze, pan=0.0))
    after = replace(before, **{part: replace(getattr(before, part), **change)})
    prints = zip(
        DECISIONS, decision_fingerprints(before), decision_fingerprints(after), strict=True
    )
    assert [name for name, a, b in prints if a != b] == [channel]
