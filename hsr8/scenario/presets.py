"""Presets: the navigation profile, the camera, defaults that follow other keys; merged tables."""

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from hsr8.scenario.camera import IDEAL
from navigation.parameters.navigation import NavigationParameters
from vision.parameters import VisionParameters

Table = dict[str, Any]

KINDS = ("kind", "motion")  # keys that determine the other keys of their table
PROFILES = {"extended": NavigationParameters.extended, "paper": NavigationParameters.paper}


def expand_presets(data: Mapping[str, Any]) -> Table:
    """Return a scenario's tables with the values of its profile and camera.

    Given values take precedence. Malformed tables remain, for validation to report them.
    """
    expanded = dict(data)
    navigation, camera = data.get("navigation"), data.get("camera")
    if isinstance(navigation, dict):
        profile = navigation.get("profile")
        if isinstance(profile, str) and profile in PROFILES:
            expanded["navigation"] = under(navigation, asdict(PROFILES[profile]()))
    if isinstance(camera, dict) and camera.get("preset") == "ideal":
        return under(expanded, IDEAL)
    return expanded


def followers(data: Mapping[str, Any]) -> Table:
    """Return the defaults that follow given keys of a scenario's tables.

    Navigation takes the radius of the robot, vision the sizes of the obstacles and the beacons.
    """
    defaults: Table = {}
    radius = _number(data, "robot", "radius")
    if radius is not None:
        defaults["navigation"] = {"univector": {"s_robot": radius}}
    scale = _number(data, "world", "scale")
    if scale is not None:
        vision = VisionParameters()
        sizes = ("obstacle_height", "beacon_height", "beacon_radius")
        defaults["vision"] = {size: scale * getattr(vision, size) for size in sizes}
    return defaults


def _number(data: Mapping[str, Any], section: str, key: str) -> float | None:
    """Value of a key; None without a number."""
    table = data.get(section)
    value = table.get(key) if isinstance(table, dict) else None
    return None if isinstance(value, bool) or not isinstance(value, int | float) else value


def under(given: Table, defaults: Table) -> Table:
    """Return `given` with `defaults` for the keys that are missing, table by table."""
    merged = {**defaults, **given}
    for key, default in defaults.items():
        if isinstance(default, dict) and isinstance(given.get(key), dict):
            merged[key] = under(given[key], default)
    return merged


def merged(base: Table, over: Table) -> Table:
    """Return `over` put over `base`, table by table."""
    # Another kind of mission, fault or mover has other keys: the old ones are dropped.
    changed = any(key in over and over[key] != base.get(key, over[key]) for key in KINDS)
    result = {} if changed else dict(base)
    if over.get("file") != base.get("file") and "file" in over:
        result.pop("data", None)  # of another track file
    for key, value in over.items():
        old = result.get(key)
        if isinstance(value, dict) and isinstance(old, dict):
            result[key] = merged(old, value)
        else:
            result[key] = value
    return result
