import pytest

from navigation.parameters.navigation import NavigationParameters

EXTENDED, PAPER = NavigationParameters.extended(), NavigationParameters.paper()


def test_the_constants_printed_in_the_paper_are_kept():
    assert (PAPER.evaluation.d_nm, PAPER.evaluation.d_fm) == (0.30, 1.30)
    assert PAPER.evaluation.lambda_cf == 0.85
    assert (PAPER.univector.w_muf, PAPER.univector.w_auf) == (0.75, 0.25)


@pytest.mark.parametrize("p", [EXTENDED, PAPER])
def test_weights_of_the_gaze_map_sum_to_one(p):
    g = p.gaze
    assert g.w_lm + g.w_way + g.w_sf + g.w_ob == pytest.approx(1.0)


def test_the_paper_profile_has_no_additions():
    assert not PAPER.safety_filter.enabled
    assert not PAPER.unseen_ground.enabled
    assert PAPER.gaze.mode == "integrated"
    assert PAPER.moving_obstacles.virtual_obstacle == "printed"
    assert PAPER.univector.blend == "weights"


def test_profiles_agree_in_all_else():
    assert PAPER.mission == EXTENDED.mission
    assert PAPER.velocity_mapping == EXTENDED.velocity_mapping
    assert PAPER.moving_obstacles.xi == EXTENDED.moving_obstacles.xi
