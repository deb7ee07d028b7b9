"""The figures of Yoo and Kim (2010), drawn from the running code, for docs/figures.md.

    hsr8 run paper --out runs/a
    hsr8 run paper --out runs/b --set navigation.profile=paper camera.source=omnidirectional
    python scripts/paper_figures.py --tours runs/a runs/b

Figs. 1, 4 and 7 come from short runs of the real loop that the script makes itself, with the
kinematic body; Fig. 3 from the field; Fig. 9 from run folders, whose walk is not
repeated. Without `--tours` Fig. 9 is left as it is.
"""

from pathlib import Path

import encounter_figure
import field_figure
import gaze_figures
import sequence_figure
import tyro
from figure_style import styled
from matplotlib.figure import Figure

DPI = (110, 100, 90, 80)
LARGEST = 300_000  # of an image [byte]


def save(figure: Figure, file: Path) -> None:
    """Write a figure as a PNG, as fine as the largest file allows."""
    with styled():
        for dpi in DPI:
            figure.savefig(file, dpi=dpi)
            if file.stat().st_size <= LARGEST:
                break
    print(f"{file}  {file.stat().st_size / 1000:.0f} kB", flush=True)


def main(
    *,
    only: tuple[int, ...] = (1, 3, 4, 7, 9),
    tours: tuple[Path, ...] = (),
    out: Path = Path("docs/figures"),
) -> None:
    """Draw the figures.

    Args:
        only: their numbers.
        tours: run folders of `paper`, one row of Fig. 9 each, named by conditions and results.
        out: folder to write to.
    """
    out.mkdir(parents=True, exist_ok=True)
    if 3 in only:
        save(field_figure.draw(), out / "fig3.png")
    if 1 in only or 7 in only:
        looks = gaze_figures.looks(gaze_figures.recorded())
        if 1 in only:
            save(gaze_figures.draw_map(gaze_figures.most_divided(looks)), out / "fig1.png")
        if 7 in only:
            save(gaze_figures.draw_choice(looks[0]), out / "fig7.png")
    if 4 in only:
        cases = [encounter_figure.case(letter) for letter in encounter_figure.CASES]
        save(encounter_figure.draw(cases), out / "fig4.png")
    if 9 in only and tours:
        save(sequence_figure.draw([sequence_figure.tour(path) for path in tours]), out / "fig9.png")


if __name__ == "__main__":
    tyro.cli(main)
