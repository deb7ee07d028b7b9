"""Verdict: the criteria of a scenario against the results of a run.

A run meets its criteria if it ends by itself and satisfies every `Criterion` of its scenario. The
metric ``success`` is defined in `hsr8.measure.metrics` and is the same for all scenarios.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from hsr8.errors import INTERRUPTED, SimulationDiverged
from hsr8.scenario.schema import Criteria

ENDED_BY_OTHERS = ("interrupted", "diverged", "running", "failed", "error")
"""Exit reasons of runs that did not end by themselves."""


@dataclass(frozen=True, slots=True)
class Criterion:
    """One criterion and the result of a run.

    Attributes:
        name: quantity that is compared.
        expected: its bound.
        actual: its value in the run.
        met: whether the value satisfies the bound.
    """

    name: str
    expected: str
    actual: str
    met: bool


def evaluate_criteria(criteria: Criteria, results: Mapping[str, Any]) -> tuple[Criterion, ...]:
    """Compare `results`, as returned by `metrics`, with the criteria of a scenario."""
    evaluated = [_at_most("falls", criteria.max_falls, int(results["falls"]))]
    if criteria.max_collisions is not None:
        count = int(results["collisions"])
        evaluated.append(_at_most("collisions", criteria.max_collisions, count))
    if criteria.max_zmp_outside_ticks is not None:
        count = int(results.get("zmp_outside_sole_ticks", 0))
        evaluated.append(
            _at_most("ticks with the ZMP outside", criteria.max_zmp_outside_ticks, count)
        )
    if criteria.goal_reached:
        reached = bool(results["goal_reached"])
        evaluated.append(Criterion("goal reached", "yes", "yes" if reached else "no", reached))
    if criteria.min_via_points:
        passed, wanted = int(results["via_points_passed"]), criteria.min_via_points
        evaluated.append(
            Criterion("via points passed", f">= {wanted}", str(passed), passed >= wanted)
        )
    return tuple(evaluated)


def exit_code(exit_reason: str, criteria: Sequence[Criterion]) -> int:
    """Return 0 if all criteria are met, 1 if not, 3 if diverged, 130 if interrupted."""
    special = {"interrupted": INTERRUPTED, "diverged": SimulationDiverged.exit_code}
    if exit_reason in special:
        return special[exit_reason]
    return 0 if all(criterion.met for criterion in criteria) else 1


def _at_most(name: str, bound: int, actual: int) -> Criterion:
    return Criterion(name, f"<= {bound}", str(actual), actual <= bound)


def reason_of(results: Mapping[str, Any]) -> str:
    """Return the reason why a run has no success, such as ``1 collision at 12.3 s, static``."""
    reasons = []
    if results.get("falls"):
        reasons.append(counted(results["falls"], "fall"))
    if results.get("collisions"):
        kinds = [kind for kind in ("static", "moving") if results.get(f"collisions_{kind}")]
        first, at = results.get("first_collision_s"), ""
        if first is not None:
            at = f" at {first:.1f} s" if results["collisions"] == 1 else f", first at {first:.1f} s"
        reasons.append(", ".join([counted(results["collisions"], "collision") + at, *kinds]))
    if results.get("via_points_missed"):
        reasons.append(f"{counted(results['via_points_missed'], 'via point')} missed")
    reason = str(results.get("exit_reason"))
    if reason == "goal" and results.get("goal_reached") is False:
        reasons.append("the robot stopped away from the goal")
    if reason not in ("goal", "completed", "fall"):
        reasons.append(f"{reason} at {results.get('sim_time_s', 0.0):.1f} s")
    return "; ".join(reasons) or reason


def counted(count: int, noun: str) -> str:
    """Return a number with its noun in the singular or plural."""
    return f"{count} {noun}{'' if count == 1 else 's'}"
