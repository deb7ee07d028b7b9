import numpy as np

from hsr8.render.scene_renderer import soften


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
