"""Score of vision: detections are matched, missed, false, or beyond their covariance."""

import numpy as np
import pytest
from vision_score import Study
from vision_truth import Sight, Target

from vision.detection import Detection


def sight(distance=1.0, bearing=0.2, label="red", hidden=0.0):
    target = Target(
        "obstacle",
        label,
        distance * np.cos(bearing),
        distance * np.sin(bearing),
        radius=0.08,
        height=0.3,
        geoms=(0,),
    )
    return Sight(target, distance, bearing, hidden, cut=False)


def detection(distance=1.0, bearing=0.2, label="red", sigma=(0.003, 0.001)):
    return Detection(
        kind="obstacle",
        label=label,
        bearing=bearing,
        distance=distance,
        covariance=np.diag(np.square(sigma)),
        radius=0.08,
        radius_sigma=0.002,
        by_radius=np.zeros(2),
        cut=False,
        occluded=False,
        box=(0, 0, 10, 10),
    )


@pytest.mark.parametrize(
    ("detections", "mistake"),
    [
        ((detection(),), None),
        ((), "missed red"),
        ((detection(distance=1.02),), "NEES 44"),
        ((detection(), detection(distance=2.0, label="blue")), "false blue"),
        ((detection(), detection(bearing=0.21)), "false red"),
    ],
)
def test_mistakes_of_a_frame(detections, mistake):
    mistakes = Study().judge(detections, [sight()])
    assert len(mistakes) == (mistake is not None)
    assert not mistakes or mistake in mistakes[0]


def test_recall_and_consistency_of_many_frames(capsys):
    rng, study = np.random.default_rng(0), Study()
    for _ in range(400):
        distance, bearing = 1.0 + 0.003 * rng.normal(), 0.2 + 0.001 * rng.normal()
        seen = rng.random() < 0.9
        study.judge((detection(distance, bearing),) if seen else (), [sight()])
    assert study.visible == {"clear obstacle": 400}
    assert study.detected["clear obstacle"] == pytest.approx(360, abs=20)
    nees = np.array(study.errors["clean obstacles"])[:, -1]
    assert nees.mean() / 2 == pytest.approx(1.0, abs=0.15)
    study.report()
    assert "precision 100.00 %" in capsys.readouterr().out
