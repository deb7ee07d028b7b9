"""Registry of the metrics of a run: name, unit, text, and the tables that show each of them."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Flag, auto

from hsr8.measure.statistics import mean
from hsr8.recording.run import Run


class Shown(Flag):
    """Tables that show a metric.

    RUN is the table of a run, COUNT the sum and SWEEP the distribution over a sweep, BENCH that in
    the score of a benchmark, COMPARED and BENCH_COMPARED a line of a comparison of two of them.
    """

    RUN = auto()
    COUNT = auto()
    SWEEP = auto()
    COMPARED = auto()
    BENCH = auto()
    BENCH_COMPARED = auto()


NOWHERE = Shown(0)
RUN, COUNT, SWEEP, COMPARED, BENCH, BENCH_COMPARED = Shown
UNITS = {"_radps": "rad/s", "_mps": "m/s", "_per_s": "1/s", "_deg": "deg", "_rad": "rad"}
UNITS |= {"_m": "m", "_s": "s"}  # by the end of a name; of two that fit the first


@dataclass(frozen=True)
class Metric:
    """Metric of a run.

    Attributes:
        name: key in ``metrics.json``, ends with the unit.
        text: definition in Markdown.
        shown: tables that show it.
        label: words for the heads of tables.
        units: unit for the heads of tables, if the name does not end with it.
        successes: whether only successful runs have a meaningful value.
        of: returns the value of a run; None if `hsr8.measure.metrics` computes it with others.
    """

    name: str
    text: str
    shown: Shown = NOWHERE
    label: str = ""
    units: str = ""
    successes: bool = False
    of: Callable[[Run], object] | None = None

    @property
    def unit(self) -> str:
        """Unit; empty for counts, fractions and text."""
        ends = (unit for end, unit in UNITS.items() if self.name.endswith(end))
        return self.units or next(ends, "")

    @property
    def head(self) -> str:
        """Head of a column or line of a table: label and unit."""
        unit = f" [{self.unit}]" if self.unit else ""
        return f"{self.label}{', successes' if self.successes else ''}{unit}"


SECTIONS = {
    "Task": (
        Metric(
            "success",
            "no collision, no fall, no via point missed, goal (if any) reached",
            COMPARED | BENCH_COMPARED,
        ),
        Metric(
            "exit_reason",
            "`goal`, `timeout` (a mission with a goal), `completed` (one without), `fall`, "
            "`diverged` or `interrupted`",
            RUN,
        ),
        Metric("via_points_total", "via points of the mission"),
        Metric(
            "via_points_passed",
            "via points passed according to the robot, without the missed ones",
            RUN,
        ),
        Metric(
            "via_points_missed",
            "via points that the robot took for passed, while its true distance exceeded "
            "`navigation.mission.r_via` + 0.10 m",
        ),
        Metric(
            "goal_reached",
            "the robot believes so, its true distance is at most `navigation.mission.r_goal` + "
            "0.10 m and its heading error at most 15 deg",
        ),
        Metric(
            "time_to_goal_s",
            "time at which the robot believes the mission finished",
            RUN | SWEEP | COMPARED | BENCH | BENCH_COMPARED,
            "time to goal",
            successes=True,
        ),
        Metric(
            "arrival_error_deg",
            "true heading error at the end of the run, one second later",
            RUN | SWEEP | COMPARED,
            "arrival error",
            successes=True,
        ),
        Metric(
            "certified_time_s",
            "arrival time of the path of the [feasibility "
            "certificate](worlds.md#the-feasibility-certificate), for missions with a goal",
        ),
        Metric("certified_length_m", "length of this path"),
        Metric(
            "path_length_m",
            "length of the robot's path, sampled every second so that sway does not count",
            RUN | SWEEP | COMPARED,
            "path length",
            successes=True,
        ),
        Metric(
            "spl",
            "success weighted by path length, `certified_length_m` / max(`certified_length_m`, "
            "`path_length_m`), 0 without success (Anderson et al. 2018)",
            BENCH_COMPARED,
            "SPL",
        ),
        Metric(
            "stl",
            "the same of `certified_time_s` and `time_to_goal_s` (iGibson Social Navigation 2021)",
            label="STL",
        ),
        Metric(
            "time_standing_s",
            "sum of the seconds with a displacement below 0.02 m; HuNavSim's `time_not_moving` for "
            "a body that sways",
            SWEEP,
            "time standing",
        ),
        Metric("sim_time_s", "simulated time", RUN),
        Metric("wall_time_s", "wall time", RUN),
        Metric(
            "real_time_factor", "simulated time over wall time", RUN | SWEEP, "real-time factor"
        ),
        Metric(
            "state_hash",
            "SHA-256 of the last state of the world and the belief; equal runs have equal hashes",
        ),
    ),
    "Obstacles": (
        Metric(
            "collisions",
            "collisions with obstacles and beacons; contacts with pauses below 0.5 s are one "
            "collision",
            RUN | COUNT | COMPARED,
            "collisions",
        ),
        Metric(
            "first_collision_s",
            "time of the first collision, as a value for `--from` of `hsr8 render`",
            RUN,
        ),
        Metric("collisions_moving", "collisions with movers", RUN | COUNT, "with moving obstacles"),
        Metric(
            "collisions_static",
            "collisions with static obstacles or beacons",
            RUN | COUNT,
            "with static obstacles",
        ),
        Metric(
            "collisions_at_fault",
            "collisions in which the robot itself moved towards the object at more than 0.02 m/s",
            COUNT,
            "at the robot's fault",
        ),
        Metric("collisions_per_m", "`collisions` / `path_length_m`"),
        Metric(
            "min_clearance_m",
            "minimum distance of any part of the body, arms and feet included, to the surface of "
            "any obstacle or beacon",
            RUN | SWEEP | COMPARED | BENCH | BENCH_COMPARED,
            "min clearance",
        ),
    ),
    "People": (
        Metric(
            "minimum_distance_to_people_m",
            "minimum distance of the axis of a mover from the disc of `robot.radius` around the "
            "robot (HuNavSim; Perez-Higueras et al. 2018)",
        ),
        Metric(
            "avg_distance_to_closest_person_m",
            "mean distance of this disc from the surface of the nearest mover (HuNavSim)",
        ),
        Metric(
            "intimate_space_intrusions",
            "fraction of the records with the nearest mover, its axis from this disc, below 0.45 m "
            "(Hall 1966; HuNavSim, in per cent); `recorder.space_scale` scales it",
            SWEEP,
            "intimate space",
        ),
        Metric(
            "personal_space_intrusions",
            "the same from 0.45 to 1.2 m",
            SWEEP | COMPARED,
            "personal space",
        ),
        Metric("social_space_intrusions", "the same from 1.2 to 3.6 m", SWEEP, "social space"),
        Metric(
            "space_compliance",
            "the same of at least 0.5 m (personal space compliance, iGibson Social Navigation "
            "2021)",
            SWEEP,
            "space compliance",
        ),
        Metric(
            "min_time_to_collision_s",
            "minimum time after which this disc and a mover would touch at their velocities, the "
            "robot's over 1 s; 0 in contact, null if they never would (TTC, Francis et al. 2025)",
            SWEEP | COMPARED,
            "time to collision",
        ),
        Metric(
            "robot_on_person_collision",
            "collisions with movers that the motion of the robot caused, see "
            "`collisions_at_fault` (SEAN 2.0, Tsoi et al. 2022; HuNavSim)",
            COUNT,
            "robot on person",
        ),
        Metric(
            "person_on_robot_collision",
            "the other collisions with movers",
            COUNT,
            "person on robot",
        ),
        Metric(
            "path_irregularity_rad",
            "mean angle between motion and the direction of the next point of the mission, once "
            "per second (SocNavBench, Biswas et al. 2022)",
            SWEEP,
            "path irregularity",
        ),
        Metric(
            "cumulative_heading_changes_rad",
            "sum of the turns of the heading, once per second (HuNavSim; Perez-Higueras et al. "
            "2018)",
        ),
        Metric(
            "avg_overacceleration_mps3",
            "mean magnitude of the jerk, the third difference of the positions, once per second "
            "(HuNavSim; SocNavBench)",
        ),
    ),
    "Belief": (
        Metric(
            "localization_rmse_m",
            "RMS error of the believed position over the camera frames",
            RUN | SWEEP | COMPARED,
            "position RMSE",
        ),
        Metric(
            "heading_rmse_deg",
            "RMS error of the believed heading over the camera frames",
            RUN | SWEEP | COMPARED,
            "heading RMSE",
        ),
        Metric(
            "nees_mean",
            "normalised estimation error squared of the pose / 3: 1 if the covariance is "
            "consistent, larger if it is too small; frames after a contact with an obstacle or "
            "beacon count from the next relocalization on",
            RUN | SWEEP | COMPARED,
            "NEES / 3",
        ),
        Metric(
            "lost_fraction",
            "fraction of the frames in which localization reports being lost",
            SWEEP,
            "fraction of frames lost",
            of=lambda run: mean(run.frames["lost"]),
        ),
        Metric(
            "filter_faults",
            "restarts of a filter",
            of=lambda run: int([0, *run.frames["filter_faults"]][-1]),
        ),
        Metric(
            "camera_frames",
            "frames that arrived while the robot was on its feet",
            of=lambda run: len(run.frames),
        ),
        Metric(
            "obstacle_speed_rmse_mps",
            "RMS velocity error of every track within 0.4 m of an obstacle, against the nearest "
            "one",
            RUN | SWEEP,
            "obstacle speed RMSE",
        ),
        Metric(
            "static_track_rmse_m",
            "RMS position error of the static tracks within 0.3 m of an obstacle of their colour",
        ),
        Metric(
            "mover_track_rmse_m",
            "the same of movers, while visible within 3.5 m, recognised as moving, and in view for "
            "more than a second",
        ),
        Metric("mover_velocity_rmse_mps", "RMS velocity error of these movers"),
        Metric(
            "static_track_nees_mean",
            "error of `static_track_rmse_m` as normalised estimation error squared / 2, in the "
            "frames of `nees_mean`",
        ),
        Metric("mover_track_nees_mean", "the same of `mover_track_rmse_m`"),
        Metric("mover_velocity_nees_mean", "the same of `mover_velocity_rmse_mps`"),
        Metric(
            "movers_recognised_after_s", "for each recognised mover, the time from its first sight"
        ),
    ),
    "Head": (
        Metric(
            "saccades_per_s",
            "changes of the commanded gaze by more than 0.17 rad",
            SWEEP,
            "saccades",
        ),
        Metric(
            "head_travel_radps",
            "travel of pan and tilt, measured by the encoders",
            SWEEP | COMPARED | BENCH | BENCH_COMPARED,
            "head travel",
        ),
    ),
    "Walking": (
        Metric("falls", "falls", RUN | COUNT | COMPARED, "falls"),
        Metric(
            "max_tilt_deg", "maximum measured tilt except while fallen", RUN | SWEEP, "max tilt"
        ),
        Metric("steps", "footsteps", RUN),
        Metric("pushes", "pushes that began", RUN),
        Metric(
            "mean_velocity",
            "`vx`, `vy` [m/s] and `wz` [rad/s], over whole strides after 3 s",
            RUN,
            "mean velocity",
            "m/s, m/s, rad/s",
        ),
        Metric(
            "velocity_error",
            "mean error of the velocity with respect to the `commanded` and to the `applied` "
            "velocity, which satisfies all limits",
            RUN,
            "velocity error",
            "m/s, m/s, rad/s",
        ),
        Metric("velocity_error_rms", "RMS of these errors"),
        Metric("walk_ticks", "control ticks of 5 ms on the feet, the basis of the next four"),
        Metric(
            "zmp_outside_sole_ticks", "ticks with the planned ZMP outside the supporting soles", RUN
        ),
        Metric("zmp_min_margin_m", "minimum distance of the planned ZMP inside their edge", RUN),
        Metric("limited_fraction", "fraction of the ticks with a limited command", RUN),
        Metric("limited_by", "fraction of the ticks by limit", RUN),
    ),
    "Servos": (
        Metric("torque_saturated_ticks", "ticks with any joint at its maximum torque", RUN),
        Metric("torque_saturated_by", "the same by joint"),
        Metric("joint_stop_ticks", "ticks with any joint at the end of its range", RUN),
        Metric("joint_stop_by", "the same by joint", RUN),
        Metric("peak_torque_ratio", "maximum torque over its limit", RUN),
        Metric("peak_torque_joint", "its joint", RUN),
        Metric("peak_joint_speed_radps", "maximum joint speed", RUN),
        Metric("peak_speed_joint", "its joint", RUN),
        Metric("walk_tick_mean_ms", "mean wall time of the walking engine per tick", RUN),
        Metric("walk_tick_p999_ms", "99.9 % quantile of these times", RUN),
        Metric("walk_tick_max_ms", "maximum of these times"),
    ),
}
"""Metrics of a run by section of their page; those of servos are measured in full physics only."""

BENCH_METRICS = (
    Metric("collision", "whether there was a collision", BENCH_COMPARED, "collisions", "%"),
    Metric("timeout", "whether the run ended by `timeout`", BENCH_COMPARED, "timeouts", "%"),
    Metric("fall", "whether the robot fell", BENCH_COMPARED, "falls", "%"),
    Metric(
        "optimal_time_ratio", "success times certified over actual time", BENCH_COMPARED, "T*/T"
    ),
)
"""Metrics of a benchmark, computed from those of a run."""

METRICS = {m.name: m for section in (*SECTIONS.values(), BENCH_METRICS) for m in section}


def shown_in(table: Shown) -> tuple[Metric, ...]:
    """Return the metrics that a table shows, in the order of the registry."""
    return tuple(metric for metric in METRICS.values() if table & metric.shown)
