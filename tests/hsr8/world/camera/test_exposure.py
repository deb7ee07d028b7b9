import numpy as np

from hsr8.world.camera.exposure import Exposure


def test_it_is_read_once_and_not_before_somebody_asks():
    taken = []

    def read():
        taken.append(1)
        return np.full((2, 3, 3), 7, np.uint8)

    exposure = Exposure(read)
    assert taken == []
    assert exposure.image() is exposure.image()
    assert exposure.image().shape == (2, 3, 3)
    assert taken == [1]
