from dataclasses import replace

import numpy as np

from navigation.belief.tracks import Tracks
from navigation.motion.avoid_obstacle import turning_sign
from navigation.motion.passing_side import PassingSides, groups
from navigation.parameters.motion import UnivectorParameters

TARGET = np.array([2.0, 0.0])
P = UnivectorParameters()


def obstacles(track, *places):
    return Tracks.of([track(c, id=i + 1) for i, c in enumerate(places)])


def signs(sides, position, o, s_oe=0.25):
    return sides.signs(np.asarray(position, float), TARGET, o, np.full(len(o), s_oe)).tolist()


def test_alone_and_without_memory_it_is_the_short_way(track):
    rng = np.random.default_rng(0)
    o = obstacles(track, *rng.uniform(-1, 1, (9, 2)))
    for point in rng.uniform(-2, 2, (20, 2)):
        plain = turning_sign(TARGET - o.position, point - o.position).tolist()
        assert signs(PassingSides(P), point, o) == plain
        p_od, p_or = TARGET - o.position, point - o.position
        mirrored = turning_sign(p_od * [1, -1], p_or * [1, -1])
        assert (-mirrored).tolist() == plain


def test_gaps_too_narrow_make_a_group_also_in_a_chain(track):
    o = obstacles(track, (0, 0), (0.35, 0), (0.7, 0), (1.3, 0))
    assert groups(o, 0.24).tolist() == [0, 0, 0, 1]
    assert groups(o, 0.1).tolist() == [0, 1, 2, 3]
    assert len(groups(obstacles(track), 0.24)) == 0


def test_a_group_is_passed_on_one_side(track):
    pair = obstacles(track, (0.0, 0.15), (0.0, -0.2))
    point = (-0.4, 0.0)
    assert signs(PassingSides(P), point, pair) == [1.0, -1.0]
    together = signs(PassingSides(replace(P, grouping=True)), point, pair)
    assert together in ([1.0, 1.0], [-1.0, -1.0])


def test_the_side_is_kept_while_near_and_forgotten_beyond(track):
    o = obstacles(track, (0.0, 0.0))
    sides = PassingSides(replace(P, side_memory=True))
    left = signs(sides, (-0.4, 0.05), o)
    assert signs(sides, (-0.4, -0.05), o) == left
    assert signs(PassingSides(P), (-0.4, -0.05), o) != left
    signs(sides, (-3.0, 0.0), o)
    assert signs(sides, (-0.4, -0.05), o) != left
