"""Rerun log of a recorded run, from its tables."""

from pathlib import Path

from hsr8.body_builder import build_model
from hsr8.files import atomic
from hsr8.files.writing import writing
from hsr8.recorder.log.rerun_log import RerunLog
from hsr8.recorder.log_level import LogLevel
from hsr8.recorder.rows import TABLES
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.run_reader import StoredRun
from hsr8.robots.loaded import load_robot
from hsr8.world.field.generator import draw_layout


def write_log(run: StoredRun) -> Path:
    """Write the log of a run into its folder and return the file.

    Raises:
        UsageError: a table is damaged, or the scenario cannot be read.
        RecordingFailed: the log cannot be written.
    """
    scenario, file = run.scenario(), run.path / run_folder.LOG
    layout, robot = draw_layout(scenario, run.seed), load_robot(scenario.robot.model)
    tables = {name: table for name in TABLES if len(table := getattr(run, name))}
    world = build_model(scenario, layout), robot, layout
    level = LogLevel(run.manifest.get("log") or LogLevel.STANDARD)
    with writing(run.path), atomic.draft(file) as draft:
        log = RerunLog(draft, world, scenario, level=level, name=run.path.name)
        try:
            log.add(tables)
        finally:
            log.close(str(run.manifest.get("exit_reason")))
    return file
