import av
import cv2
import numpy as np
import pytest

from hsr8.files.atomic import draft
from hsr8.show.video.video import VideoWriter


def _decode(path):
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        times = [float(f.pts * f.time_base) for f in container.decode(video=0)]
        return stream.codec_context.name, stream.codec_context.pix_fmt, times


def test_frames_have_exact_times_and_a_format_browsers_play(tmp_path):
    with VideoWriter(tmp_path / "v.mp4", (64, 48), 25) as video:
        for k in range(30):
            video.add(np.full((48, 64, 3), 8 * k, np.uint8))
    codec, pixels, times = _decode(tmp_path / "v.mp4")
    assert codec == "h264"
    assert pixels == "yuv420p"
    assert times == pytest.approx([k / 25 for k in range(30)])
    content = (tmp_path / "v.mp4").read_bytes()
    assert content.index(b"moov") < content.index(b"mdat")


def test_a_webp_repeats_endlessly(tmp_path):
    with VideoWriter(tmp_path / "a.webp", (64, 48), 5) as video:
        for k in range(6):
            image = np.full((48, 64, 3), (200, 190, 180), np.uint8)
            image[10:20, 8 * k : 8 * k + 8] = (220, 30, 30)
            video.add(image)
    content = (tmp_path / "a.webp").read_bytes()
    assert content.startswith(b"RIFF")
    assert content.count(b"ANMF") == 6
    loops = content[content.index(b"ANIM") + 12 :][:2]
    assert loops == b"\x00\x00"


def _fail_within(path):
    with draft(path) as file, VideoWriter(file, (64, 48), 25) as video:
        for _ in range(3):
            video.add(np.zeros((48, 64, 3), np.uint8))
        raise KeyboardInterrupt


def test_a_failure_leaves_no_file(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        _fail_within(tmp_path / "v.mp4")
    assert list(tmp_path.iterdir()) == []


def test_an_old_video_survives_a_frame_that_cannot_be_encoded(tmp_path):
    file = tmp_path / "v.mp4"
    file.write_text("old")
    with (
        pytest.raises(cv2.error, match="channels"),
        draft(file) as new,
        VideoWriter(new, (64, 48), 25) as video,
    ):
        video.add(np.zeros((48, 64), np.uint8))
    assert file.read_text() == "old"
    assert list(tmp_path.iterdir()) == [file]
