from dataclasses import asdict

import pytest

from hsr8.scenario.camera import LENSES
from hsr8.scenario.presets import PROFILES, expand_presets


@pytest.mark.parametrize("profile", PROFILES)
def test_a_profile_stands_for_all_its_values(profile):
    navigation = expand_presets({"navigation": {"profile": profile}})["navigation"]
    assert navigation == asdict(PROFILES[profile]()) | {"profile": profile}


def test_what_is_given_stays_however_deep():
    given = {"profile": "paper", "gaze": {"max_pan": 0.5}}
    navigation = expand_presets({"navigation": given})["navigation"]
    default = asdict(PROFILES["paper"]())
    assert navigation["gaze"] == default["gaze"] | {"max_pan": 0.5}
    assert navigation["safety_filter"] == default["safety_filter"]


@pytest.mark.parametrize("lens", LENSES)
def test_a_lens_stands_for_its_field_of_view(lens):
    assert expand_presets({"camera": {"lens": lens}})["camera"]["vertical_fov_deg"] == LENSES[lens]


def test_a_field_of_view_alone_is_a_lens_of_ones_own():
    assert expand_presets({"camera": {"vertical_fov_deg": 33.0}})["camera"]["lens"] == "custom"
    wide = {"camera": {"vertical_fov_deg": LENSES["wide"]}}
    assert expand_presets(wide) == wide


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"navigation": 3, "camera": "wide"},
        {"navigation": {"profile": "fast"}},
        {"navigation": {"profile": 1}},
        {"camera": {"lens": "fisheye"}},
        {"camera": {"lens": 2}},
    ],
)
def test_what_is_wrong_stays_for_the_schema_to_tell(data):
    assert expand_presets(data) == data


def test_the_argument_is_left_alone():
    data = {"navigation": {"profile": "paper", "gaze": {}}, "camera": {"lens": "narrow"}}
    expand_presets(data)
    assert data == {"navigation": {"profile": "paper", "gaze": {}}, "camera": {"lens": "narrow"}}
