"""Foot placement: where the swing foot lands and when, by plan or to catch the body."""

from walking.balance.capture_step import CapturePendulum
from walking.balance.stabilizer import Capture, Stabilizer
from walking.command_limits import Limit
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.stride import STILL, Strides, Velocity
from walking.gait.gait import Gait
from walking.gait.transition import Transition
from walking.pattern.dcm_tracker import dcm_reference
from walking.pattern.lipm import Lipm
from walking.pattern.pattern import PatternGenerator
from walking.pattern.ramps import Ramps
from walking.pattern.support import SupportRegion

Point = tuple[float, float]
NOT_MOVED: Point = (0.0, 0.0)


class FootPlacement:
    """Decides in every tick on the landing of the swing foot and its time.

    Args:
        lipm: pendulum.
        generator: of the plan.
        planner: knows what is in reach.
        gait: holds footholds and times.
        stabilizer: knows what the ankles cannot hold.
        pendulum: of the body, and that of the plan during a capture step.

    Attributes:
        applied: velocity that the footsteps follow (vx, vy, wz)
            [m/s, m/s, rad/s].
        bound: constraints that altered the last tick's wish.
        moved: by how much balance moves the landing [m].
        moving: whether the plan goes on walking.
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
        """Landing of the plan, without what balance adds."""
        return self._transition.landing

    @property
    def admitted(self) -> Strides | None:
        """Strides of the plan if the generator did not admit the wanted ones in full."""
        return self._transition.strides if self._transition.share < 1.0 else None

    def remember(self) -> None:
        """Keep the times of the last tick, before anything about them changes."""
        self._transition.remember()

    def decide(
        self,
        wish: Strides,
        velocity: Velocity,
        error: Point,
        region: SupportRegion,
        *,
        moving: bool,
    ) -> Ramps:
        """One tick; the gait has the landing and the times decided on.

        Args:
            wish: strides wanted.
            velocity: that goes with them (vx, vy, wz) [m/s, m/s, rad/s].
            error: of the DCM [m].
            region: where the ZMP may be in this tick.
            moving: whether to go on walking.

        Returns:
            ZMP reference from now on.
        """
        gait, adjustable = self._gait, self._gait.adjustable
        self.bound, self.moved, self.moving = [], NOT_MOVED, moving
        ramps, landing = self._reference(wish, velocity, region)
        if not adjustable:
            if gait.stepping and not self._planner.same(gait.nominal(wish), gait.landing):
                self.bound.append(Limit.LANDING_FROZEN)
        else:
            ramps = self._catch(landing, ramps, wish, error)
        if self._selects:
            self.moving = self._transition.moving
        return ramps

    @property
    def _selects(self) -> bool:
        """Whether the generator has a say in the footsteps; not if they have to be hurried."""
        return self._generator.selective and not self._gait.hurried

    def _reference(
        self, wish: Strides, velocity: Velocity, region: SupportRegion
    ) -> tuple[Ramps, Foothold]:
        """Reference of the plan that the generator admits, and the landing in it."""
        gait, transition = self._gait, self._transition
        if not self._selects:
            self.applied = velocity
            transition.skip(wish, moving=self.moving)
            landing = gait.nominal(wish) if gait.adjustable else gait.landing
            return gait.plan(landing, wish, moving=self.moving), landing
        pendulum, clock = self._pendulum, gait.clock
        ramps = transition.admit(
            pendulum.planned, region, wish, moving=self.moving, off_plan=pendulum.off_plan
        )
        share = transition.share
        if share < 1.0:
            if gait.clock != clock or self._differs(wish):
                self.bound.append(Limit.ZMP_REGION)
            a, b, c = (g + share * (v - g) for g, v in zip(self.applied, velocity, strict=True))
            self.applied = (a, b, c)
        else:
            self.applied = velocity
        return ramps, transition.landing

    def _differs(self, wish: Strides) -> bool:
        """Whether the footsteps of the admitted plan are others than those wanted."""
        gait, transition = self._gait, self._transition
        if transition.strides != wish or transition.moving != self.moving:
            return True
        return gait.adjustable and not self._planner.same(gait.nominal(wish), transition.landing)

    def _catch(self, landing: Foothold, ramps: Ramps, wish: Strides, error: Point) -> Ramps:
        """Aim at the landing that catches the body; the reference that goes with it."""
        gait, capture_landing = self._gait, landing
        capture = self._capture(landing, ramps, error)
        if capture and gait.hasten(capture.ticks, capture.landing):
            # The plan was made for other times.
            self._pendulum.reset_plan()
            ramps = gait.plan(landing, wish, moving=self.moving)
            capture = self._capture(landing, ramps, error)
        if capture and not gait.double:
            capture_landing = capture.landing
            self.moved = (capture_landing.x - landing.x, capture_landing.y - landing.y)
        gait.aim(capture_landing)
        same = self._planner.same
        if gait.hurried or not same(capture_landing, landing):
            self.bound.append(Limit.BALANCE)
        elif Limit.ZMP_REGION not in self.bound and not same(gait.nominal(wish), gait.landing):
            self.bound.append(Limit.LANDING_SPEED)
        if not self._selects and gait.landing != landing:
            ramps = gait.plan(gait.landing, wish, moving=self.moving)
        return ramps

    def _capture(self, landing: Foothold, ramps: Ramps, error: Point) -> Capture | None:
        """What the footholds of the plan do not catch of the measured DCM, if anything."""
        gait, w = self._gait, self._lipm.omega
        pendulum = self._pendulum.state
        support = gait.footholds[gait.support]
        if gait.hurried:
            x, y = dcm_reference(self._lipm, ramps)
        else:
            x, y = self._generator.planned_dcm(self._pendulum.planned, ramps)
        off = (
            pendulum.x + pendulum.vx / w + error[0] - x,
            pendulum.y + pendulum.vy / w + error[1] - y,
        )
        if self._stabilizer.holds(support, off):
            return None
        goal_x, goal_y = ramps.goal
        ahead = (x - goal_x, y - goal_y)
        return self._stabilizer.capture(
            self._planner, support, landing, off, ahead, ticks_left=gait.ticks_left
        )
