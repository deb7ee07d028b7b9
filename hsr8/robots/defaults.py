"""Defaults of a scenario that follow from its robot."""

from dataclasses import asdict
from math import pi
from typing import Any

from hsr8.robots.loaded import LoadedRobot, load_robot
from hsr8.robots.scale import DEFAULT_ROBOT, RobotDefaults, RobotScale
from walking.dimension import HSR_VIII

SPEED = {"vx": 0.20, "vx_backward": 0.10, "vy": 0.08, "wz": 0.8}
"""Speed limits of HSR-VIII in navigation [m/s, rad/s]."""
ACCELERATION = 0.3
"""Acceleration of HSR-VIII in navigation [m/s²]."""
USED = 0.9  # fraction of the speed envelope for navigation [1]
FIXED_PAN = 0.01  # smallest range of the gaze that its map admits [rad]
BODY_PAN = 1.0  # turn of a body with a fixed camera from its course [rad]
HEAD_RANGE = 0.02  # of pan and tilt that the gaze leaves free at both ends [rad]


def defaults_of(model: str) -> RobotDefaults:
    """Return the defaults of a robot by name or file.

    Raises:
        ModelError: the robot cannot be loaded.
    """
    if model == DEFAULT_ROBOT:
        return RobotDefaults()
    robot = load_robot(model)
    speed = {**navigation_speed(robot), "acceleration": _acceleration(robot)}
    measures = robot.model.measures()
    scale = RobotScale(
        length=measures.leg / HSR_VIII.leg,
        speed=speed["vx"] / SPEED["vx"],
        turn=speed["wz"] / SPEED["wz"],
        weight=measures.weight / HSR_VIII.weight,
    )
    table: dict[str, Any] = {
        "robot": {"radius": robot.radius, "speed": speed},
        "walking": _walking(robot),
        "navigation": {"gaze": _gaze(robot)},
    }
    calibration = robot.description.calibration
    if calibration is not None:
        pose = ("tilt_sigma", "roll_sigma", "yaw_sigma", "height_sigma")
        table["vision"] = {"pose": {key: getattr(calibration, key) for key in pose}}
    if robot.fov_deg is not None:
        table["camera"] = {"vertical_fov_deg": robot.fov_deg}
    return RobotDefaults(scale, table)


def navigation_speed(robot: LoadedRobot) -> dict[str, float]:
    """Return the speed limits of navigation: similar to HSR-VIII, within the robot's envelope."""
    calibration = robot.description.calibration
    envelope = robot.parameters.limits if calibration is None else calibration.speed
    similar = _similar_speed(robot)
    return {k: _rounded(min(v, USED * getattr(envelope, k))) for k, v in similar.items()}


def _similar_speed(robot: LoadedRobot) -> dict[str, float]:
    measures = robot.model.measures()
    length, time = measures.leg / HSR_VIII.leg, measures.time / HSR_VIII.time
    return {k: v / time if k == "wz" else v * length / time for k, v in SPEED.items()}


def _acceleration(robot: LoadedRobot) -> float:
    """Return the acceleration of navigation [m/s²]."""
    measures, calibration = robot.model.measures(), robot.description.calibration
    envelope = robot.parameters.limits if calibration is None else calibration.speed
    length, time = measures.leg / HSR_VIII.leg, measures.time / HSR_VIII.time
    similar = _similar_speed(robot)["vx"]
    fraction = min(similar, USED * envelope.vx) / similar
    return _rounded(ACCELERATION * length / time**2 * fraction)


def _walking(robot: LoadedRobot) -> dict[str, Any]:
    """Return the parameters of walking, with the noise of odometry that is measured."""
    table, calibration = asdict(robot.parameters), robot.description.calibration
    if calibration is not None:
        table["odometry"] |= {
            "forward_noise": calibration.forward_noise,
            "lateral_noise": calibration.lateral_noise,
        }
    return table


def _gaze(robot: LoadedRobot) -> dict[str, Any]:
    """Return the limits of the gaze: those of the head, or the direction of a fixed camera."""
    (low_pan, high_pan), (low_tilt, high_tilt) = robot.model.neck.range().tolist()
    if robot.model.tree.head is None:
        return {
            "moved_by": "body",
            "fixed_tilt": low_tilt,
            "max_pan": BODY_PAN,
            "min_tilt": min(low_tilt, -FIXED_PAN),
            "max_tilt": max(high_tilt, 0.0),
        }
    usual = 0.5 * pi, -pi / 3.0, pi / 9.0
    pan = min(usual[0], max(FIXED_PAN, min(-low_pan, high_pan) - HEAD_RANGE))
    return {
        "max_pan": pan,
        "min_tilt": max(usual[1], min(-FIXED_PAN, low_tilt + HEAD_RANGE)),
        "max_tilt": min(usual[2], max(0.0, high_tilt - HEAD_RANGE)),
    }


def _rounded(value: float) -> float:
    """Return a number with three digits, as people state limits."""
    return float(f"{value:.3g}")
