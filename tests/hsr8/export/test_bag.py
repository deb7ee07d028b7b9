"""Bag of a run: an independent reader finds the tables in it, and the frames are consistent."""

import shutil
import sys
from collections import defaultdict

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hsr8.cli.main import entry
from hsr8.errors import ModelError
from hsr8.export.bag import write_bag
from hsr8.recording.run import open_run
from hsr8.robots.loaded import load_robot

pytest.importorskip("rosbags")
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability


def read(folder):
    """Return the messages and the connections of a bag by topic."""
    messages = defaultdict(list)
    with AnyReader([folder]) as reader:
        connections = {c.topic: c for c in reader.connections}
        for connection, time, raw in reader.messages():
            messages[connection.topic].append((time, reader.deserialize(raw, connection.msgtype)))
    return messages, connections


@pytest.fixture(scope="module")
def bag(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("bags") / "bag"
    write_bag(run, folder)
    return folder


@pytest.fixture(scope="module")
def messages(bag):
    return read(bag)[0]


def seconds(stamp):
    return stamp.sec + 1e-9 * stamp.nanosec


def test_joint_states_and_imu_are_the_ticks(run, messages):
    states = [message for _, message in messages["/joint_states"]]
    assert {tuple(state.name) for state in states} == {run.ticks.names("joint_position")}
    assert np.array_equal([state.position for state in states], run.ticks["joint_position"])
    assert np.array_equal([state.velocity for state in states], run.ticks["joint_velocity"])
    times = [seconds(state.header.stamp) for state in states]
    assert np.allclose(times, run.ticks["time"], atol=1e-9)
    imu = [message for _, message in messages["/imu/data"]]
    turns = [[getattr(m.orientation, axis) for axis in "wxyz"] for m in imu]
    assert np.array_equal(turns, run.ticks["orientation"])
    rates = [[getattr(m.angular_velocity, axis) for axis in "xyz"] for m in imu]
    assert np.array_equal(rates, run.ticks["gyro"])
    assert len(messages["/clock"]) == len(run.ticks)


def test_the_position_error_is_that_of_the_metrics(run, messages):
    def places(topic):
        return {
            (m.header.stamp.sec, m.header.stamp.nanosec): np.array(
                [m.pose.pose.position.x, m.pose.pose.position.y]
            )
            for _, m in messages[topic]
        }

    truth, belief = places("/ground_truth/odom"), places("/belief/pose")
    squares = [np.sum((truth[stamp] - belief[stamp]) ** 2) for stamp in belief]
    expected = run.metrics["localization_rmse_m"]
    assert np.sqrt(np.mean(squares)) == pytest.approx(expected, abs=1e-12)


def test_the_base_in_the_map_is_the_true_base_but_for_the_error_of_the_belief(run, messages):
    pelvis = load_robot("hsr8").roles.base
    for k, (_, message) in enumerate(messages["/tf"]):
        tf = {t.child_frame_id: t for t in message.transforms}
        turn, position = Rotation.identity(), np.zeros(3)
        frame = pelvis
        while frame != "map":
            link = tf[frame].transform
            r, p = link.rotation, link.translation
            step = Rotation.from_quat([r.x, r.y, r.z, r.w])
            turn, position = step * turn, step.apply(position) + np.array([p.x, p.y, p.z])
            frame = tf[frame].header.frame_id
        true = run.records["qpos"][k, :7]
        assert np.linalg.norm(position - true[:3]) < 0.02
        error = turn.inv() * Rotation.from_quat(true[3:], scalar_first=True)
        assert error.magnitude() < 0.05


def test_every_frame_has_one_parent(messages):
    moving = {t.child_frame_id: t.header.frame_id for t in messages["/tf"][0][1].transforms}
    static = {t.child_frame_id: t.header.frame_id for t in messages["/tf_static"][0][1].transforms}
    assert not moving.keys() & static.keys()
    parents = moving | static
    for start in parents:
        frame = start
        while frame != "map":
            frame = parents[frame]


def test_description_and_static_frames_reach_late_subscribers(bag):
    connections = read(bag)[1]
    latched = {
        topic
        for topic, connection in connections.items()
        if [q.durability for q in connection.ext.offered_qos_profiles]
        == [QosDurability.TRANSIENT_LOCAL]
    }
    assert latched == {"/tf_static", "/robot_description"}


def test_tracks_are_cylinders_at_the_tracks(run, messages):
    tracks = run.frames["tracks"]
    arrays = [message.markers for _, message in messages["/belief/tracks"]]
    assert [len(markers) - 1 for markers in arrays] == tracks.counts.tolist()
    cylinders = [marker for markers in arrays for marker in markers[1:]]
    places = [[m.pose.position.x, m.pose.position.y] for m in cylinders]
    assert np.array_equal(np.reshape(places, (-1, 2)), tracks["position"])


def test_local_maps_are_the_confidence_in_percent(run, messages):
    _, maps = run.frames.present("local_map")
    grids = [message for _, message in messages["/belief/local_map"]]
    assert len(grids) == len(maps) > 0
    for grid, shades in zip(grids, maps, strict=True):
        data = np.reshape(grid.data, (grid.info.height, grid.info.width))
        assert np.abs(data - shades / 2.55).max() <= 0.5


@pytest.mark.gl
def test_images_are_stamped_when_they_were_taken(illustrated, tmp_path):
    write_bag(illustrated, tmp_path / "bag")
    run, (messages, _) = illustrated, read(tmp_path / "bag")
    images = messages["/camera/image/compressed"]
    assert len(images) == len(messages["/camera/camera_info"]) == len(run.images) > 0
    for k, (arrival, image) in enumerate(images):
        assert image.data.tobytes() == run.images["jpeg"][k]
        assert 1e-9 * arrival == pytest.approx(run.images["time"][k])
        assert seconds(image.header.stamp) == pytest.approx(run.images["captured"][k])
        assert 1e-9 * arrival - seconds(image.header.stamp) == pytest.approx(0.04)


@pytest.mark.parametrize("robot", ["hsr8", "op3"])
def test_a_run_writes_its_bag_at_the_end(robot, tmp_path):
    try:
        load_robot(robot)
    except ModelError as error:
        pytest.skip(str(error))
    options = ["--duration", "0.1", "--camera", "analytic", "--quiet", "--bag"]
    entry(["run", "walk", "--robot", robot, "--out", str(tmp_path), *options])
    run = open_run(tmp_path)
    messages, _ = read(run.path / "bag")
    assert len(messages["/joint_states"]) == len(run.ticks) > 0
    assert not messages["/camera/camera_info"]


def test_a_folder_that_exists_is_kept(run, bag, tmp_path, capsys):
    target = tmp_path / "bag"
    shutil.copytree(bag, target)
    before = {file: file.read_bytes() for file in target.rglob("*") if file.is_file()}
    assert entry(["export", str(run.path), "--bag", str(target)]) == 2
    assert "exists" in capsys.readouterr().err
    assert before == {file: file.read_bytes() for file in target.rglob("*") if file.is_file()}


def test_without_rosbags_the_extra_is_named(run, tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "rosbags", None)
    assert entry(["export", str(run.path), "--bag", str(tmp_path / "bag")]) == 2
    assert "pip install -e '.[ros]'" in capsys.readouterr().err
    assert entry(["run", "quick", "--bag", "--out", str(tmp_path), "--quiet"]) == 2
    assert not [*tmp_path.iterdir()]
