"""Parameters of the planners: the method, and the constants of the baselines.

The constants of the baselines were tuned with equal effort; `scripts/tune.py` tunes them again.
"""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from annotated_types import Gt, Lt, doc

Method = Literal["univector", "paper", "n-posture", "apf", "orca", "dwa", "mppi"]


@dataclass(frozen=True)
class PaperParameters:
    """Motion of Yoo & Kim, section III, where it differs from the default planner."""

    weights: Annotated[
        Literal["printed", "exchanged"],
        doc("Weights of (10): 0.75 for move-to-goal and 0.25 for avoid-obstacle, or exchanged."),
    ] = "printed"
    xi: Annotated[
        float, Gt(0.0), Lt(1.0), doc("Convexity of the dynamic virtual obstacle [1].")
    ] = 0.6

    d_con: Annotated[float, "m"] = 0.38  # distance within which (8) arrives with a heading
    k_beta: float = -0.5  # arrival gain on the remaining heading error, negative [1]
    d_e: Annotated[float, "m"] = 0.059  # radius offset of the spiral (9)
    d_b: Annotated[float, "m"] = 0.242  # width of the outer band of (9)
    k_r: Annotated[float, "m"] = 0.495  # curvature of the outer spiral (9)
    omega_dist: float = 3.74  # length of the virtual path in (11) [1]
    horizon: Annotated[float, "s"] = 7.5  # maximum time to collision in velocity modification
    min_speed: Annotated[float, "m/s"] = 0.015  # speed below which an obstacle has no virtual path
    nominal: float = 0.75  # desired speed of a free path, ratio to the maximum [1]


@dataclass(frozen=True)
class NPostureParameters:
    """Posture field of Kim with the obstacle field of Lim."""

    margin: Annotated[float, "m"] = 0.0368  # distance to the bodies of obstacles
    gain: float = 2.29  # winding n of the posture field [1]
    # distance d of the reference point beyond the destination
    offset: Annotated[float, "m"] = 0.0545
    lead: Annotated[float, "s"] = 1.03  # displacement K_o of an obstacle per relative velocity
    d_min: Annotated[float, "m"] = 0.0278  # gap within which the obstacle has full weight
    delta: Annotated[float, "m"] = 0.151  # width of the Gaussian of its weight


@dataclass(frozen=True)
class ApfParameters:
    """Artificial potential field with moving obstacles."""

    margin: Annotated[float, "m"] = 0.0258  # distance to the bodies of obstacles
    influence: Annotated[float, "m"] = 0.784  # gap within which an obstacle repels
    min_gap: Annotated[float, "m"] = 0.02  # lower bound of the gap in the repulsion
    gain: Annotated[float, "m"] = 0.153  # repulsion, ratio to the maximum speed
    # reaction time, which shortens the gap of an approaching mover
    reaction: Annotated[float, "s"] = 0.489
    swirl: float = 0.979  # tangential part of the repulsion [1]


@dataclass(frozen=True)
class OrcaParameters:
    """Optimal reciprocal collision avoidance, with full responsibility."""

    margin: Annotated[float, "m"] = 0.0987  # distance to the bodies of obstacles
    horizon: Annotated[float, "s"] = 9.52  # time horizon for movers
    static_horizon: Annotated[float, "s"] = 2.13  # time horizon for static obstacles
    responsibility: float = 1.0  # fraction of the avoidance taken by the robot, in (0, 1] [1]


@dataclass(frozen=True)
class DwaParameters:
    """Dynamic window over velocities reachable in one footstep."""

    margin: Annotated[float, "m"] = 0.0483  # distance to the bodies of obstacles
    samples: tuple[int, int, int] = (7, 5, 9)  # velocities in vx, vy and wz, plus zero [1]
    horizon: Annotated[float, "s"] = 1.88  # time for which a velocity is rolled out
    heading_weight: float = 0.227  # weight of the heading error [1]
    clearance_weight: float = 0.989  # weight of the gap to the nearest obstacle [1]
    clearance: Annotated[float, "m"] = 0.188  # gap above which it costs nothing
    contact_weight: float = 6.82  # weight of a collision, more for an earlier one [1]


@dataclass(frozen=True)
class MppiParameters:
    """Model predictive path integral control."""

    margin: Annotated[float, "m"] = 0.0238  # distance to the bodies of obstacles
    samples: int = 256  # sampled sequences of footsteps, half of them mirrored [1]
    steps: int = 18  # footsteps per sequence [1]
    spread: float = 0.975  # standard deviation of the samples, ratio to the speed limits [1]
    persistence: float = 0.525  # correlation of a sample between footsteps, in [0, 1) [1]
    temperature: float = 0.0628  # cost over which the weight of a sample falls to 1/e [1]
    heading_weight: float = 0.0653  # weight of the heading error [1]
    clearance_weight: float = 1.26  # weight of the gap to the nearest obstacle [1]
    clearance: Annotated[float, "m"] = 0.165  # gap above which it costs nothing
    contact_weight: float = 4.41  # weight of a collision, more for an earlier one [1]


@dataclass(frozen=True)
class PlannerParameters:
    """Planner: the method, and the parameters of the baselines."""

    method: Annotated[
        Method, doc("Planner: the default one, the method of the paper, or a baseline.")
    ] = "univector"

    # maximum position uncertainty that a baseline adds to the radius of a mover
    max_sigma: Annotated[float, "m"] = 0.06
    paper: PaperParameters = field(default_factory=PaperParameters)
    n_posture: NPostureParameters = field(default_factory=NPostureParameters)
    apf: ApfParameters = field(default_factory=ApfParameters)
    orca: OrcaParameters = field(default_factory=OrcaParameters)
    dwa: DwaParameters = field(default_factory=DwaParameters)
    mppi: MppiParameters = field(default_factory=MppiParameters)
