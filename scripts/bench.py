"""Processor time of the closed loop, stage by stage, and its ratio to the floor under it.

    python scripts/bench.py                       # `course`, 40 s
    python scripts/bench.py --check               # against the kept ratios

The floor is MuJoCo stepping the same model with constant controls and rendering as many images. It
runs in turn with the loop, second by second, so that the ratio of the two holds on any machine and
while other work runs. Times are processor time of all threads. A second run under cProfile, which
slows Python down, measures the stages, each with the stages that it calls.
"""

import hsr8  # noqa: F401  before MuJoCo: it chooses the OpenGL to draw with

# isort: split
import argparse
import cProfile
import gc
import json
import pstats
import tempfile
from contextlib import closing, nullcontext
from importlib.metadata import version
from pathlib import Path
from time import process_time

from hsr8.cli.main import COLLECT_AFTER
from hsr8.driver import Recording
from hsr8.files import atomic
from hsr8.process.gl import require_gl
from hsr8.recording.run_folder import RunFolder
from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.simulation.loop import Simulation
from hsr8.simulation.record import Tick
from hsr8.world.body.physics import place_robot
from hsr8.world.camera.rendered import RenderedCamera
from walking.parameters import CONTROL_PERIOD

import mujoco
import numpy as np

BASELINE = Path(__file__).with_name("loop-ratios.json")
PACKAGES = ("hsr8", "mujoco", "numba", "numpy")
CHECKED = ("course", 5, "duration=8")  # scenario, seed and length that the check runs
SLOWER = 1.2  # ratio to the baseline from which a stage is reported [1]
SMALL = 0.04  # stages below this are not checked: chance changes them as much [floors]
LOOP, FLOOR = "whole loop", "floor"
SECOND = 1.0  # the floor has its turn after so much simulated time [s]


class Floor:
    """Steps and renders the bare model for as long as the loop has run.

    Attributes:
        seconds: processor time so far [s].
    """

    def __init__(self, simulation: Simulation) -> None:
        model, camera = simulation.model, simulation.scenario.camera
        self._model, self._data = model, mujoco.MjData(model)
        place_robot(model, self._data, simulation.humanoid, np.array(simulation.layout.start))
        self._rendered = camera.source == "rendered"
        self._renderer = mujoco.Renderer(model, camera.height, camera.width)
        self._ticks = self._images = 0
        self.seconds = 0.0

    def on_tick(self, tick: Tick) -> None:
        """Count a tick; take the turn when it is due."""
        self._ticks += 1
        self._images += self._rendered and tick.record is not None and tick.record.frame is not None
        if self._ticks * CONTROL_PERIOD >= SECOND:
            self.run()
            self._ticks = self._images = 0

    def run(self) -> None:
        """Compute all ticks and images since the last turn."""
        begin = process_time()
        for _ in range(self._ticks):
            mujoco.mj_step(
                self._model, self._data, round(CONTROL_PERIOD / self._model.opt.timestep)
            )
        for _ in range(self._images):
            self._renderer.update_scene(self._data, camera=HEAD_CAMERA)
            self._renderer.render()
        self.seconds += process_time() - begin

    def close(self) -> None:
        """Free the OpenGL context."""
        self._renderer.close()


def timed(simulation: Simulation, profiler: cProfile.Profile | None = None) -> tuple[float, float]:
    """Run and record a simulation; return the processor time of the loop and of the floor [s]."""
    scenario = simulation.scenario
    with tempfile.TemporaryDirectory() as out:
        path = RunFolder.create(Path(out), scenario.name, scenario.seed)
        folder = RunFolder(path, scenario, ("bench",), require_gl())
        with closing(Floor(simulation)) as floor, Recording(simulation, folder) as recording:
            begin = process_time()
            with profiler or nullcontext():
                for tick in simulation:
                    recording.append(tick)
                    floor.on_tick(tick)
            return process_time() - begin - floor.seconds, floor.seconds


