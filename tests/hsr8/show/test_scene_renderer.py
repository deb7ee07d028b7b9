from contextlib import closing

import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.show.scene_renderer import SceneRenderer, soften
from hsr8.world.model.assembly import FIELD, Optics


@pytest.mark.gl
def test_movers_are_the_last_obstacles(layout):
    renderer = SceneRenderer(
        load_robot("hsr8"),
        layout,
        "show",
        (64, 64),
        optics=Optics(),
        oversampling=1.0,
        fine=False,
    )
    with closing(renderer):
        obstacles = 0.1 * np.arange(2.0 * len(layout.obstacles)).reshape(-1, 2)
        renderer.set_state(renderer.data.qpos.copy(), obstacles)
        for k, position in enumerate(obstacles[len(layout.static) :]):
            assert renderer.data.body(f"{FIELD}mover_{k:02d}").xpos[:2] == pytest.approx(position)


def test_only_edges_are_softened():
    image = np.full((40, 40, 3), 60, np.uint8)
    image[np.tri(40, dtype=bool)] = 200
    hard = image.copy()
    soften(image)
    changed = (image != hard).any(axis=-1)
    rows, columns = np.nonzero(changed)
    assert len(rows) > 70
    assert (np.abs(rows - columns) <= 2).all()
    assert set(np.unique(image[changed])) - {60, 200}


def test_a_gradient_is_not_an_edge():
    image = np.repeat(np.arange(0, 200, 5, dtype=np.uint8)[None, :, None], 20, axis=0)
    image = np.ascontiguousarray(np.repeat(image, 3, axis=2))
    before = image.copy()
    soften(image)
    assert np.array_equal(image, before)
