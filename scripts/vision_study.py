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

from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation
from hsr8.simulation.record import TickRecord
from hsr8.world.model.assembly import FIELD

import mujoco
import numpy as np
from study import seeds
from vision_score import Study
from vision_truth import Array, Target, sights


class Referee:
    """Listens to a run and compares every frame with the truth.

    Args:
        simulation: the run.
        study: counts of all frames.
        verbose: print every mistake.
    """

    def __init__(self, simulation: Simulation, study: Study, verbose: bool) -> None:
        self.layout = simulation.layout
        self.study = study
        self.verbose = verbose
        self.model = simulation.model
        self.data = mujoco.MjData(self.model)
        camera = simulation.scenario.camera
        self.pinhole = camera.pinhole
        self.renderer = mujoco.Renderer(self.model, camera.height, camera.width)
        self.renderer.enable_segmentation_rendering()
        self.camera = self.model.camera(HEAD_CAMERA).id
        self.pose_errors: list[tuple[float, ...]] = []

    def on_record(self, record: TickRecord) -> None:
        """Judge the frame of this record, if there is one."""
        if record.frame is None:
            return
        if abs(record.frame.measured.time - record.time) > 1e-9:
            raise SystemExit("this study needs camera.latency_ms = 0 and frames at records")
        data, truth = self.data, record.truth
        data.qpos[:] = truth.qpos
        static = len(self.layout.static)
        if len(self.layout.movers):
            data.mocap_pos[:, :2] = truth.obstacle_positions[static:]
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
        """All cylinders in the true robot frame."""
        visible = []
        shapes = [
            *((o.color, o.radius, o.height) for o in self.layout.obstacles),
            *((b.name, b.radius, b.height) for b in self.layout.beacons),
        ]
        places = [*positions.tolist(), *(b.position for b in self.layout.beacons)]
        static = len(self.layout.static)
        for i, ((label, radius, height), position) in enumerate(zip(shapes, places, strict=True)):
            obstacle = i < len(self.layout.obstacles)
            if not obstacle:
                top, bottom = label.split("/")
                name = f"{FIELD}beacon_{top}_{bottom}"
            else:
                name = (
                    f"{FIELD}obstacle_{i:02d}" if i < static else f"{FIELD}mover_{i - static:02d}"
                )
            body = self.model.body(name)
            first = int(body.geomadr[0])
            geoms = tuple(range(first, first + int(body.geomnum[0])))
            forward, left, _ = (R_RW @ np.array([position[0] - x, position[1] - y, 0.0])).tolist()
            kind = "obstacle" if obstacle else "beacon"
            visible.append(Target(kind, label, forward, left, radius, height, geoms))
        return visible

    def close(self) -> None:
        """Free the renderer."""
        self.renderer.close()


def pose_error(
    believed_R: Array, believed_p: Array, true_R: Array, true_p: Array
) -> tuple[float, float, float, float, float]:
    """Tilt, roll, yaw [rad], height and horizontal offset [m] of the believed camera."""
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
