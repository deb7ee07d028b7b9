"""Generator of fair worlds: random worlds that satisfy minimum distances and are feasible.

The rules, with distances between surfaces except where a point is named, which are those of a world
of scale 1:

* static obstacles leave gaps of two robot radii plus 0.16 m;
* the start, a point, is 0.35 m from static obstacles and 0.9 m from movers;
* via points and the goal are the robot radius plus 0.25 m from static obstacles;
* lanes of movers keep 0.3 m from static obstacles, so that no mover pins the robot; they keep
  clear of one another and end at least the robot radius plus 0.3 m from the goal;
* a waiting mover on a collision course departs at least 0.9 m from the nominal walk, so that it
  does not start right behind the robot;
* movers that wander or cross the field may cross lanes, but never meet another mover;
* the world has a feasibility certificate; a world without one is rejected and drawn again.
"""

from collections import Counter
from dataclasses import dataclass, replace

from hsr8.errors import ScenarioError
from hsr8.scenario.mission import Course, Tour
from hsr8.scenario.schema import Scenario
from hsr8.scenario.world import TrackMover
from hsr8.seeds import named_rng
from hsr8.world.field.attempt import Attempt, CrowdedError
from hsr8.world.field.certificate import MAX_WORK, Certificate, certify
from hsr8.world.field.layout import Layout, Reactions, with_faults

MAX_WORLDS = 20  # attempts per seed
MAX_LANES = 4000  # lanes tried in crowded worlds per seed


@dataclass(frozen=True, slots=True, eq=False)
class FairWorld:
    """Drawn world with its feasibility certificate.

    Attributes:
        layout: the world.
        certificate: path through the world.
        rejected: earlier attempts without a certificate [1].
        crowded: earlier attempts without room for all objects [1].
    """

    layout: Layout
    certificate: Certificate
    rejected: int
    crowded: int


def draw_layout(scenario: Scenario, seed: int) -> Layout:
    """Return the world of `scenario` for `seed`.

    Raises:
        ScenarioError: the objects do not fit into the field.
    """
    return draw_world(scenario, seed).layout


def draw_world(scenario: Scenario, seed: int) -> FairWorld:
    """Return the world of `draw_layout` with its feasibility certificate.

    A world that is entirely placed by hand is never rejected.

    Raises:
        ScenarioError: the objects do not fit into the field.
    """
    rng = named_rng(seed, "layout")
    crowded: Counter[str] = Counter()
    rejected = lanes = work = 0
    for _ in range(MAX_WORLDS):
        attempt = Attempt(scenario, rng)
        try:
            layout = attempt.layout()
        except CrowdedError as error:
            crowded[str(error)] += 1
            lanes += attempt.tried
            if lanes > MAX_LANES:
                break
            continue
        if scenario.world.crowd != "none":
            # A crowd reacts: no path is certain to be free.
            layout = _completed(layout, scenario, seed)
            points = len(layout.waypoints)
            return FairWorld(layout, Certificate(False, 0, points, 0.0), 0, crowded.total())
        reached = scenario.navigation.mission.r_via
        certificate = certify(layout, scenario.robot, reached, MAX_WORK - work)
        work += certificate.work
        if certificate.solvable or not _draws(scenario):
            layout = with_faults(_completed(layout, scenario, seed), scenario.fault)
            return FairWorld(layout, certificate, rejected, crowded.total())
        rejected += 1
        if work >= MAX_WORK:
            break
    width, depth = scenario.world.size
    attempts = crowded.total() + rejected
    reasons = [f"no room for {objects} {n} times" for objects, n in crowded.most_common()]
    if rejected:
        reasons.append(f"no feasible path {rejected} times")
    raise ScenarioError(
        f"scenario {scenario.name!r}, seed {seed}: no fair world in {attempts} attempts in a field "
        f"of {width:g} m x {depth:g} m, got {', '.join(reasons)}; expected a larger world.size or "
        "smaller world.n_static, world.n_moving or world.radius"
    )


def _completed(layout: Layout, scenario: Scenario, seed: int) -> Layout:
    """Return a layout with drawn heights, whose movers react; the seed draws which of them yield.

    Places, sizes and motions are those of a world of one height without reactions.
    """
    low, high = layout.sizes.obstacle_height
    if low < high:
        heights = named_rng(seed, "height").uniform(low, high, len(layout.obstacles)).tolist()
        obstacles = zip(layout.obstacles, heights, strict=True)
        layout = replace(layout, obstacles=tuple(replace(o, height=h) for o, h in obstacles))
    rng, fraction = named_rng(seed, "yield"), scenario.world.yield_fraction
    reactions = Reactions(
        crowd=scenario.world.crowd != "none",
        sees_robot=scenario.world.crowd_sees_robot,
        robot_radius=scenario.robot.radius,
        time_scale=scenario.time_scale,
    )
    reacting = (
        *layout.static,
        *(replace(m, yields=bool(rng.random() < fraction)) for m in layout.movers),
    )
    return replace(layout, obstacles=reacting, reactions=reactions)


def _draws(scenario: Scenario) -> bool:
    """Return whether another attempt gives another world."""
    world = scenario.world
    drawn = world.n_static + world.n_moving + world.encounters.n + world.circle.n
    part = any(isinstance(m, TrackMover) and m.latest_start is not None for m in world.mover)
    return drawn > 0 or part or isinstance(scenario.mission, Course | Tour)
