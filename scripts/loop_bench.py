"""One run of the closed loop, timed stage by stage, in turn with the floor under it.

The floor is MuJoCo stepping the same model with constant controls and rendering as many
images. It runs in turn with the loop, second by second, so that the ratio of the two holds
on any machine and while other work comes and goes. Times are processor time; the time of
the threads that draw and write in parallel is listed separately and included in the total, as are
garbage collections. The first call of each stage is left out: it loads compiled code.
"""

import hsr8  # noqa: F401  before MuJoCo: it chooses the OpenGL to draw with

# isort: split
import tempfile
from contextlib import closing
from pathlib import Path

from hsr8.driver import Recording
from hsr8.process.gl import require_gl
from hsr8.recording.recorder import Recorder
from hsr8.recording.run_folder import RunFolder
from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.scenario.schema import Scenario
from hsr8.simulation.loop import Simulation
from hsr8.simulation.record import Tick
from hsr8.world.body.physics import place_robot
from hsr8.world.camera.image_noise import ImageNoise
from hsr8.world.camera.offscreen import Offscreen
from hsr8.world.camera.rendered import RenderedCamera
from walking.parameters import CONTROL_PERIOD

import mujoco
import numpy as np
from stopwatch import Stopwatch

FLOOR = ("floor: physics", "floor: images")
REST, COLLECTIONS = "the rest of the loop", "garbage collections"
PARALLEL, WHOLE = "parallel threads", "whole loop"
SECOND = 1.0  # the floor has its turn after so much simulated time [s]


class Floor:
    """Steps and renders the bare model for as long as the loop has run."""

    def __init__(self, simulation: Simulation) -> None:
        model = simulation.model
        self._model, self._data = model, mujoco.MjData(model)
        place_robot(model, self._data, simulation.humanoid, np.array(simulation.layout.start))
        camera = simulation.scenario.camera
        self._rendered = camera.source == "rendered"
        self._renderer = mujoco.Renderer(model, camera.height, camera.width)
        self._steps = round(CONTROL_PERIOD / model.opt.timestep)
        self._images = 0
        self._from = 0.0

    def on_tick(self, tick: Tick) -> None:
        """Take the turn when it is due."""
        record = tick.record
        if record is None:
            return
        self._images += self._rendered and record.frame is not None
        if record.time - self._from < SECOND - 1e-9:
            return
        for _ in range(round((record.time - self._from) / CONTROL_PERIOD)):
            self.physics()
        for _ in range(self._images):
            self.image()
        self._images, self._from = 0, record.time

    def physics(self) -> None:
        """One control tick."""
        mujoco.mj_step(self._model, self._data, self._steps)

    def image(self) -> None:
        """One image."""
        self._renderer.update_scene(self._data, camera=HEAD_CAMERA)
        self._renderer.render()

    def close(self) -> None:
        """Free the OpenGL context."""
        self._renderer.close()


class Bench:
    """One run, timed.

    Attributes:
        watch: time of every stage.
        simulated: [s].
    """

    def __init__(self, scenario: Scenario, seed: int) -> None:
        simulation = Simulation(scenario, seed)
        floor = Floor(simulation)
        with tempfile.TemporaryDirectory() as out, Stopwatch() as watch:
            path = RunFolder.create(Path(out), scenario.name, seed)
            folder = RunFolder(path, simulation.scenario, ("bench",), require_gl())
            self.watch = watch
            self._watch(simulation)
            with closing(floor), Recording(simulation, folder) as recording:
                for tick in simulation:
                    recording.append(tick)
                    floor.on_tick(tick)
            self.simulated = recording.run().metrics["sim_time_s"]
        self.floor = watch.total(*FLOOR) + watch.beside(*FLOOR)
        stages = [stage for stage in watch.times if stage not in FLOOR]
        self.beside = watch.beside(*stages)
        self.collections = sum(watch.collections)
        self.loop = watch.total(*stages) + self.collections + self.beside

    @property
    def ratio(self) -> float:
        """Loop over floor [1]."""
        return self.loop / self.floor

    def ratios(self) -> dict[str, float]:
        """Of every stage and of the whole, over the floor [1]."""
        stages = [stage for stage in self.watch.times if not stage.startswith("floor")]
        result = {stage: self.watch.total(stage) / self.floor for stage in stages}
        sums = {COLLECTIONS: self.collections, PARALLEL: self.beside, WHOLE: self.loop}
        return result | {name: total / self.floor for name, total in sums.items()}

    def table(self) -> list[str]:
        """Rows of the stages, the floor last."""
        lines = [
            "| stage | calls | mean [ms] | p99 [ms] | per simulated second [ms] | over the floor |",
            "|---|---|---|---|---|---|",
        ]
        for stage in self.watch.times:
            calls, mean, late = self.watch.row(stage)
            if not calls or stage == REST:
                continue
            total = self.watch.total(stage)
            if stage in FLOOR:
                total += self.watch.beside(stage)
            lines.append(
                f"| {stage} | {calls} | {mean:.3f} | {late:.3f} | "
                f"{1e3 * total / self.simulated:.1f} | {total / self.floor:.3f} |"
            )
        sums = {
            REST: self.watch.total(REST),
            COLLECTIONS: self.collections,
            PARALLEL: self.beside,
            WHOLE: self.loop,
        }
        for name, total in sums.items():
            lines.append(
                f"| {name} | | | | {1e3 * total / self.simulated:.1f} | {total / self.floor:.3f} |"
            )
        return lines

    def _watch(self, simulation: Simulation) -> None:
        """Watch every stage by the classes that this run has made."""
        robot = simulation._robot
        parts = vars(robot) | vars(robot._decisions)
        stages = [
            (type(simulation), "step", REST),
            (type(simulation._body), "sense", "sense"),
            (type(parts["walking"]), "step", "walking tick"),
            (type(parts["walking"]), "state", "walking state"),
            (type(simulation._body), "apply", "physics"),
            (type(simulation._body), "truth", "truth"),
            (RenderedCamera, "capture", "draw"),
            (Offscreen, "read", "read"),
            (ImageNoise, "apply", "image noise"),
            (type(parts["_vision"]), "detect", "vision"),
            (type(parts["_belief"]), "update", "belief"),
            (type(parts["_mission"]), "update", "mission"),
            (type(parts["_planner"]), "plan", "planner"),
            (type(parts["_gaze"]), "choose", "gaze"),
            (Recorder, "append", "tables"),
            (Floor, "on_tick", "floor: its own turn"),
            (Floor, "physics", FLOOR[0]),
            (Floor, "image", FLOOR[1]),
        ]
        for owner, method, stage in stages:
            self.watch.watch(owner, method, stage)
