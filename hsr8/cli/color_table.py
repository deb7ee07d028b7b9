"""``hsr8 color-table``: learn a color table from labelled images."""

from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from rich.console import Console

from hsr8.cli import options as cli
from hsr8.cli import tables
from hsr8.cli.output_file import require_file_name, writing
from hsr8.errors import UsageError
from hsr8.files import atomic
from vision.color import COLOR_CLASSES, SUFFIX, ColorTable, Labels, save_table
from vision.color_learning import IGNORED, learn
from vision.errors import VisionError

Image = NDArray[np.uint8]

MASK = ".mask.png"
WHITE = (255, 255, 255)  # in a mask: not labelled


def mask_colors() -> dict[str, tuple[int, int, int]]:
    """Return the RGB that marks each color class in a mask."""
    return {
        name: (round(255 * c.rgb[0]), round(255 * c.rgb[1]), round(255 * c.rgb[2]))
        for name, c in COLOR_CLASSES.items()
    }


def main(options: cli.ColorTable) -> int:
    """Learn and write the table; report its recall on the images it was learned from."""
    require_file_name("--out", options.out, (SUFFIX,))
    if not options.images:
        raise UsageError("IMAGE: missing; expected images with masks NAME.mask.png")
    pairs = [_read_pair(path) for path in options.images]
    try:
        table = learn(pairs)
    except VisionError as error:
        raise UsageError(str(error)) from None
    with writing("--out", options.out), atomic.draft(options.out) as file:
        save_table(table, file)
    rows = list(_recall(table, pairs))
    if options.json:
        print(atomic.dumps({"color_table": str(options.out), "classes": rows}))
        return 0
    console = Console(highlight=False)
    console.print(tables.rows(rows, f"color table from {len(pairs)} images"))
    console.print(f"use it      hsr8 run quick --set vision.color_table={options.out}")
    return 0


def _read_pair(path: Path) -> tuple[Image, Labels]:
    """Read an image and the labels of its mask."""
    mask_path = path.with_name(path.stem + MASK)
    image, mask = _read(path), _read(mask_path)
    if image.shape != mask.shape:
        raise UsageError(
            f"{mask_path}: wrong size, got {mask.shape[1]}x{mask.shape[0]}; "
            f"expected {image.shape[1]}x{image.shape[0]}, the size of {path}"
        )
    unknown_label = len(COLOR_CLASSES) + 1
    labels = np.full(mask.shape[:2], unknown_label, np.uint8)
    legend = {"background": (0, 0, 0), **mask_colors()}
    for label, rgb in enumerate(legend.values()):
        labels[(mask == rgb).all(axis=2)] = label
    labels[(mask == WHITE).all(axis=2)] = IGNORED
    unknown = np.argwhere(labels == unknown_label)
    if len(unknown):
        y, x = unknown[0].tolist()
        known = ", ".join(f"{name} {rgb}" for name, rgb in legend.items())
        raise UsageError(
            f"{mask_path}: unknown color at pixel ({x}, {y}), got {tuple(mask[y, x].tolist())}; "
            f"expected one of these, without smoothing: {known}, not labelled {WHITE}"
        )
    return image, labels


def _read(path: Path) -> Image:
    """Return the RGB image of a file."""
    try:
        data = np.frombuffer(path.read_bytes(), np.uint8)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from None
    image = cv2.imdecode(data, cv2.IMREAD_COLOR) if len(data) else None
    if image is None:
        raise UsageError(f"{path}: not an image; expected PNG or JPEG")
    rgb: Image = np.ascontiguousarray(image[:, :, ::-1])
    return rgb


def _recall(
    table: ColorTable, pairs: list[tuple[Image, Labels]]
) -> Iterator[dict[str, str | int | float]]:
    """Yield, per class, its pixels and the fractions recognized and taken for another class."""
    classified = np.concatenate([table.classify(image).ravel() for image, _ in pairs])
    labelled = np.concatenate([labels.ravel() for _, labels in pairs])
    for label, name in enumerate(("background", *COLOR_CLASSES)):
        of_class = classified[labelled == label]
        n = max(len(of_class), 1)
        yield {
            "class": name,
            "pixels": len(of_class),
            "recognized": int((of_class == label).sum()) / n,
            "confused": int(((of_class != label) & (of_class != 0)).sum()) / n,
        }
