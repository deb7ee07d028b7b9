import tomllib

import pytest

from hsr8.robots.file.description import Calibration, checked
from hsr8.robots.file.description_file import moved, with_calibration

BARE = 'model = "a.xml"\nfeet = ["l", "r"]'
TEXTS = [
    BARE,
    BARE + "\n\n[posture] # arms\nelbow = 1.0 # bent\n",
    BARE + "\n\n# the end\n",
    BARE + "\ncalibration = { lag = 0.5, speed = { vx = 1.0 } }\n",
    'calibration.lag = 0.5\ncalibration.speed.vx = 1.0\nmodel = "a.xml"\nfeet = ["l", "r"]\n',
    BARE + "\n[calibration] # mine\nlag = 0.5 # s\n[calibration.speed]\nvx = 1.0 # m/s\n\n"
    "[posture]\nelbow = 1.0\n",
]
CALIBRATION = Calibration.model_validate(
    {"date": "2026-01-02", "version": "0.1.0", "command": "hsr8 robot calibrate a"}
    | {"speed": {"vx": 0.2, "vx_backward": 0.1, "vy": 0.05, "wz": 0.8}}
    | dict.fromkeys(("turn_delay", "lag", "forward_noise", "lateral_noise"), 0.01)
    | dict.fromkeys(("tilt_sigma", "roll_sigma", "yaw_sigma", "height_sigma"), 0.002)
)


@pytest.mark.parametrize("text", TEXTS)
def test_a_calibration_is_written_and_nothing_else_changes(text):
    changed = with_calibration(text, CALIBRATION)
    before, after = tomllib.loads(text), tomllib.loads(changed)
    assert checked(after, "robot").calibration == CALIBRATION
    before.pop("calibration", None)
    after.pop("calibration")
    assert after == before
    assert [line for line in text.splitlines() if line.startswith("#")] == [
        line for line in changed.splitlines() if line.startswith("#")
    ]
    for comment in ("# arms", "# bent", "# mine", "# s", "# m/s"):
        assert (comment in changed) == (comment in text)
    assert with_calibration(changed, CALIBRATION) == changed


def test_paths_next_to_a_description_become_absolute_in_another_folder(tmp_path):
    text = (
        'model = "a.xml" # mine\nsrdf = "../none.srdf"\nstate = "stand"\nfeet = ["l", "r"]\n'
        '[packages]\nhere = "."\nelsewhere = "/opt/elsewhere"\n'
    )
    (tmp_path / "a.xml").touch()
    copy = tomllib.loads(moved(text, tmp_path, tmp_path / "other"))
    assert copy["model"] == str(tmp_path / "a.xml")
    assert copy["srdf"] == "../none.srdf"
    assert copy["packages"] == {"here": str(tmp_path), "elsewhere": "/opt/elsewhere"}
    assert moved(text, tmp_path, tmp_path) == text


def test_a_model_that_is_searched_keeps_its_name(tmp_path):
    text = 'model = "robotis_op3/op3.xml"\nfeet = ["l", "r"]\n'
    assert moved(text, tmp_path, tmp_path / "other") == text
