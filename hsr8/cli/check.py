"""``hsr8 check``: settings and world of a scenario, without running it."""

from math import degrees

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from hsr8.cli.command_line import run_command, settings
from hsr8.cli.options import Check
from hsr8.cli.output_file import require_file_name, writing
from hsr8.plugin_file import require_plugins
from hsr8.recorder.files import atomic
from hsr8.render.plan_view import PlanView
from hsr8.render.png import write_png
from hsr8.scenario.command import Command
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.mission import Walk
from hsr8.scenario.schema import Scenario
from hsr8.world.field.certificate import least_clearance, straight_length
from hsr8.world.field.generator import FairWorld, draw_world
from hsr8.world.field.layout import Layout
from hsr8.world.field.motion import pace

Summary = dict[str, object]


def main(options: Check) -> int:
    """Check the settings, draw the world, and show both.

    Raises:
        ScenarioError: the scenario is invalid or its world cannot be drawn.
        UsageError: its planner or gaze cannot be made, or the image cannot be written.
    """
    scenario = load_scenario(options.scenario, settings(options), options.seed)
    require_plugins(scenario.plugin)
    if options.image is not None:
        require_file_name("--image", options.image, (".png",))
    world = draw_world(scenario, scenario.seed)
    if options.image is not None:
        with writing("--image", options.image):
            write_png(options.image, PlanView(world.layout, certificate=world.certificate).draw())
    summary = summarize(scenario, world)
    if options.json:
        print(atomic.dumps(summary))
    else:
        _show(scenario, world.layout, summary)
        print(f"run it: {' '.join(run_command(options, scenario.seed))}")
    return 0


def summarize(scenario: Scenario, world: FairWorld) -> Summary:
    """Return world, mission and certificate as plain values."""
    layout, certificate = world.layout, world.certificate
    clearance = None
    if len(certificate.path) and layout.obstacles:
        clearance = round(least_clearance(layout, certificate.path), 3)
    heading = layout.goal_heading
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
        "goal_heading_deg": None if heading is None else round(degrees(heading), 1),
        "straight_length_m": round(straight_length(layout), 2),
        "certified": certificate.solvable,
        "certified_points": certificate.points_reached,
        "certified_time_s": round(certificate.time, 1),
        "certified_length_m": round(certificate.length, 2),
        "certified_clearance_m": clearance,
        "rejected_worlds": world.rejected,
    }


def _show(scenario: Scenario, layout: Layout, summary: Summary) -> None:
    console = Console(highlight=False)
    width, depth = layout.field_size
    x, y, heading = layout.start
    camera, pushes = scenario.camera, scenario.disturbance.random
    speeds = [pace(o.motion) for o in layout.movers if o.motion]
    speed_range = f", {min(speeds):.3f} to {max(speeds):.3f} m/s" if speeds else ""
    facts = Table(
        title=f"{scenario.name}, seed {scenario.seed}", title_justify="left", show_header=False
    )
    facts.add_row("field", f"{width:g} m x {depth:g} m")
    facts.add_row("static obstacles", str(len(layout.static)))
    facts.add_row("moving obstacles", f"{len(speeds)}{speed_range}")
    facts.add_row("beacons", ", ".join(b.name for b in layout.beacons) or "none")
    facts.add_row("robot", f"{scenario.robot.body} body")
    facts.add_row("start", f"({x:.2f}, {y:.2f}) m, {degrees(heading):.0f} deg")
    facts.add_row("mission", f"{scenario.mission.kind}, {_waypoints(layout)}")
    if isinstance(scenario.mission, Walk):
        facts.add_row("command", _command(scenario.command))
    if pushes is not None:
        low, high = pushes.impulse
        facts.add_row("pushes", f"drawn, {low:g} to {high:g} N s on {pushes.body}")
    if scenario.fault:
        facts.add_row("faults", ", ".join(f"{f.kind} at {f.start:g} s" for f in scenario.fault))
    facts.add_row("certificate", _certificate(summary, layout))
    fov = f"{camera.horizontal_fov_deg:.0f} x {camera.vertical_fov_deg:.0f} deg"
    view = "" if camera.omnidirectional else f" {camera.width} x {camera.height}, {fov},"
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
        low, high = command.random.interval
        return f"drawn every {low:g} to {high:g} s, {command.random.stop_fraction:.0%} stops"
    total = sum(stretch.duration for stretch in command.stretch)
    return f"{len(command.stretch)} stretches, {total:g} s"


def _waypoints(layout: Layout) -> str:
    n, heading = len(layout.waypoints), layout.goal_heading
    if n == 0:
        return "no waypoints"
    if layout.endless:
        return f"{n} via points, repeated"
    goal = "a goal" if heading is None else f"a goal at {degrees(heading):.0f} deg"
    via = "1 via point" if n == 2 else f"{n - 1} via points"
    return f"{via} and {goal}, {straight_length(layout):.1f} m straight"


def _certificate(summary: Summary, layout: Layout) -> str:
    """Describe the path of a point robot that knows the world."""
    points = summary["certified_points"]
    if len(layout.waypoints) == 0:
        return "not needed without waypoints"
    if not summary["certified"]:
        return f"none: no feasible path beyond waypoint {points}, even with full knowledge"
    clearance = summary["certified_clearance_m"]
    room = "" if clearance is None else f", clearance {clearance} m"
    path = f"{summary['certified_time_s']} s, {summary['certified_length_m']} m{room}"
    rejected = f"; {n} worlds rejected before" if (n := summary["rejected_worlds"]) else ""
    return f"{points} waypoints reached with full knowledge in {path}{rejected}"


def _obstacles(layout: Layout) -> Table:
    table = Table(title="obstacles", title_justify="left")
    for name in ("", "x [m]", "y [m]", "radius [m]", "speed [m/s]"):
        table.add_column(escape(name), justify="right")
    table.add_column("color")
    table.add_column("motion")
    for i, o in enumerate(layout.obstacles):
        speed = f"{pace(o.motion):.3f}" if o.motion else ""
        motion = type(o.motion).__name__.lower() if o.motion else ""
        x, y = o.position
        table.add_row(str(i), f"{x:.2f}", f"{y:.2f}", f"{o.radius:.3f}", speed, o.color, motion)
    return table
