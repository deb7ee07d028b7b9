"""Numbers that no run could work with: they would overflow, or take all memory and all time."""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

from hsr8.scenario.problem import Problem
from hsr8.scenario.schema import Scenario
from hsr8.scenario.toml_lines import Path

SECTIONS = ("sensors", "walking", "vision", "belief", "navigation")
LARGEST = 1e6  # of any parameter, in its unit
# Of the robot's speeds [m/s, rad/s, m/s²]; the certificate's search grows with 1/speed.
SLOWEST = 0.05
SMALLEST = 1e-9  # of any that is not zero

# Parameters that time and memory go with, and what a run can still bear.
BOUNDS: dict[Path, tuple[float, float]] = {
    ("walking", "gait", "preview_steps"): (1, 20),
    ("walking", "pattern", "preview_time"): (0.05, 10.0),
    ("walking", "pattern", "lipm_height"): (0.02, 5.0),
    ("walking", "pattern", "pelvis_height"): (0.02, 5.0),
    ("navigation", "evaluation", "d_fm"): (0.01, 50.0),
    ("navigation", "evaluation", "ring_step"): (0.01, 50.0),
    ("navigation", "evaluation", "ray_step"): (0.01, 7.0),
    ("navigation", "gaze", "step"): (0.01, 7.0),
    ("navigation", "gaze", "max_pan"): (0.01, 7.0),
    ("navigation", "gaze", "min_tilt"): (-2.0, 2.0),
    ("navigation", "gaze", "max_tilt"): (0.0, 2.0),
    ("navigation", "gaze", "deadline", "exponent"): (0.0, 10.0),
    ("navigation", "gaze", "deadline", "map_rays"): (2, 360),
    ("navigation", "moving_obstacles", "samples"): (2, 1000),
    ("navigation", "safety_filter", "headings"): (1, 360),
    ("navigation", "safety_filter", "speeds"): (1, 100),
    ("navigation", "safety_filter", "steps"): (0, 100),
    ("navigation", "planner", "dwa", "horizon"): (0.01, 50.0),
    ("navigation", "rear_check", "rays"): (2, 360),
    ("navigation", "waypoint_search", "cell"): (0.01, 10.0),
    ("navigation", "waypoint_search", "reach"): (0.01, 20.0),
    ("navigation", "waypoint_search", "around"): (0.01, 20.0),
}

LONGEST = 10.0  # of the times of a footstep, which is planned tick by tick [s]
TIMES = {
    "gait": (
        *("footstep_time", "min_footstep_time", "start_time", "stop_time", "settle_time"),
        *("min_swing_time", "capture_single", "capture_double"),
    ),
    "limits": ("braking_time", "min_single", "max_single", "max_double"),
}
BOUNDS |= {
    ("walking", part, name): (0.0, LONGEST) for part, names in TIMES.items() for name in names
}


def magnitudes(scenario: Scenario) -> Iterator[Problem]:
    """Every parameter of the libraries that is out of all bounds."""
    for key, value in scenario.robot.speed:
        if value < SLOWEST:
            yield Problem(("robot", "speed", key), f"must be at least {SLOWEST:g}, got {value:g}")
    for name in SECTIONS:
        yield from _within((name,), getattr(scenario, name))


def _within(path: Path, value: Any) -> Iterator[Problem]:
    if is_dataclass(value):
        for field in fields(value):
            yield from _within((*path, field.name), getattr(value, field.name))
        return
    if isinstance(value, tuple):
        for k, part in enumerate(value):
            yield from _within((*path, k), part)
        return
    if not isinstance(value, int | float) or isinstance(value, bool):
        return
    tiny = 0.0 < abs(value) < SMALLEST and path[0] != "sensors"  # a noise may be next to none
    if tiny:
        yield Problem(path, f"{value:g} is too small to mean anything: at least {SMALLEST:g}")
    elif path in BOUNDS:
        low, high = BOUNDS[path]
        if not low <= value <= high:
            yield Problem(path, f"must be from {low:g} to {high:g}, got {value:g}")
    elif abs(value) > LARGEST:
        yield Problem(path, f"{value:g} is out of all bounds: at most {LARGEST:g}")
