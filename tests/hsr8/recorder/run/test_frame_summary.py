import json
from dataclasses import replace
from math import inf, isnan, nan

import numpy as np
import pytest

from hsr8.recorder.run.frame_summary import from_line, to_line


@pytest.fixture
def line(fake):
    frame = fake.frame(0.6, (0.1, 0.2, 0.3), index=2)
    return to_line(frame, fake.record(0.6, (0.11, 0.2, 0.3)).truth)


def test_a_round_trip_preserves_the_belief(line):
    frame = from_line(line)
    assert frame.time == 0.6
    assert frame.pose == (0.1, 0.2, 0.3)
    assert frame.truth == (0.11, 0.2, 0.3)
    assert frame.covariance == (1e-4, 0.0, 1e-4)
    assert frame.passed == 2
    assert frame.psi == (0.2, 0.4, 0.6, 0.1)
    assert frame.virtual_obstacles == ((1.0, 0.2, 0.2),)
    assert [t.motion for t in frame.tracks] == ["static", "static", "moving"]
    assert [t.visible for t in frame.tracks] == [True, False, False]
    assert frame.tracks[2].velocity == (0.0, 0.1)
    assert frame.tracks[0].covariance == (4e-4, 0.0, 1e-4)


def test_a_round_trip_preserves_detections_and_gaze(line):
    frame = from_line(line)
    assert frame.captured == 0.6
    assert frame.look == (0.3, -0.3)
    assert [(b.label, b.box, b.distance) for b in frame.boxes] == [
        ("red", (100, 80, 140, 160), 1.0)
    ]
    image = frame.gaze_map.image()
    assert image.shape == (17, 37)
    # Rows 4 to 8 from below and columns 10 to 19 from the right are wanted most.
    assert (image[8:13, 17:27] == 255).all()
    assert int((image > 0).sum()) == 50


def test_numbers_of_tracks_are_rounded_and_may_be_infinite(fake):
    frame = fake.frame(0.6, (0.1, 0.2, 0.3))
    track = replace(
        frame.belief.tracks[0],
        label='a "new" colour',
        position=np.array([1.23456, -0.00004]),
        velocity=np.array([nan, -inf]),
        radius=inf,
    )
    decided = replace(frame.decision, belief=replace(frame.belief, tracks=(track,)))
    truth = fake.record(0.6).truth
    (back,) = from_line(to_line(replace(frame, decision=decided), truth)).tracks
    assert back.label == 'a "new" colour'
    assert back.position == (1.2346, 0.0)
    assert isnan(back.velocity[0])
    assert (back.velocity[1], back.radius) == (-inf, inf)


def test_only_new_gaze_maps_are_written(line, fake):
    frame = fake.frame(0.66, (0.1, 0.2, 0.3))
    same = to_line(frame, fake.record(0.66, (0.1, 0.2, 0.3)).truth, new_map=False)
    assert len(same) < len(line) - 20
    before = from_line(line)
    assert from_line(same, before).gaze_map == before.gaze_map
    assert from_line(same).gaze_map is None


@pytest.mark.parametrize("damage", [[2, 2, "00"], [17, 37, "c-"], [1, 2], "map"])
def test_a_damaged_gaze_map_is_a_damaged_line(line, damage):
    with pytest.raises((ValueError, TypeError)):
        from_line(json.dumps(json.loads(line) | {"gm": damage}))


def test_a_line_is_one_line_and_short(line):
    assert "\n" not in line
    assert len(line) < 1000
