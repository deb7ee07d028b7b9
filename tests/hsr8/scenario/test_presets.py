from dataclasses import asdict

import pytest

from hsr8.scenario.scaling import PROFILES, expand_presets


@pytest.mark.parametrize("profile", PROFILES)
def test_a_profile_sets_all_defaults_and_keeps_given_values(profile):
    given = {"profile": profile, "gaze": {"max_pan": 0.5}}
    navigation = expand_presets({"navigation": given})["navigation"]
    default = asdict(PROFILES[profile]())
    assert navigation == default | {
        "profile": profile,
        "gaze": default["gaze"] | {"max_pan": 0.5},
    }
    assert given == {"profile": profile, "gaze": {"max_pan": 0.5}}


def test_the_ideal_camera_sets_lens_and_neck_and_keeps_given_values():
    given = {"camera": {"preset": "ideal", "blind_above": 2.0}, "walking": {"head": {}}}
    tables = expand_presets(given)
    assert tables["camera"] == {"preset": "ideal", "vertical_fov_deg": 70.0, "blind_above": 2.0}
    assert tables["walking"]["head"] == {"max_rate": 6.0, "max_acceleration": 60.0}


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"navigation": 3, "camera": "wide"},
        {"navigation": {"profile": "fast"}, "camera": {"preset": 2}},
        {"camera": {"preset": "realistic", "vertical_fov_deg": 33.0}},
    ],
)
def test_other_values_stay_for_validation(data):
    assert expand_presets(data) == data
