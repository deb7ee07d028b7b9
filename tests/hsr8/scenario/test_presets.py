from dataclasses import asdict

import pytest

from hsr8.scenario.camera import LENSES
from hsr8.scenario.presets import PROFILES, expand_presets


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


@pytest.mark.parametrize("lens", LENSES)
def test_a_lens_sets_the_field_of_view(lens):
    assert expand_presets({"camera": {"lens": lens}})["camera"]["vertical_fov_deg"] == LENSES[lens]


def test_another_field_of_view_is_a_custom_lens():
    assert expand_presets({"camera": {"vertical_fov_deg": 33.0}})["camera"]["lens"] == "custom"


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"navigation": 3, "camera": "wide"},
        {"navigation": {"profile": "fast"}, "camera": {"lens": 2}},
        {"camera": {"vertical_fov_deg": LENSES["wide"]}},
    ],
)
def test_other_values_stay_for_validation(data):
    assert expand_presets(data) == data
