import pytest

from navigation.paper import WEIGHTS
from navigation.parameters.navigation import NavigationParameters

EXTENDED, PAPER = NavigationParameters.extended(), NavigationParameters.paper()


def test_the_constants_printed_in_the_paper_are_kept():
    assert (PAPER.evaluation.d_nm, PAPER.evaluation.d_fm) == (0.30, 1.30)
    assert PAPER.evaluation.lambda_cf == 0.85
    assert WEIGHTS[PAPER.planner.paper.weights] == (0.75, 0.25)


@pytest.mark.parametrize("p", [EXTENDED, PAPER])
def test_weights_of_the_gaze_map_sum_to_one(p):
    g = p.gaze
    assert g.w_lm + g.w_way + g.w_sf + g.w_ob == pytest.approx(1.0)


def test_the_gains_of_the_paper_keep_their_signs():
    """k_beta < 0 < k_alpha in (8); d_e, d_b and K_r are lengths; xi in (0, 1)."""
    p = PAPER.planner.paper
    assert -1.0 < p.k_beta < 0.0
    assert min(p.d_con, p.d_e, p.d_b, p.k_r, p.horizon, p.min_speed) > 0.0
    assert 0.0 < p.xi < 1.0
    assert 0.0 < p.nominal <= 1.0
