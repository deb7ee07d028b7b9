"""Old keys and values of a scenario, and their new names."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from hsr8.scenario.key_lines import Path
from hsr8.scenario.problem import Problem, shown
from hsr8.scenario.public_keys import LIBRARIES, PUBLIC

# Old key -> new key, dotted, without indices of lists; a section covers the keys below it. Sorted.
RENAMED: dict[str, str] = {
    "belief.localization.map": "belief.localization.landmarks",
    "belief.recognition": "belief.relocalization",
    "belief.tracking.top_speed": "belief.tracking.max_speed",
    "camera.lens": "camera.preset",
    "command.random.stops": "command.random.stop_fraction",
    "fault.place": "fault.position",
    "fault.size": "fault.magnitude",
    "navigation.body": "navigation.velocity_mapping",
    "navigation.filter": "navigation.safety_filter",
    "navigation.gate": "navigation.unseen_ground",
    "navigation.gaze.box_share": "navigation.gaze.box_fraction",
    "navigation.gaze.pan_limit": "navigation.gaze.max_pan",
    "navigation.gaze.tilt_max": "navigation.gaze.max_tilt",
    "navigation.gaze.tilt_min": "navigation.gaze.min_tilt",
    "navigation.mover": "navigation.moving_obstacles",
    "navigation.way_search": "navigation.waypoint_search",
    "own": "plugin",
    "robot.speed.backward": "robot.speed.vx_backward",
    "robot.speed.forward": "robot.speed.vx",
    "robot.speed.lateral": "robot.speed.vy",
    "robot.speed.turn": "robot.speed.wz",
    "vision.beacon_range": "vision.max_beacon_range",
    "vision.colour_table": "vision.color_table",
    "vision.obstacle_range": "vision.max_obstacle_range",
    "walking.gait.lift": "walking.gait.swing_height",
    "walking.gait.shortest_time": "walking.gait.min_footstep_time",
    "walking.head.acceleration": "walking.head.max_acceleration",
    "walking.head.rate": "walking.head.max_rate",
    "walking.limits.backward": "walking.limits.vx_backward",
    "walking.limits.forward": "walking.limits.vx",
    "walking.limits.lateral": "walking.limits.vy",
    "walking.limits.turn": "walking.limits.wz",
    "walking.odometry.left_noise": "walking.odometry.lateral_noise",
    "walking.odometry.slip_share": "walking.odometry.slip_ratio",
    "world.moved_beacon": "world.beacon_displacement",
    "world.mover.colour": "world.mover.color",
    "world.obstacle.colour": "world.obstacle.color",
    "world.row": "world.wall",
}

# Key -> old value -> new value.
RENAMED_VALUES: dict[str, dict[str, str]] = {
    "belief.localization.landmarks": {"beacons": "known", "none": "mapped"},
    "camera.source": {"all-round": "omnidirectional", "egl": "rendered"},
    "navigation.evaluation.map_ratio": {"share": "fraction"},
    "navigation.moving_obstacles.virtual_obstacle": {"own": "uncapped"},
    "fault.kind": {
        "camera-ghosts": "false-detections",
        "camera-late": "camera-latency",
        "camera-light": "lighting",
        "camera-misses": "missed-detections",
        "foot-dead": "foot-sensor-dropout",
        "imu-tilt": "attitude-bias",
        "imu-turn": "gyro-bias",
        "servo-late": "servo-delay",
        "slippery": "low-friction",
    },
}


def renamed(data: Any, path: Path = ()) -> Iterator[Problem]:
    """Yield the old keys and values in the tables of a scenario.

    Args:
        data: value at `path`.
        path: keys and indices of `data`.
    """
    old = ".".join(str(part) for part in path if isinstance(part, str))
    old = old.removeprefix("constants.")
    if isinstance(data, Mapping):
        for key, value in data.items():
            yield from renamed(value, (*path, key))
    elif new := _new_key(old):
        if new.partition(".")[0] in LIBRARIES and new not in PUBLIC:
            section = new.rpartition(".")[0]
            new = f"{section}; expected one of its keys, or a constant of constants.{section}"
        yield Problem(path, f"renamed to {new}")
    elif isinstance(data, str) and data in (values := RENAMED_VALUES.get(old, {})):
        yield Problem(path, f'{shown(data)} is renamed to "{values[data]}"')
    elif isinstance(data, Sequence) and not isinstance(data, str):
        for k, value in enumerate(data):
            yield from renamed(value, (*path, k))


def _new_key(old: str) -> str:
    """New key of an old one; empty if it is not renamed."""
    section, rest = old, ""
    while section:
        if section in RENAMED:
            return RENAMED[section] + rest
        section, dot, key = section.rpartition(".")
        rest = f"{dot}{key}{rest}"
    return ""
