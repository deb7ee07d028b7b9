"""Passed or not: the criteria of a scenario against the results of a run."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from hsr8.scenario.schema import Criteria


@dataclass(frozen=True, slots=True)
class Check:
    """One criterion.

    Attributes:
        name: what is asked, in words.
        wanted: the bound.
        found: the result.
        passed: whether it is met.
    """

    name: str
    wanted: str
    found: str
    passed: bool


def judge(criteria: Criteria, results: Mapping[str, Any]) -> tuple[Check, ...]:
    """Compare `results` as `Metrics.result` gives them with what the scenario asks."""
    checks = [_at_most("falls", criteria.max_falls, int(results["falls"]))]
    if criteria.max_collisions is not None:
        checks.append(_at_most("collisions", criteria.max_collisions, int(results["collisions"])))
    if criteria.max_zmp_outside_ticks is not None:
        outside = int(results.get("zmp_outside_sole_ticks", 0))
        checks.append(
            _at_most("ticks with the ZMP outside", criteria.max_zmp_outside_ticks, outside)
        )
    if criteria.goal_reached:
        reached = bool(results["goal_reached"])
        checks.append(Check("goal reached", "yes", "yes" if reached else "no", reached))
    if criteria.min_via_points:
        passed = int(results["via_points_passed"])
        least = criteria.min_via_points
        checks.append(Check("via points passed", f">= {least}", str(passed), passed >= least))
    return tuple(checks)


def exit_code(exit_reason: str, checks: Sequence[Check]) -> int:
    """0 passed, 1 failed its criteria, 3 diverged, 130 interrupted."""
    special = {"interrupted": 130, "diverged": 3}
    if exit_reason in special:
        return special[exit_reason]
    return 0 if all(check.passed for check in checks) else 1


def _at_most(name: str, most: int, found: int) -> Check:
    return Check(name, f"<= {most}", str(found), found <= most)
