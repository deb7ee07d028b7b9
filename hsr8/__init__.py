"""hsr8: full-body simulator of a small humanoid that navigates with on-board sensors.

    import hsr8

    run = hsr8.run("course", seed=7)
    print(run.criteria_met, run.metrics["time_to_goal_s"])

`run` makes a whole `Run`, `load_scenario` and `Simulation` run tick by tick, `open_run` and `runs`
read run folders. A custom planner or gaze gets a `Belief` and returns a `MotionDecision`
or a `GazeDecision`, see `docs/python.md`; `docs/data.md` describes the tables of a run.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from hsr8.errors import (
    Hsr8Error,
    ModelError,
    RecordingFailed,
    RenderingUnavailable,
    ScenarioError,
    SimulationDiverged,
    UsageError,
)
from hsr8.process import arithmetic as arithmetic  # sets the environment, before NumPy is imported
from hsr8.process.gl import choose_backend
from hsr8.version import VERSION

if TYPE_CHECKING:
    from hsr8.api import run
    from hsr8.recording.run import Run, open_run, runs
    from hsr8.scenario.loader import load_scenario
    from hsr8.simulation.loop import Simulation
    from navigation.belief.belief import Belief
    from navigation.decision import GazeDecision, MotionDecision

__version__ = VERSION
__all__ = [
    "Belief",
    "GazeDecision",
    "Hsr8Error",
    "ModelError",
    "MotionDecision",
    "RecordingFailed",
    "RenderingUnavailable",
    "Run",
    "ScenarioError",
    "Simulation",
    "SimulationDiverged",
    "UsageError",
    "load_scenario",
    "open_run",
    "run",
    "runs",
]

# Imported on first use: MuJoCo and SciPy take seconds.
_PLACES = {
    "Belief": "navigation.belief.belief",
    "GazeDecision": "navigation.decision",
    "MotionDecision": "navigation.decision",
    "Run": "hsr8.recording.run",
    "Simulation": "hsr8.simulation.loop",
    "load_scenario": "hsr8.scenario.loader",
    "open_run": "hsr8.recording.run",
    "run": "hsr8.api",
    "runs": "hsr8.recording.run",
}

choose_backend()


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_PLACES[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
