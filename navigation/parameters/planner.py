"""Parameters of the planners: the method, and the constants of the baselines.

The constants of the baselines are the result of `scripts/tune_baselines.py`.
"""

from dataclasses import dataclass, field
from typing import Literal

from navigation.parameters.bounds import Positive

Method = Literal["univector", "univector-plain", "n-posture", "apf", "orca", "dwa", "mppi"]


@dataclass(frozen=True)
class PlainUnivectorParameters:
    """Univector field of static discs: no virtual obstacle, speed change or safety filter."""

    margin: float = 0.0508  # distance to the bodies of obstacles [m]
    eta_vo: float = 0.31  # gain of the radius of a mover on its speed [s]
    d_e: float = 0.125  # radius offset of the spiral (9) [m]
    d_b: float = 0.341  # width of the outer band of (9) [m]
    k_r: float = 0.105  # curvature of the outer spiral (9) [m]


@dataclass(frozen=True)
class NPostureParameters:
    """Posture field of Kim with the obstacle field of Lim."""

    margin: float = 0.0368  # distance to the bodies of obstacles [m]
    gain: float = 2.29  # winding n of the posture field [1]
    offset: float = 0.0545  # distance d of the reference point beyond the destination [m]
    lead: float = 1.03  # displacement K_o of an obstacle per relative velocity [s]
    d_min: float = 0.0278  # gap within which the obstacle has full weight [m]
    delta: float = 0.151  # width of the Gaussian of its weight [m]


@dataclass(frozen=True)
class ApfParameters:
    """Artificial potential field with moving obstacles."""

    margin: float = 0.0258  # distance to the bodies of obstacles [m]
    influence: float = 0.784  # gap within which an obstacle repels [m]
    min_gap: float = 0.02  # lower bound of the gap in the repulsion [m]
    gain: float = 0.153  # repulsion, ratio to the maximum speed [m]
    reaction: float = 0.489  # reaction time, which shortens the gap of an approaching mover [s]
    swirl: float = 0.979  # tangential part of the repulsion [1]


@dataclass(frozen=True)
class OrcaParameters:
    """Optimal reciprocal collision avoidance, with full responsibility."""

    margin: float = 0.0987  # distance to the bodies of obstacles [m]
    horizon: float = 9.52  # time horizon for movers [s]
    static_horizon: float = 2.13  # time horizon for static obstacles [s]
    responsibility: float = 1.0  # fraction of the avoidance taken by the robot, in (0, 1] [1]


@dataclass(frozen=True)
class DwaParameters:
    """Dynamic window over velocities reachable in one footstep."""

    margin: float = 0.0483  # distance to the bodies of obstacles [m]
    samples: tuple[int, int, int] = (7, 5, 9)  # velocities in vx, vy and wz, plus zero [1]
    horizon: float = 1.88  # time for which a velocity is rolled out [s]
    heading_weight: float = 0.227  # weight of the heading error [1]
    clearance_weight: float = 0.989  # weight of the gap to the nearest obstacle [1]
    clearance: float = 0.188  # gap above which it costs nothing [m]
    contact_weight: float = 6.82  # weight of a collision, more for an earlier one [1]


@dataclass(frozen=True)
class MppiParameters:
    """Model predictive path integral control."""

    margin: float = 0.0238  # distance to the bodies of obstacles [m]
    samples: int = 256  # sampled sequences of footsteps, half of them mirrored [1]
    steps: int = 18  # footsteps per sequence [1]
    spread: float = 0.975  # standard deviation of the samples, ratio to the speed limits [1]
    persistence: float = 0.525  # correlation of a sample between footsteps, in [0, 1) [1]
    temperature: float = 0.0628  # cost over which the weight of a sample falls to 1/e [1]
    heading_weight: float = 0.0653  # weight of the heading error [1]
    clearance_weight: float = 1.26  # weight of the gap to the nearest obstacle [1]
    clearance: float = 0.165  # gap above which it costs nothing [m]
    contact_weight: float = 4.41  # weight of a collision, more for an earlier one [1]


@dataclass(frozen=True)
class PlannerParameters:
    """Planner: the method, and the parameters of the baselines."""

    method: Method = "univector"
    """Planner: the modified univector field of the profile, or a baseline."""
    memory: Positive = 4.0
    """Time unseen after which a baseline forgets a mover [s]."""

    max_sigma: float = 0.06  # maximum position uncertainty a baseline adds to a radius [m]
    univector_plain: PlainUnivectorParameters = field(default_factory=PlainUnivectorParameters)
    n_posture: NPostureParameters = field(default_factory=NPostureParameters)
    apf: ApfParameters = field(default_factory=ApfParameters)
    orca: OrcaParameters = field(default_factory=OrcaParameters)
    dwa: DwaParameters = field(default_factory=DwaParameters)
    mppi: MppiParameters = field(default_factory=MppiParameters)
