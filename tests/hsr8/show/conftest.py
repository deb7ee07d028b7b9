from types import SimpleNamespace

import numpy as np
import pytest

from hsr8.show.video.run_images import shown_frames


@pytest.fixture
def shown(fake, tables_of):
    """Camera frame as it is drawn, of a robot whose belief is the truth."""

    def frame(pose=(0.0, 0.0, 0.0), **change):
        record = fake.record(0.6, pose, frame=fake.frame(0.6, pose, **change))
        run = SimpleNamespace(**tables_of([record]))
        return shown_frames(run, np.array([0.6]))[0]

    return frame
