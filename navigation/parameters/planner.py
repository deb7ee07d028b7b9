"""Parameters of the planners: which one, and those of the baselines.

The defaults of every baseline are those found by `scripts/tune_baselines.py`.
"""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le, Lt

from navigation.parameters.bounds import NonNegative, Positive

Samples = Annotated[int, Ge(2), Le(101)]
Method = Literal["univector", "univector-plain", "n-posture", "apf", "orca", "dwa", "mppi"]


@dataclass(frozen=True)
class PlainUnivectorParameters:
    """Univector field of static discs: no virtual obstacle, no speed, no filter."""

    margin: NonNegative = 0.0508
    """Distance kept from the bodies of obstacles [m]."""
    eta_vo: NonNegative = 0.31
    """Growth of the radius of a mover with its speed [s]."""
    d_e: Positive = 0.125
    """Radius offset of the spiral (9) [m]."""
    d_b: Positive = 0.341
    """Width of the outer band of (9) [m]."""
    k_r: Positive = 0.105
    """Curvature of the outer spiral (9) [m]."""


@dataclass(frozen=True)
class NPostureParameters:
    """Posture field of Kim with the obstacle field of Lim."""

    margin: NonNegative = 0.0368
    """Distance kept from the bodies of obstacles [m]."""
    gain: Positive = 2.29
    """Winding n of the posture field [1]."""
    offset: Positive = 0.0545
    """Distance d of the point beyond the destination that bends the field [m]."""
    lead: NonNegative = 1.03
    """Displacement K_o of an obstacle per velocity relative to the robot [s]."""
    d_min: NonNegative = 0.0278
    """Gap within which only the obstacle counts [m]."""
    delta: Positive = 0.151
    """Width of the Gaussian over which it loses its weight [m]."""


@dataclass(frozen=True)
class ApfParameters:
    """Artificial potential field with moving obstacles."""

    margin: NonNegative = 0.0258
    """Distance kept from the bodies of obstacles [m]."""
    influence: Positive = 0.784
    """Gap within which an obstacle repels [m]."""
    min_gap: Positive = 0.02
    """Gap below which the repulsion does not grow any more [m]."""
    gain: Positive = 0.153
    """Repulsion, as a share of the largest speed [m]."""
    reaction: NonNegative = 0.489
    """Time of approach by which the gap counts as shorter [s]."""
    swirl: NonNegative = 0.979
    """Tangential part of the repulsion [1]."""


@dataclass(frozen=True)
class OrcaParameters:
    """Optimal reciprocal collision avoidance, with full responsibility."""

    margin: NonNegative = 0.0987
    """Distance kept from the bodies of obstacles [m]."""
    horizon: Positive = 9.52
    """Time for which movers are avoided [s]."""
    static_horizon: Positive = 2.13
    """Time for which static obstacles are avoided [s]."""
    responsibility: Annotated[float, Gt(0.0), Le(1.0)] = 1.0
    """Share of the avoidance taken by the robot; obstacles that never give way leave all [1]."""


@dataclass(frozen=True)
class DwaParameters:
    """Dynamic window over velocities reachable in one footstep."""

    margin: NonNegative = 0.0483
    """Distance kept from the bodies of obstacles [m]."""
    samples: tuple[Samples, Samples, Samples] = (7, 5, 9)
    """Velocities tried forward, to the left and turning; standing still besides [1]."""
    horizon: Positive = 1.88
    """Time a velocity is kept for when it is judged [s]."""
    heading_weight: NonNegative = 0.227
    """Weight of the heading left to turn [1]."""
    clearance_weight: NonNegative = 0.989
    """Weight of the gap to the nearest obstacle [1]."""
    clearance: Positive = 0.188
    """Gap from which on it does not matter [m]."""
    contact_weight: NonNegative = 6.82
    """Weight of a contact, the sooner the more [1]."""


@dataclass(frozen=True)
class MppiParameters:
    """Model predictive path integral control."""

    margin: NonNegative = 0.0238
    """Distance kept from the bodies of obstacles [m]."""
    samples: Annotated[int, Ge(8), Le(8192)] = 256
    """Sampled sequences of footsteps, half of them mirrored [1]."""
    steps: Annotated[int, Ge(1), Le(200)] = 18
    """Footsteps per sequence [1]."""
    spread: Positive = 0.975
    """Standard deviation of the samples, share of the speed limits [1]."""
    persistence: Annotated[float, Ge(0.0), Lt(1.0)] = 0.525
    """Correlation of a sample from footstep to footstep [1]."""
    temperature: Positive = 0.0628
    """Cost over which a sample's weight falls to 1/e [1]."""
    heading_weight: NonNegative = 0.0653
    """Weight of the heading left to turn [1]."""
    clearance_weight: NonNegative = 1.26
    """Weight of the gap to the nearest obstacle [1]."""
    clearance: Positive = 0.165
    """Gap from which on it does not matter [m]."""
    contact_weight: NonNegative = 4.41
    """Weight of a contact, the sooner the more [1]."""


@dataclass(frozen=True)
class PlannerParameters:
    """Which planner moves the robot, and the parameters of the baselines."""

    method: Method = "univector"
    """Planner: the modified univector field of the profile, or a baseline."""
    memory: Positive = 4.0
    """Time unseen after which a baseline forgets what may move [s]."""
    max_sigma: NonNegative = 0.06
    """Largest part of an obstacle's position uncertainty a baseline adds to its radius [m]."""
    univector_plain: PlainUnivectorParameters = field(default_factory=PlainUnivectorParameters)
    """Univector field alone."""
    n_posture: NPostureParameters = field(default_factory=NPostureParameters)
    """Posture field."""
    apf: ApfParameters = field(default_factory=ApfParameters)
    """Artificial potential field."""
    orca: OrcaParameters = field(default_factory=OrcaParameters)
    """Optimal reciprocal collision avoidance."""
    dwa: DwaParameters = field(default_factory=DwaParameters)
    """Dynamic window."""
    mppi: MppiParameters = field(default_factory=MppiParameters)
    """Path integral."""