def profile(scenario: Scenario) -> dict[str, tuple[int, float]]:
    """Return calls and processor time [s] of the loop, the floor and every stage."""
    loop, floor = timed(Simulation(scenario))
    simulation, profiler = Simulation(scenario), cProfile.Profile(process_time)
    timed(simulation, profiler)
    stats = pstats.Stats(profiler).stats
    robot, body = simulation._robot, type(simulation._body)
    parts = {name: type(part) for name, part in (vars(robot) | vars(robot._decisions)).items()}
    stages = {
        "sense": body.sense,
        "walking tick": parts["walking"].step,
        "walking state": parts["walking"].state,
        "physics": body.apply,
        "truth": body.truth,
        "draw": RenderedCamera.capture,
        "vision": parts["_vision"].detect,
        "belief": parts["_belief"].update,
        "mission": parts["_mission"].update,
        "planner": parts["_planner"].plan,
        "gaze": parts["_gaze"].choose,
        "tables": Recording.append,
    }
    result = {LOOP: (1, loop), FLOOR: (1, floor)}
    for name, method in stages.items():
        code = method.__code__
        key = code.co_filename, code.co_firstlineno, code.co_name
        if key in stats:
            calls, _, _, seconds, _ = stats[key]
            result[name] = calls, seconds
    return result


def ratios(scenario: Scenario) -> dict[str, float]:
    """Return the ratio of every stage to the floor [1]."""
    stages = profile(scenario)
    _, floor = stages.pop(FLOOR)
    return {name: seconds / floor for name, (_, seconds) in stages.items()}


def slower(measured: dict[str, float], kept: dict[str, float]) -> list[str]:
    """Return a line for every stage that is much slower than it was."""
    return [
        f"{stage}: {ratio:.2f} floors, {ratio / kept[stage] - 1.0:.0%} above {kept[stage]:.2f}"
        for stage, ratio in measured.items()
        if stage in kept and ratio > SLOWER * kept[stage] and ratio > SMALL
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenario", default="course")
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--duration", type=float, default=40.0, help="simulated [s]")
    parser.add_argument("--set", action="append", default=[], help="KEY=VALUE of the scenario")
    parser.add_argument("--check", action="store_true", help=f"compare with {BASELINE.name}")
    parser.add_argument("--keep", action="store_true", help=f"write {BASELINE.name}")
    options = parser.parse_args()
    gc.set_threshold(COLLECT_AFTER)
    name, seed, settings = options.scenario, options.seed, [f"duration={options.duration:g}"]
    if options.check or options.keep:
        name, seed, *settings = CHECKED
    Simulation(load_scenario(name, ["duration=3"], seed), seed).run()  # all kernels are compiled
    scenario = load_scenario(name, [*settings, *options.set], seed)
    if options.keep:
        measured = {stage: round(ratio, 3) for stage, ratio in ratios(scenario).items()}
        versions = {package: version(package) for package in PACKAGES}
        atomic.write_json(BASELINE, {"run": CHECKED, "of": versions, "ratios": measured})
    elif options.check:
        kept = json.loads(BASELINE.read_text())["ratios"]
        measured = ratios(scenario)
        if slower(measured, kept):  # by chance?
            measured = ratios(scenario)
        print("\n".join(f"warning: {line}" for line in slower(measured, kept)))
        print(f"the loop takes {measured[LOOP]:.2f} floors; {kept[LOOP]:.2f} are kept")
    else:
        stages = profile(scenario)
        print("| stage | calls | mean [ms] | over the floor |\n|---|---|---|---|")
        for stage, (calls, seconds) in stages.items():
            mean, ratio = 1e3 * seconds / max(calls, 1), seconds / stages[FLOOR][1]
            print(f"| {stage} | {calls} | {mean:.3f} | {ratio:.3f} |")


if __name__ == "__main__":
    main()
