"""Foot placement: landing and timing of the swing foot, by plan or by capture step."""

from walking.arrays import Point
from walking.balance.capture_step import CapturePendulum
from walking.balance.stabilizer import Capture, Stabilizer
from walking.command_limits import Limit
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.stride import STILL, Strides, Velocity
from walking.gait.gait import Gait
from walking.gait.transition import Transition
from walking.pattern.dcm_pattern import dcm_reference
from walking.pattern.lipm import Lipm
from walking.pattern.pattern import PatternGenerator
from walking.pattern.ramps import Ramps
from walking.pattern.support import SupportRegion

NOT_MOVED: Point = (0.0, 0.0)


class FootPlacement:
    """Chooses landing and timing of the swing foot in every tick.

    Args:
        lipm: pendulum.
        generator: of the plan.
        planner: limits landings to the reach of the leg.
        gait: holds footholds and timing.
        stabilizer: computes the capture step.
        pendulum: of the body, and that of the plan during a capture step.

    Attributes:
        applied: velocity that the footsteps follow (vx, vy, wz) [m/s, m/s, rad/s].
        bound: constraints that limited the last wanted strides.
        moved: shift of the landing by the capture step [m].
        moving: whether the walk goes on.
    """

    def __init__(
        self,
        lipm: Lipm,
        generator: PatternGenerator,
        planner: FootstepPlanner,
        gait: Gait,
        *,
        stabilizer: Stabilizer,
        pendulum: CapturePendulum,
    ) -> None:
        self._lipm = lipm
        self._generator = generator
        self._planner = planner
        self._gait = gait
        self._stabilizer = stabilizer
        self._pendulum = pendulum
        self._transition = Transition(gait, generator)
        self.applied: Velocity = STILL
        self.bound: list[Limit] = []
        self.moved = NOT_MOVED
        self.moving = False

    @property
    def landing(self) -> Foothold:
        """Landing of the plan, without capture step."""
        return self._transition.landing

    @property
    def admitted(self) -> Strides | None:
        """Strides of the plan if the generator limited the wanted ones."""
        return self._transition.strides if self._transition.fraction < 1.0 else None

    def remember(self) -> None:
        """Store the timing of the last tick before it changes."""
        self._transition.remember()

    def decide(
        self,
        wanted: Strides,
        velocity: Velocity,
        error: Point,
        region: SupportRegion,
        *,
        moving: bool,
    ) -> Ramps:
        """Choose landing and timing of this tick and give them to the gait.

        Args:
            wanted: strides.
            velocity: of these strides (vx, vy, wz) [m/s, m/s, rad/s].
            error: of the DCM [m].
            region: admissible ZMP in this tick.
            moving: whether the walk is to go on.

        Returns:
            ZMP reference from now on.
        """
        gait, adjustable = self._gait, self._gait.adjustable
        self.bound, self.moved, self.moving = [], NOT_MOVED, moving
        ramps, landing = self._reference(wanted, velocity, region)
        if not adjustable:
            if gait.stepping and not self._planner.same(gait.nominal(wanted), gait.landing):
                self.bound.append(Limit.LANDING_FROZEN)
        else:
            ramps = self._capture_step(landing, ramps, wanted, error)
        if self._selects:
            self.moving = self._transition.moving
        return ramps

    @property
    def _selects(self) -> bool:
        """Whether the generator may limit the footsteps; not in a shortened footstep."""
        return self._generator.selective and not self._gait.shortened

    def _reference(
        self, wanted: Strides, velocity: Velocity, region: SupportRegion
    ) -> tuple[Ramps, Foothold]:
        """Return reference and landing of the plan that the generator admits."""
        gait, transition = self._gait, self._transition
        if not self._selects:
            self.applied = velocity
            transition.skip(wanted, moving=self.moving)
            landing = gait.nominal(wanted) if gait.adjustable else gait.landing
            return gait.plan(landing, wanted, moving=self.moving), landing
        pendulum, clock = self._pendulum, gait.clock
        ramps = transition.admit(
            pendulum.planned, region, wanted, moving=self.moving, off_plan=pendulum.off_plan
        )
        fraction = transition.fraction
        if fraction < 1.0:
            if gait.clock != clock or self._differs(wanted):
                self.bound.append(Limit.ZMP_REGION)
            a, b, c = (g + fraction * (v - g) for g, v in zip(self.applied, velocity, strict=True))
            self.applied = (a, b, c)
        else:
            self.applied = velocity
        return ramps, transition.landing

    def _differs(self, wanted: Strides) -> bool:
        """Whether the footsteps of the admitted plan differ from the wanted ones."""
        gait, transition = self._gait, self._transition
        if transition.strides != wanted or transition.moving != self.moving:
            return True
        return gait.adjustable and not self._planner.same(gait.nominal(wanted), transition.landing)

    def _capture_step(
        self, landing: Foothold, ramps: Ramps, wanted: Strides, error: Point
    ) -> Ramps:
        """Aim at the landing of a capture step if one is needed; return the ZMP reference."""
        gait, capture_landing = self._gait, landing
        capture = self._capture(landing, ramps, error)
        if capture and gait.shorten(capture.ticks, capture.landing):
            # The timing has changed: plan again.
            self._pendulum.reset_plan()
            ramps = gait.plan(landing, wanted, moving=self.moving)
            capture = self._capture(landing, ramps, error)
        if capture and not gait.double:
            capture_landing = capture.landing
            self.moved = (capture_landing.x - landing.x, capture_landing.y - landing.y)
        gait.aim(capture_landing)
        same = self._planner.same
        if gait.shortened or not same(capture_landing, landing):
            self.bound.append(Limit.BALANCE)
        elif Limit.ZMP_REGION not in self.bound and not same(gait.nominal(wanted), gait.landing):
            self.bound.append(Limit.LANDING_SPEED)
        if not self._selects and gait.landing != landing:
            ramps = gait.plan(gait.landing, wanted, moving=self.moving)
        return ramps

    def _capture(self, landing: Foothold, ramps: Ramps, error: Point) -> Capture | None:
        """Return the capture step for the measured DCM, None if the ankles suffice."""
        gait = self._gait
        support = gait.footholds[gait.support]
        if gait.shortened:
            x, y = dcm_reference(self._lipm, ramps)
        else:
            x, y = self._generator.planned_dcm(self._pendulum.planned, ramps)
        body_x, body_y = self._pendulum.state.dcm(self._lipm.omega)
        off = (body_x + error[0] - x, body_y + error[1] - y)
        if self._stabilizer.holds(support, off):
            return None
        goal_x, goal_y = ramps.goal
        ahead = (x - goal_x, y - goal_y)
        return self._stabilizer.capture(
            self._planner, support, landing, off, ahead, ticks_left=gait.ticks_left
        )
