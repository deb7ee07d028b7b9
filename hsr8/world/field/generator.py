"""Draws fair worlds: nothing is impossible from the start, and chance alone decides the rest.

The rules, with distances between surfaces unless a point is named:

* static obstacles leave gaps of two robot radii and 0.16 m;
* the start is a point 0.35 m from static obstacles and 0.9 m from movers;
* via points and the goal are robot radius and 0.25 m from static obstacles;
* lanes of movers keep 0.3 m from static obstacles, so that none pins the robot, keep
  clear of one another, and turn about robot radius and 0.3 m from the goal at least;
* a mover on a collision course that stands at first sets off 0.9 m at least from where
  the nominal walk is then: nothing that stood still runs at the robot's heels;
* movers that wander or cross the field may cross lanes, but never meet another mover;
* a robot that knows everything gets through: a world without a certificate is rejected,
  and the next one is drawn.
"""

from collections import Counter
from dataclasses import dataclass

from hsr8.errors import ScenarioError
from hsr8.scenario.mission import Course, Tour
from hsr8.scenario.schema import Scenario
from hsr8.seeds import named_rng
from hsr8.world.field.attempt import Attempt, CrowdedError
from hsr8.world.field.certificate import Certificate, certify
from hsr8.world.field.layout import Layout, with_faults

WORLDS = 20  # worlds begun before giving up
LANES = 4000  # lanes of movers tried in crowded worlds before giving up: each takes its time


@dataclass(frozen=True, slots=True, eq=False)
class FairWorld:
    """A world that was drawn, and why it is fair.

    Attributes:
        layout: the world.
        certificate: the way through it.
        rejected: worlds drawn before it that had no way through [1].
        crowded: attempts before it in which something found no place [1].
    """

    layout: Layout
    certificate: Certificate
    rejected: int
    crowded: int


def draw_layout(scenario: Scenario, seed: int) -> Layout:
    """World of `scenario` for `seed`: the same two give the same world.

    Raises:
        ScenarioError: what is asked for does not fit into the field.
    """
    return draw_world(scenario, seed).layout


def draw_world(scenario: Scenario, seed: int) -> FairWorld:
    """The same world as `draw_layout`, with its certificate.

    A world placed by hand in all its parts is never rejected: it is what it is.

    Raises:
        ScenarioError: what is asked for does not fit into the field.
    """
    rng = named_rng(seed, "layout")
    crowded: Counter[str] = Counter()
    rejected = lanes = 0
    for _ in range(WORLDS):
        attempt = Attempt(scenario, rng)
        try:
            layout = attempt.layout()
        except CrowdedError as error:
            crowded[str(error)] += 1
            lanes += attempt.tried
            if lanes > LANES:
                break
            continue
        certificate = certify(layout, scenario.robot.speed)
        if certificate.solvable or not _draws(scenario):
            faulty = with_faults(layout, scenario.fault)
            return FairWorld(faulty, certificate, rejected, crowded.total())
        rejected += 1
    width, depth = scenario.world.size
    attempts = crowded.total() + rejected
    reasons = [f"for want of room for {thing} {n} times" for thing, n in crowded.most_common()]
    if rejected:
        reasons.append(f"for want of a way through it {rejected} times")
    raise ScenarioError(
        f"scenario {scenario.name!r}, seed {seed}: no fair world found in {attempts} attempts "
        f"in a field of {width:g} m x {depth:g} m, {', '.join(reasons)}; "
        "make world.size larger or world.n_static, world.n_moving or world.radius smaller"
    )


def _draws(scenario: Scenario) -> bool:
    """Whether another attempt gives another world."""
    world = scenario.world
    drawn = world.n_static + world.n_moving + world.encounters.n
    return drawn > 0 or isinstance(scenario.mission, Course | Tour)
