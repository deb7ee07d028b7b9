"""Decisions of a tick: follow the command, correct slip, start to walk, detect touchdown."""

from compilation import compiled
from walking.command import BALANCE, TIMING
from walking.data import Data, DeadReckoning
from walking.model import LEFT, RIGHT, Model
from walking.parameters import CONTROL_PERIOD
from walking.plan.balance import exceeds_support, excess_error
from walking.plan.corrections import (
    correct_offset,
    cycle_begins,
    detects_touchdown,
    end_corrections,
    heading_rate,
    landed_shift,
    restart_cycle,
    speed_correction,
    speed_ratio,
)
from walking.plan.footsteps import STILL, StepValues, tendency
from walking.plan.gait import end_support, phase_of, retime, start, swing_of, touch_down
from walking.plan.steering import (
    follow_command,
    moves,
    put_command,
    set_wanted_strides,
    twist_of,
    use_next_timing,
)
from walking.plane import norm, rotate_back


@compiled
def follow(walk: Data, command: StepValues, explicit: bool, robot: Model) -> int:
    """Follow the command, and give the footsteps their timing; return the limits that bind.

    Args:
        walk: state, changed.
        command: velocity (vx, vy, wz), or an explicit footstep.
        explicit: whether the command is a footstep.
        robot: constants.
    """
    steering, gait, timing = walk.steering, walk.plan.gait, walk.admission.between
    put_command(steering.command, command, explicit)
    off = norm(walk.error.dcm_x, walk.error.dcm_y)
    balanced = off < robot.stabilizer.max_slew_error
    ratio = speed_ratio(walk.corrections, off, robot)
    bound = follow_command(steering, ratio, is_settled(walk, robot), balanced, robot)
    use_next_timing(timing, steering, gait.clock.timing, gait.stepping)
    return bound if retime(gait, timing, robot) else bound | TIMING


@compiled
def is_settled(walk: Data, robot: Model) -> bool:
    """Whether the robot may start to move."""
    return walk.ticks * CONTROL_PERIOD > robot.gait.settle_time


@compiled
def want_strides(walk: Data, odometry: DeadReckoning, robot: Model) -> None:
    """Set the wanted strides, corrected for slip of the feet."""
    corrections, steering, error = walk.corrections, walk.steering, walk.error
    gait = walk.plan.gait
    ahead = walk.limbs.pelvis.yaw - odometry.yaw
    if not gait.stepping:
        # While standing the planned heading follows the measured one.
        corrections.held = ahead
        restart_cycle(corrections)
    if not (gait.stepping and moves(steering)):
        # The last footsteps only close the stance.
        end_corrections(corrections)
        set_wanted_strides(steering, STILL, robot)
        return
    shift = landed_shift(corrections, walk.placing.shift, gait.support)
    begins = cycle_begins(corrections, gait.support)
    disturbed = gait.shortened or norm(*shift) > robot.stabilizer.max_steady_shift
    pressure = (error.pressure_x, error.pressure_y)
    correct_offset(corrections, pressure, error.pressed, begins, disturbed, robot)
    pose = (odometry.x, odometry.y, odometry.yaw)
    planned = (walk.pendulum.x, walk.pendulum.y, walk.limbs.pelvis.yaw)
    vx, vy = speed_correction(corrections, pose, planned, shift, begins, robot)
    wz = heading_rate(corrections, ahead, begins or disturbed, robot)
    set_wanted_strides(steering, (vx, vy, wz), robot)


@compiled
def start_walk(walk: Data, robot: Model) -> int:
    """Take a first footstep if the command or balance requires it; return the limits that bind."""
    gait = walk.plan.gait
    if gait.stepping or not is_settled(walk, robot):
        return 0
    moving, bound = moves(walk.steering), 0
    pushed = exceeds_support(walk, robot.stabilizer.step_error_ratio, robot)
    if not (moving or pushed):
        return 0
    sideways = tendency(twist_of(walk.steering.velocity), robot)
    opening_left = sideways > 0.0
    if pushed:
        # Only the foot on the side of the fall can make the capture step.
        if not moving:
            bound |= BALANCE
        _, aside = rotate_back(gait.footholds[LEFT].yaw, walk.error.dcm_x, walk.error.dcm_y)
        opening_left = aside > 0.0
    elif sideways == 0.0:
        opening_left = not walk.last_opening_left
    walk.last_opening_left = opening_left
    start(gait, RIGHT if opening_left else LEFT, pushed, robot)
    return bound if retime(gait, walk.steering.timing, robot) else bound | TIMING


@compiled
def detect_touchdown(walk: Data, robot: Model) -> None:
    """Stop the swing foot on early touchdown; off balance, end the single support with it.

    A support that waited for its planned end would let the error of the DCM grow over one foot
    while both are on the floor. An error within the margins of the sole waits: legs that give way
    touch down a little early in every footstep, and supports that all ended early would keep the
    error going.
    """
    gait, within_sole = walk.plan.gait, 1.0 - robot.stabilizer.capture_dead_zone
    phase = phase_of(gait)
    if not phase.double and not gait.landed_early:
        force = walk.body.feet[swing_of(gait)].load
        if detects_touchdown(walk.corrections, phase.swing, force, robot) and phase.swing < 1.0:
            touch_down(gait, walk.limbs.feet, robot)
            off_balance = gait.shortened or excess_error(walk, robot) > within_sole
            if off_balance and not robot.modifiable:
                end_support(gait)
