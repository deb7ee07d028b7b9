from itertools import permutations

import numpy as np

from navigation.belief.association import assign


def pairs(costs):
    return list(zip(*(indices.tolist() for indices in assign(costs)), strict=True))


def test_is_the_cheapest_of_all_assignments():
    rng = np.random.default_rng(0)
    for _ in range(100):
        costs = rng.normal(-1.0, 3.0, (4, 4))
        total = costs[assign(costs)].sum()
        gain = np.minimum(costs, 0.0)
        best = min(gain[range(4), list(order)].sum() for order in permutations(range(4)))
        assert np.isclose(total, best)


def test_neighbours_do_not_swap_for_the_sake_of_the_nearest():
    """Greedily taking the nearest pair would leave the other track without a partner."""
    costs = np.array([[-9.0, -8.0], [-8.5, 5.0]])
    assert pairs(costs) == [(0, 1), (1, 0)]


def test_nothing_is_paired_at_a_loss():
    assert pairs(np.array([[np.inf, 0.5], [np.inf, np.inf]])) == []
    assert pairs(np.array([[-1.0, np.inf]])) == [(0, 0)]


def test_nothing_to_pair():
    assert pairs(np.empty((0, 3))) == []
    assert pairs(np.empty((2, 0))) == []
