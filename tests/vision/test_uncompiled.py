"""Vision gives the same bits compiled and in plain Python, as used for debugging."""

import hashlib
import os
import subprocess
import sys
from math import radians

import numpy as np

from tests.vision.scene import at, beacon, paint, pose, uncertain
from vision.camera import PinholeCamera
from vision.detector import Detector
from vision.self_mask import BodyPart

CAMERA = PinholeCamera.from_vertical_fov(120, 90, radians(70.0))
ARM = BodyPart(np.array([[0.1, -0.2, 0.3], [0.2, -0.25, 0.25]]), np.array([0.04, 0.04]))


def digest():
    """Return a digest of the detections in three images: whole, merged and cut cylinders."""
    cylinders = [
        at(0.9, -8.0, "red"),
        at(1.2, -2.0, "red"),
        at(0.8, 20.0, "blue"),
        at(0.7, -38.0, "green"),
        *beacon(1.6, 0.5, "cyan", "yellow"),
    ]
    detector, result = Detector(CAMERA, uncertain(0.001), (ARM,)), hashlib.sha256()
    count = 0
    for pan, tilt, roll in ((0.0, -0.45, 0.0), (-0.3, -0.6, 0.05), (0.3, -0.3, -0.03)):
        view = pose(pan, tilt, roll)
        for d in detector.detect(paint(cylinders, view, camera=CAMERA), view):
            count += 1
            for part in (
                d.distance,
                d.bearing,
                d.radius,
                d.radius_sigma,
                d.covariance,
                d.by_radius,
            ):
                result.update(np.asarray(part).tobytes())
            result.update(f"{d.label} {d.cut} {d.occluded} {d.box}".encode())
    return f"{count} detections, {result.hexdigest()}"


def test_plain_python_gives_the_same_bits_as_compiled_code():
    done = subprocess.run(
        [sys.executable, "-m", "tests.vision.test_uncompiled"],
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=False,
        timeout=100,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == digest()
    assert not done.stdout.startswith("0 ")


if __name__ == "__main__":
    print(digest())
