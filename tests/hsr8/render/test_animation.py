import av
import numpy as np
import pytest

from hsr8.errors import UsageError
from hsr8.render.animation import AnimationWriter, require_room


def _write(path, fps=5, count=6):
    with AnimationWriter(path, (64, 48), fps) as animation:
        for k in range(count):
            picture = np.full((48, 64, 3), (200, 190, 180), np.uint8)
            picture[10:20, 8 * k : 8 * k + 8] = (220, 30, 30)
            animation.add(picture)


def test_a_gif_shows_every_picture_for_its_time(tmp_path):
    _write(tmp_path / "a.gif")
    with av.open(str(tmp_path / "a.gif")) as container:
        frames = [(float(f.time), f.to_ndarray(format="rgb24")) for f in container.decode(video=0)]
    assert [time for time, _ in frames] == pytest.approx([0.2 * k for k in range(6)])
    for k, (_, image) in enumerate(frames):
        columns = np.nonzero(image[15, :, 1] < 100)[0]
        assert abs(columns.mean() - (8 * k + 3.5)) < 1.0
    assert b"NETSCAPE2.0\x03\x01\x00\x00" in (tmp_path / "a.gif").read_bytes()  # without end


def test_a_webp_is_an_animation_without_end(tmp_path):
    _write(tmp_path / "a.webp")
    content = (tmp_path / "a.webp").read_bytes()
    assert content.startswith(b"RIFF")
    assert content.count(b"ANMF") == 6
    loops = content[content.index(b"ANIM") + 12 :][:2]
    assert loops == b"\x00\x00"


def test_a_gif_that_would_fill_the_memory_is_refused(tmp_path):
    size = (960, 540)
    with pytest.raises(UsageError, match=r"1500 images .* 778 million .*limited to 400"):
        require_room(tmp_path / "a.gif", size, 1500)
    require_room(tmp_path / "a.gif", size, 700)
    require_room(tmp_path / "a.webp", size, 1500)


def _fail_within(path):
    with AnimationWriter(path, (64, 48), 5) as animation:
        animation.add(np.zeros((48, 64, 3), np.uint8))
        raise KeyboardInterrupt


def test_a_failure_leaves_no_file(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        _fail_within(tmp_path / "a.gif")
    assert list(tmp_path.iterdir()) == []
