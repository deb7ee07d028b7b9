"""hsr8: full-body simulator of a small humanoid that navigates with on-board sensors.

    import hsr8

    result = hsr8.run("course", seed=7)
    print(result.criteria_met, result.metrics["time_to_goal_s"])

`run` and `Result` make whole runs, `load_scenario` and `Simulation` run tick by tick, `open_run`
reads run folders. `docs/python.md` shows custom planners and gaze controllers, `docs/data.md` the
tables of a run.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from hsr8 import arithmetic as arithmetic  # sets the environment, before NumPy is imported
from hsr8.gl import choose_backend
from hsr8.version import VERSION

if TYPE_CHECKING:
    from hsr8.api import run
    from hsr8.evaluation.recording import Result
    from hsr8.loop import Simulation
    from hsr8.recorder.run.run_reader import open_run
    from hsr8.scenario.loader import load_scenario

__version__ = VERSION
__all__ = ["Result", "Simulation", "load_scenario", "open_run", "run"]

# Imported on first use: MuJoCo and SciPy take seconds.
_PLACES = {
    "Result": "hsr8.evaluation.recording",
    "Simulation": "hsr8.loop",
    "load_scenario": "hsr8.scenario.loader",
    "open_run": "hsr8.recorder.run.run_reader",
    "run": "hsr8.api",
}

choose_backend()


def __getattr__(name: str) -> Any:
    if name == "load":
        raise AttributeError("hsr8.load: renamed to load_scenario")
    if name == "read_log":
        raise AttributeError("hsr8.read_log: removed; hsr8.open_run gives the tables of a run")
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_PLACES[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
