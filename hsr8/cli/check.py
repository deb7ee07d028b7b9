"""``hsr8 check``: what a scenario comes to, without running it."""

import json
from math import degrees

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from hsr8.cli.command_line import run_command, settings
from hsr8.cli.options import Check
from hsr8.cli.output_file import require_png, writing
from hsr8.plugin_file import require_plugins
from hsr8.render.plan_view import PlanView
from hsr8.render.png import write_png
from hsr8.scenario.command import Command
from hsr8.scenario.disturbance import RandomPushes
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.mission import Walk
from hsr8.scenario.schema import Scenario
from hsr8.world.field.certificate import Certificate, least_clearance, straight_length
from hsr8.world.field.generator import FairWorld, draw_world
from hsr8.world.field.layout import Layout
from hsr8.world.field.motion import pace

Summary = dict[str, object]


def main(options: Check) -> int:
    """Read a scenario, draw its world, and tell what it will be like.

    Raises:
        ScenarioError: the scenario is wrong or its world cannot be drawn.
        UsageError: a planner or a gaze that it names cannot be made, or the picture not written.
    """
    scenario = load_scenario(options.scenario, settings(options), options.seed)
    require_plugins(scenario.plugin)
    if options.image is not None:
        require_png("--image", options.image)
    world = draw_world(scenario, scenario.seed)
    layout = world.layout
    if options.image is not None:
        with writing("--image", options.image):
            write_png(options.image, PlanView(layout, certificate=world.certificate).draw())
    summary = summarize(scenario, world)
    if options.json:
        print(json.dumps(summary))
    else:
        _show(scenario, layout, summary)
        command = " ".join(run_command(options, scenario.seed))
        print(f"run it: {command}")
    return 0


def summarize(scenario: Scenario, world: FairWorld) -> Summary:
    """World, mission and cost of a scenario as plain values."""
    layout, certificate = world.layout, world.certificate
    clearance = _least_clearance(layout, certificate)
    return {
        "name": scenario.name,
        "seed": scenario.seed,
        "duration": scenario.duration,
        "field": list(layout.field_size),
        "start": [round(v, 3) for v in layout.start],
        "obstacles": [
            {
                "index": i,
                "moves": o.motion is not None,
                "position": [round(v, 3) for v in o.position],
                "radius": round(o.radius, 3),
                "color": o.color,
                "speed": round(pace(o.motion), 3) if o.motion else 0.0,
            }
            for i, o in enumerate(layout.obstacles)
        ],
        "beacons": [b.name for b in layout.beacons],
        "waypoints": layout.waypoints.round(3).tolist(),
        "goal_heading_deg": None
        if layout.goal_heading is None
        else round(degrees(layout.goal_heading), 1),
        "straight_length_m": round(straight_length(layout), 2),
        "certified": certificate.solvable,
        "certified_points": certificate.points_reached,
        "certified_time_s": round(certificate.time, 1),
        "certified_length_m": round(certificate.length, 2),
        "certified_clearance_m": None if clearance is None else round(clearance, 3),
        "rejected_worlds": world.rejected,
    }


