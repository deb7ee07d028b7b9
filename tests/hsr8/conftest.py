"""A short run, and fixtures that stand in for the loop: a small world and records of it."""

import ctypes
import shutil
from math import cos, sin
from types import SimpleNamespace

import numpy as np
import pyarrow as pa
import pytest

from hsr8.cli.main import entry
from hsr8.recording.recorded import FrameSampler
from hsr8.recording.rows import TABLES
from hsr8.recording.run import open_run
from hsr8.recording.table import Table
from hsr8.robots.loaded import load_robot
from hsr8.simulation.decisions import Decision, DecisionContext, FrameRecord
from hsr8.simulation.record import TickRecord
from hsr8.sweep.job import run_job
from hsr8.world.field.layout import Beacon, Layout, Obstacle
from hsr8.world.field.motion import Shuttle
from hsr8.world.model.assembly import Optics, assemble
from hsr8.world.truth.truth import Contact, Truth
from navigation.belief.belief import Belief, Motion, Track
from navigation.belief.local_map import LocalMap
from navigation.decision import GazeDecision, MotionDecision, Task, VirtualObstacle
from navigation.observation import CameraModel, CameraView, Frame
from navigation.parameters.belief import LocalMapParameters
from vision.detection import Detection
from walking.body.tree import JOINT_NAMES
from walking.command import HeadTarget, VelocityCommand
from walking.estimate.odometry import Odometry
from walking.plan.footsteps import Foothold
from walking.state import Balance, HeadCameraPose, Phase, WalkingState

NQ = 33
READY = np.concatenate([[0.0, 0.0, 0.245, 1.0, 0.0, 0.0, 0.0], np.zeros(NQ - 7)])
BEACONS = (
    Beacon("yellow/cyan", (2.3, 0.0), "yellow", "cyan"),
    Beacon("magenta/cyan", (-2.3, 1.0), "magenta", "cyan"),
)
ROTATION = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])


@pytest.fixture(scope="session")
def quick_runs(tmp_path_factory):
    """Folder with a run of one second of `quick`, kinematic and without images, to read only."""
    out = tmp_path_factory.mktemp("runs")
    fast = ["--body", "kinematic", "--camera", "analytic", "--duration", "1", "--quiet"]
    assert entry(["run", "quick", *fast, "--out", str(out)]) == 1
    return out


@pytest.fixture
def quick_run(quick_runs, tmp_path_factory):
    """Copy of that run, in the folder `quick` of a folder of runs."""
    return open_run(shutil.copytree(quick_runs, tmp_path_factory.mktemp("copy") / "runs"))


class InThisProcess:
    """Pool that does its runs in this process."""

    free = 1

    def __init__(self, *_):
        self.jobs = []

    def submit(self, job):
        self.jobs.append(job)

    def wait(self, _seconds):
        job = self.jobs.pop()
        return [(job, run_job(job) | {"seed": job.seed, "run": job.run, "attempts": job.attempt})]

    def close(self):
        """Leave the runs that have not begun."""


@pytest.fixture
def sweeps_in_process(monkeypatch):
    """Replace the pool of processes, which takes seconds to start."""
    monkeypatch.setattr("hsr8.sweep.runs.open_pool", InThisProcess)


@pytest.fixture(scope="session")
def layout():
    """Two static obstacles and a mover, a via point and a goal."""
    mover = Shuttle((1.0, -1.0), (1.0, 1.0), 0.1)
    return Layout(
        field_size=(4.0, 4.0),
        obstacles=(
            Obstacle((0.8, 0.6), 0.10, 0.30, "red"),
            Obstacle((-0.7, 0.2), 0.06, 0.30, "green"),
            Obstacle((1.0, -1.0), 0.08, 0.30, "blue", mover),
        ),
        beacons=BEACONS,
        start=(0.0, 0.0, 0.0),
        waypoints=np.array([[1.0, 0.0], [1.5, 1.0]]),
        goal_heading=1.0,
        endless=False,
    )


@pytest.fixture(scope="session")
def model(layout):
    return assemble(load_robot("hsr8"), layout, "vision", Optics())


