import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.vision.scene import CAMERA, Cylinder, at, paint, pose
from vision.blob import find_blobs
from vision.colour import OUTSIDE, ColourTable
from vision.detector import Detector
from vision.outline import trace
from vision.parameters import VisionParameters
from vision.split import Part, split
from vision.view import View

GAZE = pose(tilt=-0.3)


def parts_of(things: list[Cylinder]) -> list[Part]:
    labels = ColourTable().classify(paint(things, GAZE))
    padded = np.pad(labels, 1, constant_values=OUTSIDE)
    view = View(CAMERA, GAZE)
    (blob,) = find_blobs(labels, (20,) * 7)
    (outline,) = trace([blob], padded, view, 0.35)
    return split(
        blob,
        outline,
        padded,
        view=view,
        parameters=VisionParameters(),
        radius=(0.085, 0.02),
    )


@settings(max_examples=40)
@given(
    distance=st.floats(0.4, 2.0),
    bearing=st.floats(-35.0, 35.0),
    radius=st.floats(0.05, 0.12),
    tilt=st.floats(-0.8, -0.2),
)
def test_a_lone_cylinder_is_never_seen_as_two(
    distance: float, bearing: float, radius: float, tilt: float
) -> None:
    gaze = pose(tilt=tilt)
    image = paint([at(distance, bearing, "red", radius)], gaze)
    assert len(Detector(CAMERA, VisionParameters()).detect(image, gaze)) <= 1


@pytest.mark.parametrize("offset", [-4.0, -2.0, 0.0, 2.0, 4.0])
def test_the_nearer_of_two_is_whole_and_the_farther_is_occluded(offset: float) -> None:
    parts = parts_of([at(0.9, 0.0, "red", 0.08), at(1.5, offset, "red", 0.07)])
    assert sorted(part.occluded for part in parts) == [False, True]