def _show(scenario: Scenario, layout: Layout, summary: Summary) -> None:
    console = Console(highlight=False)
    width, depth = layout.field_size
    x, y, heading = layout.start
    camera, mission = scenario.camera, scenario.mission
    speeds = [pace(o.motion) for o in layout.movers if o.motion]
    facts = Table(
        title=f"{scenario.name}, seed {scenario.seed}", title_justify="left", show_header=False
    )
    facts.add_row("field", f"{width:g} m x {depth:g} m")
    facts.add_row("static obstacles", str(len(layout.static)))
    moving = str(len(speeds))
    if speeds:
        moving += f", {min(speeds):.3f} to {max(speeds):.3f} m/s"
    facts.add_row("moving obstacles", moving)
    facts.add_row("beacons", ", ".join(b.name for b in layout.beacons) or "none")
    facts.add_row("robot", f"{scenario.robot.body} body")
    facts.add_row("start", f"({x:.2f}, {y:.2f}) m, {degrees(heading):.0f} deg")
    facts.add_row("mission", f"{mission.kind}, {_points(layout)}")
    if isinstance(mission, Walk):
        facts.add_row("command", _command(scenario.command))
    if scenario.disturbance.random is not None:
        facts.add_row("pushes", _pushes(scenario.disturbance.random))
    if scenario.fault:
        facts.add_row("faults", ", ".join(f"{f.kind} at {f.start:g} s" for f in scenario.fault))
    facts.add_row("certificate", _certificate(summary, layout))
    wide, high = camera.horizontal_fov_deg, camera.vertical_fov_deg
    view = (
        ""
        if camera.omnidirectional
        else f" {camera.width} x {camera.height}, {wide:.0f} x {high:.0f} deg,"
    )
    facts.add_row("camera", f"{camera.source},{view} every {camera.period_ms} ms")
    facts.add_row("profile", scenario.navigation.profile)
    facts.add_row("simulated time", f"at most {scenario.duration:g} s")
    console.print(facts)
    if layout.obstacles:
        console.print(_obstacles(layout))


def _command(command: Command) -> str:
    if command.constant:
        vx, vy, wz = command.vx or 0.0, command.vy or 0.0, command.wz or 0.0
        return f"{vx:g} m/s forward, {vy:g} m/s left, {wz:g} rad/s"
    if command.footstep is not None:
        return f"footsteps of {command.footstep.forward:g} m"
    if command.random is not None:
        least, most = command.random.interval
        return f"drawn every {least:g} to {most:g} s, {command.random.stop_fraction:.0%} stops"
    total = sum(stretch.duration for stretch in command.stretch)
    return f"{len(command.stretch)} stretches, {total:g} s"


def _pushes(drawn: RandomPushes) -> str:
    least, most = drawn.impulse
    return f"drawn, {least:g} to {most:g} N s on {drawn.body}"


def _points(layout: Layout) -> str:
    n = len(layout.waypoints)
    if n == 0:
        return "no way points"
    if layout.endless:
        return f"{n} via points again and again"
    goal = (
        "a goal"
        if layout.goal_heading is None
        else (f"a goal at {degrees(layout.goal_heading):.0f} deg")
    )
    via = "1 via point" if n == 2 else f"{n - 1} via points"
    return f"{via} and {goal}, {straight_length(layout):.1f} m straight"


def _certificate(summary: Summary, layout: Layout) -> str:
    points = summary["certified_points"]
    if len(layout.waypoints) == 0:
        return "nothing to reach"
    if not summary["certified"]:
        return f"no way found, even for a robot that knows all, after {points} points"
    clearance = summary["certified_clearance_m"]
    room = "nothing in its way" if clearance is None else f"{clearance} m clear of everything"
    said = (
        f"a robot that knows all reaches {points} points in {summary['certified_time_s']} s, "
        f"{summary['certified_length_m']} m, {room}"
    )
    rejected = summary["rejected_worlds"]
    return f"{said}; worlds rejected before: {rejected}" if rejected else said


def _least_clearance(layout: Layout, certificate: Certificate) -> float | None:
    """Of the certificate's path [m]; None without a path or without obstacles."""
    if len(certificate.path) == 0 or not layout.obstacles:
        return None
    return least_clearance(layout, certificate.path)


def _obstacles(layout: Layout) -> Table:
    table = Table(title="obstacles", title_justify="left")
    for name in ("", "x [m]", "y [m]", "radius [m]", "speed [m/s]"):
        table.add_column(escape(name), justify="right")
    table.add_column("colour")
    table.add_column("motion")
    for i, o in enumerate(layout.obstacles):
        speed = f"{pace(o.motion):.3f}" if o.motion else ""
        motion = type(o.motion).__name__.lower() if o.motion else ""
        x, y = o.position
        table.add_row(str(i), f"{x:.2f}", f"{y:.2f}", f"{o.radius:.3f}", speed, o.color, motion)
    return table