def _track(layout, index, time, error=(0.0, 0.0), velocity=None):
    obstacle = layout.obstacles[index]
    motion = obstacle.motion
    position = motion.position(time) if motion else obstacle.position
    moving = (0.0, 0.0) if motion is None else motion.velocity(time)
    return Track(
        id=index,
        label=obstacle.color,
        position=np.add(position, error),
        velocity=np.array(moving if velocity is None else velocity),
        covariance=np.diag([4e-4, 1e-4, 1e-4, 1e-4]),
        radius=obstacle.radius,
        radius_sigma=0.01,
        motion=Motion.STATIC if motion is None else Motion.MOVING,
        hits=10,
        age=0.0,
        last_seen=np.array(position),
        visible=index == 0,
    )


def _frame(layout, time, pose, **change):
    """Camera frame at a believed `pose`; every part can be replaced."""
    belief = {
        "time": time,
        "pose": np.asarray(pose, float),
        "pose_covariance": np.diag([1e-4, 1e-4, 1e-4]),
        "tracks": tuple(_track(layout, i, time) for i in range(len(layout.obstacles))),
        "local_map": LocalMap(LocalMapParameters(), (float(pose[0]), float(pose[1])), time),
        "view": CameraView(ROTATION, np.array([0.0, 0.0, 0.47]), 0.0, -0.3, CameraModel(1.5, 1.22)),
        "seen_beacons": (),
        "lost": False,
        "filter_faults": 0,
    }
    gaze_map = np.zeros((17, 37))
    gaze_map[4:9, 10:20] = 1.0
    task = {
        "target": layout.waypoints[0],
        "heading": 0.0,
        "is_goal": False,
        "index": 0,
        "aligning": False,
        "done": False,
    }
    task |= {k: v for k, v in change.items() if k in task}
    belief |= {k: v for k, v in change.items() if k in belief}
    return FrameRecord(
        index=round(time / 0.06),
        time=time,
        image=change.get("image", np.full((240, 320, 3), 128, np.uint8)),
        detections=(
            Detection(
                kind="obstacle",
                label="red",
                bearing=0.1,
                distance=1.0,
                covariance=np.eye(2) * 1e-4,
                radius=0.1,
                radius_sigma=0.01,
                by_radius=np.zeros(2),
                cut=False,
                occluded=False,
                box=(100, 80, 140, 160),
            ),
        ),
        measured=Frame(time, np.asarray(pose, float), np.zeros((3, 3)), belief["view"], ()),
        estimate=Belief(**belief),
        context=DecisionContext(time, np.asarray(pose, float), belief["view"], 3),
        decision=Decision(
            belief=Belief(**belief),
            gaze=GazeDecision(0.3, -0.3, 0.2, 0.4, 0.6, 0.1, gaze_map),
            motion=MotionDecision(
                velocity=np.array([0.2, 0.0, 0.1]),
                direction=0.0,
                speed=0.2,
                situation="free",
                virtual_obstacles=(VirtualObstacle(np.array([1.0, 0.2]), 0.2, 2),),
                extended_radii=((0, 0.4),),
            ),
            task=Task(**task),
            fresh=time == 0.0,
        ),
    )


def _balance(x, y, yaw):
    """Standing on both feet, the planned ZMP 2 cm inside."""
    sole = np.array([[0.06, -0.07], [0.06, 0.07], [-0.04, 0.07], [-0.04, -0.07]])
    return Balance(
        com=np.array([x, y]),
        dcm=np.array([x, y]),
        support=sole + np.array([x, y]),
        zmp_depth=0.02,
        feet=np.array([[x, y + 0.042, 0.0, yaw], [x, y - 0.042, 0.0, yaw]]),
        capture=np.zeros(2),
    )


