from itertools import permutations

import numpy as np

from compilation.record import record
from navigation.belief.association import assign, distinct
from navigation.belief.tracked_object import ObjectRecord
from navigation.parameters.belief import TrackingParameters


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


def test_nothing_is_paired_at_a_loss():
    assert pairs(np.array([[np.inf, 0.5], [np.inf, np.inf]])) == []
    assert pairs(np.array([[-1.0, np.inf]])) == [(0, 0)]


def test_of_two_overlapping_tracks_of_a_colour_the_one_with_weaker_evidence_goes():
    rng = np.random.default_rng(1)
    p = TrackingParameters()
    objects = np.zeros(12, ObjectRecord)
    objects["weights"] = (1.0, 0.0, 0.0)
    objects["states"][:, 0, :2] = centres = rng.uniform(-0.6, 0.6, (12, 2))
    objects["motion"], objects["radius"] = 0, rng.uniform(0.1, 0.3, 12)
    objects["hits"] = rng.permutation(12) + p.birth_hits
    kept = distinct(objects, 1.0, record(p))
    gap = np.hypot(*(centres[:, None] - centres).transpose(2, 0, 1))
    reach = p.merge_fraction * (objects["radius"][:, None] + objects["radius"])
    overlapping = (gap < reach) & ~np.eye(12, dtype=bool)
    assert 2 < kept.sum() < 10
    assert not overlapping[np.ix_(kept, kept)].any()
    for k in np.flatnonzero(~kept):
        assert (overlapping[k] & (objects["hits"] > objects["hits"][k])).any()
    for change in ({"last_time": 1.0}, {"lost": True}, {"label": np.arange(12)}):
        others = objects.copy()
        for name, value in change.items():
            others[name] = value
        assert distinct(others, 1.0, record(p)).all()
