"""``hsr8 robot list``: the shipped robots."""

from rich.console import Console

from hsr8.cli import tables
from hsr8.cli.robot_options import RobotList
from hsr8.files import atomic
from hsr8.robots.file.description import read_description
from hsr8.robots.file.locate import find_description, installed_model, remedy, robot_names


def main(options: RobotList) -> int:
    """Print every shipped robot, its model on this machine, and how to get it."""
    entries, remedies = [], dict[str, str]()
    for name in robot_names():
        file = find_description(name)
        description = read_description(file)
        model, about = installed_model(description, file.parent), description.about
        if model is None:
            remedies[name] = remedy(description)
        entries.append(
            {
                "name": name,
                "title": about and about.title,
                "mass_kg": about and about.mass,
                "leg_m": about and about.leg,
                "joints": about and about.joints,
                "calibrated": description.calibration is not None,
                "source": about and about.source,
                "model": model and str(model),
            }
        )
    if options.json:
        print(atomic.dumps({"robots": entries, "remedies": remedies}))
        return 0
    console = Console(highlight=False)
    shown = ("name", "title", "mass_kg", "leg_m", "joints")
    rows = [
        {key: entry[key] for key in shown} | {"model": "found" if entry["model"] else "missing"}
        for entry in entries
    ]
    console.print(tables.rows(rows))
    for text in dict.fromkeys(remedies.values()):
        names = ", ".join(name for name in remedies if remedies[name] == text)
        console.print(f"missing     {names}: {text}", soft_wrap=True, markup=False)
    console.print("use one     hsr8 run course --robot NAME\nyour own    hsr8 robot inspect FILE")
    return 0