def _record(layout, time, pose=(0.0, 0.0, 0.0), *, contacts=(), fallen=False, frame=None, **truth):
    """Record of a robot truly at `pose`; contacts are obstacle indices."""
    x, y, yaw = pose
    qpos = READY.copy()
    qpos[:2] = x, y
    qpos[3], qpos[6] = cos(yaw / 2), sin(yaw / 2)
    moving = [o.motion for o in layout.obstacles]
    positions = [o.motion.position(time) if o.motion else o.position for o in layout.obstacles]
    fields = {
        "time": time,
        "qpos": qpos,
        "robot": np.asarray(pose, float),
        "obstacle_positions": np.array(positions),
        "obstacle_velocities": np.array([m.velocity(time) if m else (0.0, 0.0) for m in moving]),
        "mover_clocks": np.zeros(0),
        "contacts": tuple(
            Contact(
                obstacle=i,
                name=f"obstacle {i}",
                moving=layout.obstacles[i].motion is not None,
                robot_geom="l_sole",
                force=3.0,
                closing=layout.obstacles[i].motion is None,
            )
            for i in contacts
        ),
        "clearance": 0.5,
        "joint_torque": np.zeros(26),
        "foot_force": np.array([17.0, 17.0]),
        "zmp": np.array([x, y]),
        "fallen": fallen,
    }
    return TickRecord(
        tick=round(time / 0.005),
        time=time,
        truth=Truth(**(fields | truth)),
        walking=WalkingState(
            phase=Phase.LEFT_SUPPORT if int(time / 0.34) % 2 else Phase.RIGHT_SUPPORT,
            odometry=Odometry(x, y, yaw, np.zeros((3, 3))),
            camera=HeadCameraPose(ROTATION, np.array([0.0, 0.0, 0.47]), 0.0, -0.3),
            applied_velocity=np.array([0.2, 0.0, 0.0]),
            footsteps=(
                Foothold(True, x, y + 0.035, yaw),
                Foothold(False, x + 0.05, y - 0.035, yaw),
            ),
            zmp=np.array([x, y]),
            dcm=np.array([x, y]),
            com=np.array([x, y]),
            roll=0.01,
            pitch=0.02,
            step_count=int(time / 0.34),
            fallen=fallen,
            balance=_balance(x, y, yaw),
        ),
        command=VelocityCommand(0.2, 0.0, 0.0),
        head=HeadTarget(),
        frame=frame,
    )


@pytest.fixture(scope="session")
def fake(layout):
    """What the loop would publish: ``record``, ``frame`` and ``track`` of any moment."""
    return SimpleNamespace(
        record=lambda time, pose=(0.0, 0.0, 0.0), **change: _record(layout, time, pose, **change),
        frame=lambda time, pose=(0.0, 0.0, 0.0), **change: _frame(layout, time, pose, **change),
        track=lambda index, time, **change: _track(layout, index, time, **change),
    )


@pytest.fixture(scope="session")
def walk(fake):
    """Records of a straight walk at 0.2 m/s, 50 Hz with a camera frame every 60 ms."""

    def records(duration, **change):
        for k in range(round(duration * 50) + 1):
            time = k * 0.02
            pose = (0.2 * time, 0.0, 0.0)
            frame = fake.frame(time, pose) if k % 3 == 0 else None
            yield fake.record(time, pose, frame=frame, **change)

    return records


@pytest.fixture(scope="session")
def rewrite():
    """Change one value of a table of a run."""

    def changed(run, table, column, row, change):
        path = run / f"{table}.arrows"
        with pa.ipc.open_stream(path.read_bytes()) as reader:
            arrow = reader.read_all()
        values = arrow.column(column).to_pylist()
        values[row] = change(values[row])
        field = arrow.schema.field(column)
        place = arrow.schema.get_field_index(column)
        arrow = arrow.set_column(place, field, pa.array(values, field.type))
        with pa.ipc.new_stream(path, arrow.schema) as writer:
            writer.write_table(arrow)

    return changed


def _table(name, objects):
    return Table.from_objects(name, TABLES[name], objects, {"joints": JOINT_NAMES})


@pytest.fixture(scope="session")
def tables_of():
    """Tables of a run, from records, seconds and columns of ``ticks``."""

    def tables(records=(), seconds=(), **ticks):
        records, sampler = list(records), FrameSampler()
        return {
            "records": _table("records", records),
            "frames": _table("frames", [sampler.sample(r.frame) for r in records if r.frame]),
            "seconds": _table("seconds", list(seconds)),
            "ticks": Table("ticks", pa.table(ticks)) if ticks else _table("ticks", []),
        }

    return tables


@pytest.fixture
def bound_by_file_modes():
    """Root, too, may read only what the mode of a file allows."""
    libc = ctypes.CDLL(None)
    header = (ctypes.c_uint32 * 2)(0x20080522, 0)  # version 3, this thread
    held = (ctypes.c_uint32 * 6)()  # effective, permitted and inheritable, twice
    assert libc.capget(header, held) == 0
    lowered = (ctypes.c_uint32 * 6)(*held)
    lowered[0] &= ~(1 << 1 | 1 << 2)  # CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH
    assert libc.capset(header, lowered) == 0
    yield
    assert libc.capset(header, held) == 0
