"""``hsr8 color-table``: learn a color table from labelled images."""

import json
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from hsr8.cli import options as cli
from hsr8.cli.output_file import writing
from hsr8.errors import UsageError
from vision.color import COLOR_CLASSES, ColorTable, Labels
from vision.color_file import SUFFIX, save_table
from vision.color_learning import IGNORED, learn
from vision.errors import VisionError

Image = NDArray[np.uint8]

MASK = ".mask.png"
WHITE = (255, 255, 255)  # in a mask: not judged


def mask_colors() -> dict[str, tuple[int, int, int]]:
    """RGB with which masks mark each colour class."""
    return {
        name: (round(255 * c.rgb[0]), round(255 * c.rgb[1]), round(255 * c.rgb[2]))
        for name, c in COLOR_CLASSES.items()
    }


def main(options: cli.ColorTable) -> int:
    """Learn the table, write it, and tell how well it recognises its own images.

    Raises:
        UsageError: an image or a mask is missing or wrong, or the table cannot be written.
    """
    if options.out.suffix != SUFFIX:
        raise UsageError(f"--out {options.out}: a colour table is a {SUFFIX} file")
    if not options.images:
        raise UsageError("IMAGE: missing; expected images with masks NAME.mask.png")
    pairs = [_read(path) for path in options.images]
    try:
        table = learn(pairs)
    except VisionError as error:
        raise UsageError(str(error)) from None
    with writing("--out", options.out):
        save_table(table, options.out)
    rows = list(_recognised(table, pairs))
    if options.json:
        print(json.dumps({"color_table": str(options.out), "classes": rows}))
        return 0
    shown = Table(title=f"Colour table from {len(pairs)} images", title_justify="left")
    for heading in ("class", "pixels", "recognised %", "taken for another %"):
        shown.add_column(heading, justify="left" if heading == "class" else "right")
    for row in rows:
        cells = ("-", "-") if not row["pixels"] else (row["recognised"], row["confused"])
        shown.add_row(
            str(row["class"]),
            str(row["pixels"]),
            *(c if isinstance(c, str) else f"{100.0 * float(c):.2f}" for c in cells),
        )
    console = Console()
    console.print(shown)
    console.print(f"Use it: hsr8 run quick --set vision.color_table={options.out}", highlight=False)
    return 0


def _read(path: Path) -> tuple[Image, Labels]:
    """An image and the labels its mask gives it."""
    mask_path = path.with_name(path.stem + MASK)
    image, mask = _picture(path), _picture(mask_path)
    if image.shape != mask.shape:
        raise UsageError(
            f"{mask_path} is {mask.shape[1]}x{mask.shape[0]}, "
            f"but {path} is {image.shape[1]}x{image.shape[0]}"
        )
    labels = np.full(mask.shape[:2], len(COLOR_CLASSES) + 1, np.uint8)
    legend = {"background": (0, 0, 0), **mask_colors()}
    for label, rgb in enumerate(legend.values()):
        labels[(mask == rgb).all(axis=2)] = label
    labels[(mask == WHITE).all(axis=2)] = IGNORED
    unknown = np.argwhere(labels == len(COLOR_CLASSES) + 1)
    if len(unknown):
        y, x = unknown[0].tolist()
        known = ", ".join(f"{name} {rgb}" for name, rgb in legend.items())
        raise UsageError(
            f"{mask_path}: pixel ({x}, {y}) has the colour {tuple(mask[y, x].tolist())}, which "
            f"marks nothing; a mask has only these, without smoothing: {known}, "
            f"or {WHITE} for what is not judged"
        )
    return image, labels


def _picture(path: Path) -> Image:
    """RGB of an image file."""
    try:
        data = np.frombuffer(path.read_bytes(), np.uint8)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from None
    image = cv2.imdecode(data, cv2.IMREAD_COLOR) if len(data) else None
    if image is None:
        raise UsageError(f"{path} is no image that can be read (PNG and JPEG can)")
    rgb: Image = np.ascontiguousarray(image[:, :, ::-1])
    return rgb


def _recognised(
    table: ColorTable, pairs: list[tuple[Image, Labels]]
) -> Iterator[dict[str, str | int | float]]:
    """Pixels of each class, and the shares recognised and taken for another class."""
    seen = np.concatenate([table.classify(image).ravel() for image, _ in pairs])
    true = np.concatenate([labels.ravel() for _, labels in pairs])
    for label, name in enumerate(("background", *COLOR_CLASSES)):
        found = seen[true == label]
        n = max(len(found), 1)
        other = (found != label) & (found != 0)
        yield {
            "class": name,
            "pixels": len(found),
            "recognised": int((found == label).sum()) / n,
            "confused": int(other.sum()) / n,
        }
