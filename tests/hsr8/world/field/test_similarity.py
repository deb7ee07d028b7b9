"""Worlds of another robot are those of HSR-VIII at another scale."""

from dataclasses import fields, is_dataclass
from functools import cache
from math import isclose

import numpy as np
import pytest

from hsr8.robots.scale import RobotDefaults, RobotScale
from hsr8.scenario import loader
from hsr8.scenario.layers import built_in_names
from hsr8.scenario.loader import load_scenario
from hsr8.world.field.certificate import min_clearance
from hsr8.world.field.generator import draw_world

FAST = {"walking": {"limits": dict.fromkeys(("vx", "vx_backward", "vy", "wz"), 9.0)}}
LENGTHS = {
    *("position", "radius", "height", "start", "end", "centre", "track", "side", "offset", "away"),
    *("field_size", "waypoints", "known", "points", "robot_radius"),
    *("obstacle_height", "obstacle_radius", "beacon_height", "beacon_radius"),
}
TIMES = {"time_scale", "depart", "times", "begin", "linger", "first", "period"}
SPEEDS = {"speed", "rate", "rates"}


@pytest.fixture
def scale_of(monkeypatch):
    """Let the robot "big" have a ratio of lengths and one of speeds."""

    def scale(length, speed):
        scale = RobotScale(length, speed, speed / length)
        monkeypatch.setattr(loader, "robot_defaults", lambda _: RobotDefaults(scale, FAST))
        return scale

    return scale


@cache
def default_world(name, seed):
    return draw_world(load_scenario(name), seed)


def assert_similar(big, small, scale, ratio=1.0):
    """All lengths, speeds and times of a part of a world have the ratios of the robots."""
    if is_dataclass(small):
        assert type(big) is type(small)
        for name in (field.name for field in fields(small)):
            kind = {"start": 0.0} if hasattr(small, "bumps") else {}  # x, y and heading
            by_name = dict.fromkeys(LENGTHS, scale.length) | dict.fromkeys(TIMES, scale.time)
            by_name |= dict.fromkeys(SPEEDS, scale.speed) | {"scale": scale.length} | kind
            ratio = by_name.get(name, 1.0)
            if ratio:
                assert_similar(getattr(big, name), getattr(small, name), scale, ratio)
    elif isinstance(small, tuple):
        assert len(big) == len(small)
        for one, other in zip(big, small, strict=True):
            assert_similar(one, other, scale, ratio)
    elif isinstance(small, float):
        assert isclose(big, ratio * small, rel_tol=1e-9, abs_tol=1e-9)
    elif isinstance(small, np.ndarray):
        np.testing.assert_allclose(big, ratio * small, rtol=1e-9, atol=1e-9)
    else:
        assert big == small


@pytest.mark.parametrize(
    ("length", "speed", "name"),
    [
        *((0.5, 0.25, name) for name in built_in_names()),
        *((2.9, 1.7, name) for name in ("course", "crowd", "behind", "corridor")),
    ],
)
def test_the_world_of_another_robot_is_similar(name, length, speed, scale_of):
    scale = scale_of(length, speed)
    big = load_scenario(name, ["robot.model=big"])
    one, other = draw_world(big, 1000), default_world(name, 1000)
    assert_similar(one.layout, other.layout, scale)
    x, y, heading = other.layout.start
    expected = (scale.length * x, scale.length * y, heading)
    assert one.layout.start == pytest.approx(expected)
    assert (one.rejected, one.crowded) == (other.rejected, other.crowded)
    assert one.certificate.solvable == other.certificate.solvable
    if scale.length == 2.9:  # inexact: a disc that just fits into a gap may fit or not
        return
    assert one.certificate.time == pytest.approx(scale.time * other.certificate.time)
    units = (scale.time, scale.length, scale.length, 1.0)
    np.testing.assert_allclose(
        one.certificate.path, other.certificate.path * units, rtol=1e-9, atol=1e-9
    )


def test_clearances_are_similar(scale_of):
    scale = scale_of(0.5, 0.25)
    small, big = load_scenario("course"), load_scenario("course", ["robot.model=big"])
    gaps = [
        min_clearance(world.layout, world.certificate.path, scenario.robot.radius)
        for scenario in (big, small)
        for world in [draw_world(scenario, 1000)]
    ]
    assert gaps[0] == pytest.approx(scale.length * gaps[1], abs=0.01)
