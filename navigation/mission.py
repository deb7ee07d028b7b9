"""The mission: via points in order, then a goal to arrive at with a heading."""

from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.decision import Task, read_only
from navigation.parameters.navigation import MissionParameters

Array = NDArray[np.float64]


class Mission:
    """Sequence of waypoints; the paper's planner "simply updates sequential waypoints".

    The heading of a via point points to the next waypoint. The last waypoint is the goal: reach
    it, turn to its heading, done. Without a goal heading any heading is accepted. An endless
    mission is a tour: every waypoint is a via point, and the first follows the last.
    """

    def __init__(
        self,
        waypoints: Array,
        goal_heading: float | None,
        endless: bool,
        parameters: MissionParameters,
    ) -> None:
        """Start at the first waypoint.

        Args:
            waypoints: positions in W (n, 2) [m], n >= 1.
            goal_heading: heading at the goal [rad]; None for any.
            endless: whether the waypoints are a tour.
            parameters: arrival distances and tolerance.

        Raises:
            ValueError: fewer than one waypoint, or than two of a tour.
        """
        points = np.asarray(waypoints, dtype=np.float64)
        if points.ndim != 2 or points.shape[1] != 2 or len(points) < (2 if endless else 1):
            raise ValueError(
                f"waypoints: wrong shape, got {points.shape}; "
                f"expected (n, 2) with n >= {2 if endless else 1}"
            )
        self._points = points
        self._goal_heading = goal_heading
        self._endless = endless
        self._parameters = parameters
        self._passed = 0
        self._aligning = False
        self._done = False

    def update(self, pose: Array) -> Task:
        """Advance the mission to the believed `pose` (3,) [m, m, rad]; return the next task."""
        x, y, heading = pose.tolist()
        if not self._done:
            # Each waypoint at most once: a whole tour may be within r_via.
            for _ in self._points:
                if self._at_goal_point() or self._distance(x, y) >= self._parameters.r_via:
                    break
                self._passed += 1
            if self._at_goal_point():
                self._approach_goal(x, y, heading)
        return self._task(x, y)

    def _distance(self, x: float, y: float) -> float:
        """Return the distance to the present waypoint [m]."""
        tx, ty = self._points[self._passed % len(self._points)].tolist()
        return hypot(tx - x, ty - y)

    def _at_goal_point(self) -> bool:
        return not self._endless and self._passed == len(self._points) - 1

    def _approach_goal(self, x: float, y: float, heading: float) -> None:
        p = self._parameters
        self._aligning = self._distance(x, y) < (p.r_release if self._aligning else p.r_goal)
        if self._aligning:
            goal_heading = heading if self._goal_heading is None else self._goal_heading
            self._done = abs(wrap(goal_heading - heading)) < p.heading_tolerance

    def _task(self, x: float, y: float) -> Task:
        index = self._passed % len(self._points)
        target = self._points[index]
        is_goal = self._at_goal_point()
        if not is_goal:
            ahead = self._points[(index + 1) % len(self._points)] - target
        elif index > 0:
            ahead = target - self._points[index - 1]
        else:
            ahead = target - np.array([x, y])
        heading = atan2(float(ahead[1]), float(ahead[0]))
        if is_goal and self._goal_heading is not None:
            heading = wrap(self._goal_heading)
        return Task(
            target=read_only(target),
            heading=heading,
            is_goal=is_goal,
            index=self._passed,
            aligning=self._aligning and not self._done,
            done=self._done,
        )
