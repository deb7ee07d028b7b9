"""Vision while walking, against the truth: full physics, noisy images, segmentation.

    python scripts/vision_study.py --seeds 0:4 --duration 60
    python scripts/vision_study.py --seeds 0 --set world.brightness=0.4

Prints recall, false detections, and errors with their claimed standard deviations by distance, and
the errors of the camera pose. The analytic camera has errors of this size.
"""

import argparse
import os
from contextlib import closing
from math import atan2, hypot

os.environ.setdefault("MUJOCO_GL", "egl")

from hsr8.robots.loaded import load_robot
from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation
from hsr8.simulation.record import TickRecord
from hsr8.world.model.index import ModelIndex

import mujoco
import numpy as np
from study import seeds
from vision_score import Study
from vision_truth import Array, Target, sights


class Referee:
    """Comparison of every frame of a run with the truth.

    Args:
        simulation: the run.
        study: counts of all frames.
        verbose: print every mistake.

    Attributes:
        pose_errors: errors of the believed camera pose in every frame, see `pose_error`.
    """

    def __init__(self, simulation: Simulation, study: Study, verbose: bool) -> None:
        self.layout = layout = simulation.layout
        self.study = study
        self.verbose = verbose
        self.model = simulation.model
        self.data = mujoco.MjData(self.model)
        camera, robot = simulation.scenario.camera, load_robot(simulation.scenario.robot.model)
        counts = len(layout.static), len(layout.movers)
        self.index = ModelIndex.of(self.model, robot, *counts)
        self.pinhole = camera.pinhole
        self.renderer = mujoco.Renderer(self.model, camera.height, camera.width)
        self.renderer.enable_segmentation_rendering()
        self.camera = self.model.camera(HEAD_CAMERA).id
        self.pose_errors: list[tuple[float, ...]] = []

    def on_record(self, record: TickRecord) -> None:
        """Judge the frame of a record, if it has one.

        Raises:
            SystemExit: the frame was taken before its record.
        """
        if record.frame is None:
            return
        if abs(record.frame.measured.time - record.time) > 1e-9:
            raise SystemExit("camera.latency_ms: this study requires 0, and frames at records")
        data, truth = self.data, record.truth
        data.qpos[:] = truth.qpos
        movers = truth.obstacle_positions[len(self.layout.static) :]
        data.mocap_pos[self.index.mover_mocap, :2] = movers
        mujoco.mj_kinematics(self.model, data)
        mujoco.mj_comPos(self.model, data)
        mujoco.mj_camlight(self.model, data)
        x, y, heading = truth.robot.tolist()
        c, s = np.cos(heading), np.sin(heading)
        R_RW = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        R_RC = R_RW @ (data.cam_xmat[self.camera].reshape(3, 3) * (1.0, -1.0, -1.0))
        p_RC = R_RW @ (data.cam_xpos[self.camera] - (x, y, 0.0))
        view = record.frame.measured.view
        self.pose_errors.append(pose_error(view.rotation, view.position, R_RC, p_RC))
        if view.blind:  # vision reports nothing
            return
        self.renderer.update_scene(data, camera=HEAD_CAMERA)
        geoms = self.renderer.render()[:, :, 0]
        truth_sights = sights(
            geoms, R_RC, p_RC, self.targets(truth.obstacle_positions, R_RW, x, y), self.pinhole
        )
        mistakes = self.study.judge(record.frame.detections, truth_sights)
        if mistakes and self.verbose:
            print(f"{record.time:.2f} s", *mistakes, sep="\n    ")

    def targets(self, positions: Array, R_RW: Array, x: float, y: float) -> list[Target]:
        """Return all obstacles and beacons in the true robot frame R.

        Args:
            positions: true positions of the obstacles in W (n, 2) [m].
            R_RW: rotation from W to R (3, 3).
            x: position of the robot in W [m].
            y: position of the robot in W [m].
        """
        layout, index = self.layout, self.index
        cylinders = [
            *(("obstacle", o.color, o) for o in layout.obstacles),
            *(("beacon", b.name, b) for b in layout.beacons),
        ]
        centres = [*positions.tolist(), *(b.position for b in layout.beacons)]
        geoms = [*index.obstacle_geoms[:, None].tolist(), *index.beacon_geoms.tolist()]
        targets = []
        for (kind, label, shape), centre, parts in zip(cylinders, centres, geoms, strict=True):
            ahead, left, _ = (R_RW @ np.array([centre[0] - x, centre[1] - y, 0.0])).tolist()
            size = shape.radius, shape.height
            targets.append(Target(kind, label, ahead, left, *size, tuple(parts)))
        return targets

    def close(self) -> None:
        """Free the renderer."""
        self.renderer.close()


def pose_error(
    believed_R: Array, believed_p: Array, true_R: Array, true_p: Array
) -> tuple[float, float, float, float, float]:
    """Return the errors of the believed camera: tilt, roll, yaw [rad], height and offset [m].

    Args:
        believed_R: believed rotation of the camera in R (3, 3).
        believed_p: believed position of the camera in R (3,) [m].
        true_R: true rotation (3, 3).
        true_p: true position (3,) [m].
    """
    turn = believed_R @ true_R.T
    w = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    heading = atan2(true_R[1, 0], true_R[0, 0]) + 0.5 * np.pi
    c, s = np.cos(heading), np.sin(heading)
    tilt, roll = s * w[0] - c * w[1], c * w[0] + s * w[1]
    dx, dy, dz = (believed_p - true_p).tolist()
    return float(tilt), float(roll), float(w[2]), dz, hypot(dx, dy)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--scenario", default="course")
    parser.add_argument("--seeds", type=seeds, default=(0,), metavar="A:B")
    parser.add_argument("--duration", type=float, default=30.0)
    parser.add_argument("--set", action="append", default=[], help="KEY=VALUE of the scenario")
    parser.add_argument("--verbose", action="store_true", help="print every mistake")
    args = parser.parse_args()
    study = Study()
    errors = []
    for seed in args.seeds:
        scenario = load_scenario(args.scenario, [f"duration={args.duration}", *args.set])
        simulation = Simulation(scenario, seed)
        referee = Referee(simulation, study, args.verbose)
        with simulation, closing(referee):
            for tick in simulation:
                if tick.record is not None:
                    referee.on_record(tick.record)
        errors += referee.pose_errors
    e = np.array(errors)
    rms, mean = np.sqrt(np.mean(e**2, axis=0)), e.mean(axis=0)
    print(f"{len(e)} frames; camera pose, rms (mean):")
    for name, unit, scale, k in (
        ("tilt", "mrad", 1e3, 0),
        ("roll", "mrad", 1e3, 1),
        ("yaw", "mrad", 1e3, 2),
        ("height", "mm", 1e3, 3),
        ("offset", "mm", 1e3, 4),
    ):
        print(f"    {name:8s}{scale * rms[k]:7.2f} ({scale * mean[k]:+.2f}) {unit}")
    study.report()


if __name__ == "__main__":
    main()
