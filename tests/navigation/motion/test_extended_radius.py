import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.belief.tracks import Tracks
from navigation.motion.univector import extended_radius, physical_radius
from navigation.parameters.motion import UnivectorParameters

P = UnivectorParameters()


def radius(track, velocity=(0.0, 0.0), motion=None, psi_sf=0.0, psi_ob=0.0):
    o = Tracks.of([track((1, 0), velocity, motion)])
    return float(extended_radius(o, psi_sf, np.array([psi_ob]), P)[0])


def test_a_still_certain_obstacle_has_the_sum_of_the_radii(track):
    assert radius(track) == pytest.approx(P.s_robot + P.margin + 0.08)
    o = Tracks.of([track((1, 0))])
    assert physical_radius(o, P) == pytest.approx([P.s_robot + 0.08])


def test_it_grows_with_speed_and_with_each_uncertainty(track):
    base = radius(track)
    assert radius(track, (0.1, 0.0)) == pytest.approx(base + 0.1 * P.eta_vo)
    assert radius(track, psi_sf=0.4) == pytest.approx(base + 0.4 * P.eta_imp)
    assert radius(track, psi_ob=0.6) == pytest.approx(base + 0.6 * P.eta_imp)


def test_a_track_called_static_does_not_grow_with_its_noise(track):
    assert radius(track, (0.1, 0.0), Motion.STATIC) == radius(track)
