"""``hsr8 check``: settings and world of a scenario, without running it."""

from math import degrees
from typing import Any

from rich.console import Console

from hsr8.cli import tables
from hsr8.cli.command_line import command_words, option_tables, run_options, settings
from hsr8.cli.options import Check
from hsr8.cli.output_file import require_file_name, writing
from hsr8.files import atomic
from hsr8.files.text import shell_line
from hsr8.plugins.file import inspect_plugins
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.scenario.section import Section
from hsr8.scenario.track import Track
from hsr8.show.image import write_png
from hsr8.show.plan_sheet import plan_sheet
from hsr8.show.plan_view import PlanView
from hsr8.simulation.robot_builder import field_of_view
from hsr8.world.field.certificate import min_clearance, straight_length
from hsr8.world.field.generator import FairWorld, draw_world
from hsr8.world.field.layout import Obstacle
from hsr8.world.field.motion import pace


def main(options: Check) -> int:
    """Check the settings, draw the world, and show both."""
    scenario = load_scenario(
        options.scenario, settings(options), options.seed, options=option_tables(options)
    )
    inspect_plugins(scenario.plugin)
    if options.image is not None:
        require_file_name("--image", options.image, (".png",))
    world = draw_world(scenario, scenario.seed)
    if options.image is not None:
        radius = scenario.robot.radius
        plan = PlanView(world.layout, radius, certificate=world.certificate)
        with writing("--image", options.image):
            write_png(options.image, plan_sheet(plan, f"{scenario.name}, seed {scenario.seed}"))
    summary = summarize(scenario, world)
    if options.json:
        print(atomic.dumps(summary))
    else:
        obstacles = summary.pop("obstacles")
        console = Console(highlight=False)
        console.print(tables.facts(summary))
        if obstacles:
            console.print(tables.rows(obstacles, "obstacles"))
        print(f"run it      {shell_line(command_words(run_options(options, scenario.seed)))}")
    return 0


def summarize(scenario: Scenario, world: FairWorld) -> dict[str, Any]:
    """Return robot, world, mission and feasibility certificate as plain values."""
    layout, certificate, camera = world.layout, world.certificate, scenario.camera
    clearance = None
    if len(certificate.path) and layout.obstacles:
        clearance = round(min_clearance(layout, certificate.path, scenario.robot.radius), 3)
    fov = [round(degrees(angle)) for angle in field_of_view(scenario)]
    x, y, heading = layout.start
    goal_heading, points = layout.goal_heading, layout.waypoints.round(3).tolist()
    has_goal = bool(points) and not layout.endless
    return {
        "name": scenario.name,
        "seed": scenario.seed,
        "duration_s": scenario.duration,
        "body": scenario.robot.body,
        "camera": camera.source,
        "camera_period_s": camera.period_ms / 1000.0,
        "camera_fov_deg": fov,
        "profile": scenario.navigation.profile,
        "mission": scenario.mission.kind,
        "command": _set_values(scenario.command),
        "disturbance": _set_values(scenario.disturbance),
        "fault": [_set_values(fault) for fault in scenario.fault],
        "plugin": scenario.plugin.named,
        "runs_with_trust_only": list(scenario.plugin.untrusted),
        "field_m": list(layout.field_size),
        "start_m": [round(x, 3), round(y, 3)],
        "start_heading_deg": round(degrees(heading), 1),
        "via_points_m": points[: len(points) - has_goal],
        "repeated": layout.endless,
        "goal_m": points[-1] if has_goal else None,
        "goal_heading_deg": None if goal_heading is None else round(degrees(goal_heading), 1),
        "straight_length_m": round(straight_length(layout), 2),
        "certified": certificate.solvable,
        "certified_points": certificate.points_reached,
        "certified_time_s": round(certificate.time, 1),
        "certified_length_m": round(certificate.length, 2),
        "certified_clearance_m": clearance,
        "rejected_worlds": world.rejected,
        "beacons": [b.name for b in layout.beacons],
        "obstacles": [
            {
                "index": i,
                "position_m": None if _absent(o) else [round(v, 3) for v in o.position],
                "radius_m": round(o.radius, 3),
                "color": o.color,
                "motion": type(o.motion).__name__.lower() if o.motion else None,
                "speed_mps": round(pace(o.motion), 3) if o.motion else 0.0,
            }
            for i, o in enumerate(layout.obstacles)
        ],
    }


def _absent(obstacle: Obstacle) -> bool:
    """Return whether a recorded mover is not in the world at the start."""
    return isinstance(obstacle.motion, Track) and not obstacle.motion.present(0.0)


def _set_values(section: Section) -> dict[str, Any]:
    values = section.model_dump(mode="json", exclude_none=True)
    return {key: value for key, value in values.items() if value not in ([], {})}
