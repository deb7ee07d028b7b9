"""Live topics: an independent client lists, echoes and drives, and nothing that it does or omits
stops or changes the run."""

import multiprocessing
import os
import signal
import socket
import subprocess
import sys
from collections import defaultdict
from contextlib import contextmanager

import numpy as np
import pytest

from hsr8.cli.main import entry
from hsr8.cli.progress import Pace
from hsr8.driver import run_scenario
from hsr8.errors import UsageError
from hsr8.export.topics import TOPICS, Setup
from hsr8.recording.run import open_run
from hsr8.recording.verification import recompute
from hsr8.robots.loaded import load_robot
from hsr8.ros.graph import SUBSCRIPTION, Endpoint
from hsr8.ros.inputs import INPUTS
from hsr8.ros.live import LiveTopics
from hsr8.ros.process import Network
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.drive import TIMEOUT, Drive

pytest.importorskip("rosbags")
pytest.importorskip("zenoh")
import zenoh
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_JAZZY)
TWIST, JOINTS = "geometry_msgs/msg/Twist", "sensor_msgs/msg/JointState"
ANALYTIC = ("camera.source=analytic",)


def free_port():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


def scenario_of(*settings):
    return load_scenario("quick", settings)


@contextmanager
def topics_of(scenario, network, drive=None):
    robot = load_robot(scenario.robot.model)
    setup = Setup.of(robot, scenario.camera.pinhole, "<robot name='r'/>")
    with LiveTopics(network, setup, robot, drive=drive) as topics:
        yield topics


def live_run(scenario, network, hook=lambda tick: None, drive=None, pace=0.0):
    """Run a scenario with live topics; `hook` is called after each tick."""
    wait = Pace(pace).wait if pace else lambda tick: None
    with topics_of(scenario, network, drive) as topics:

        def on_tick(tick):
            topics.exchange(tick)
            hook(tick)
            wait(tick)

        return run_scenario(scenario, on_tick=on_tick, drive=drive)


class Client:
    """Client that nobody here wrote, on loopback."""

    def __init__(self, port):
        sdk = pytest.importorskip("zenoh_ros2_sdk")
        self._sdk, self._place = sdk, {"router_port": port, "domain_id": 7}
        self.received, self._open = defaultdict(list), []

    def listen(self, name, kind, **options):
        types = {"msg_definition": STORE.generate_msgdef(kind)[0]}
        types["type_hash"] = STORE.hash_rihs01(kind)
        subscriber = self._sdk.ROS2Subscriber(
            name, kind, self.received[name].append, **types, **self._place, **options
        )
        self._open.append(subscriber)

    def publisher(self, name, kind):
        types = {"msg_definition": STORE.generate_msgdef(kind)[0]}
        types["type_hash"] = STORE.hash_rihs01(kind)
        self._open.append(self._sdk.ROS2Publisher(name, kind, **types, **self._place))
        return self._open[-1]

    def topics(self):
        from zenoh_ros2_sdk.discovery import get_topic_names_and_types  # noqa: PLC0415

        return dict(get_topic_names_and_types(**self._place))

    def close(self):
        from zenoh_ros2_sdk.session import ZenohSession  # noqa: PLC0415

        for part in self._open:
            part.close()
        ZenohSession.get_instance().close()


@pytest.mark.gl
def test_a_client_lists_echoes_and_drives(capsys):
    from zenoh_ros2_sdk.qos import QosDurability, QosProfile  # noqa: PLC0415

    scenario, port, drive = scenario_of("duration=2.5"), free_port(), Drive()
    client, senders, seen = Client(port), {}, {}
    latched = QosProfile(durability=QosDurability.TRANSIENT_LOCAL, history_depth=1)
    vector = STORE.types["geometry_msgs/msg/Vector3"]

    def hook(tick):
        if tick.number == 100:
            seen.update(client.topics())
            client.listen("/robot_description", "std_msgs/msg/String", qos=latched)
            for topic in TOPICS:
                if topic.name not in ("/cmd_vel", "/robot_description"):
                    client.listen(topic.name, topic.kind)
            senders["/cmd_vel"] = client.publisher("/cmd_vel", TWIST)
            senders["/head/command"] = client.publisher("/head/command", JOINTS)
        if tick.number >= 120 and tick.number % 20 == 0:
            senders["/cmd_vel"].publish(linear=vector(0.1, 0.0, 0.0), angular=vector(0.0, 0.0, 0.2))
        if tick.number == 250:
            header = STORE.types["std_msgs/msg/Header"]
            time = STORE.types["builtin_interfaces/msg/Time"]
            senders["/head/command"].publish(
                header=header(time(0, 0), ""),
                name=["head_pan"],
                position=np.array([0.4]),
                velocity=np.zeros(0),
                effort=np.zeros(0),
            )

    network = Network(7, listen=f"tcp/127.0.0.1:{port}", drive=True)
    try:
        run = live_run(scenario, network, hook, drive, pace=1.0)
    finally:
        client.close()
    inputs = {source.name for source in INPUTS}
    assert seen.keys() == {topic.name for topic in TOPICS} | inputs
    assert seen["/head/command"] == [source.kind for source in INPUTS[2:]]

    states = client.received["/joint_states"]
    times = [state.header.stamp.sec + 1e-9 * state.header.stamp.nanosec for state in states]
    rows = run.ticks.at(times)
    assert len(states) > 50
    assert np.array_equal([s.position for s in states], run.ticks["joint_position"][rows])
    assert {m.data for m in client.received["/robot_description"]} == {"<robot name='r'/>"}
    frames = {tf.child_frame_id for message in client.received["/tf"] for tf in message.transforms}
    assert {"odom", "base_footprint"} <= frames
    for topic in TOPICS:
        if not (topic.latched or topic.name in ("/cmd_vel", "/goal_pose")):
            assert client.received[topic.name]

    velocities = run.commands["velocity"]
    assert (np.isfinite(velocities).all(axis=1)).sum() > 10
    assert np.allclose(velocities[1], [0.1, 0.0, 0.2])
    assert run.records["command"][-1] == pytest.approx([0.1, 0.0, 0.2])
    assert run.records["head_target"][-1][0] == pytest.approx(0.4)
    assert [stage.equal for stage in recompute(run)] == [True] * 3
    assert capsys.readouterr().err.count("ros: ") == 1


PEER = """
import sys, time, zenoh
config = zenoh.Config()
config.insert_json5("connect/endpoints", f'["tcp/127.0.0.1:{sys.argv[1]}"]')
config.insert_json5("scouting/multicast/enabled", "false")
session = zenoh.open(config)
subscriber = session.declare_subscriber("0/**", lambda sample: None)
print("ready", flush=True)
time.sleep(60.0)
"""


def test_peers_and_a_publishing_process_that_stop_or_die_leave_the_run_alone(capsys):
    port, peers = free_port(), []

    def hook(tick):
        if tick.number == 0:
            words = [sys.executable, "-c", PEER, str(port)]
            peers.extend(subprocess.Popen(words, stdout=subprocess.PIPE) for _ in range(2))
            assert [peer.stdout.readline() for peer in peers] == [b"ready\n"] * 2
        if tick.number == 100:
            peers[0].send_signal(signal.SIGSTOP)
            peers[1].kill()
        if tick.number == 350:
            os.kill(multiprocessing.active_children()[0].pid, signal.SIGKILL)

    scenario = scenario_of("duration=2", *ANALYTIC)
    try:
        run = live_run(scenario, Network(listen=f"tcp/127.0.0.1:{port}"), hook, pace=1.0)
    finally:
        for peer in peers:
            peer.kill()
            peer.communicate()
    assert run.exit_reason == "timeout"
    assert len(run.ticks) == 401
    warnings = capsys.readouterr().err.splitlines()
    assert sum("ended" in line for line in warnings) == 1
    assert len(warnings) <= 3  # that it ended, the number of messages; ticks may be dropped


def test_malformed_messages_and_silence_warn_once(capsys):
    scenario, port, drive = scenario_of("duration=3", *ANALYTIC), free_port(), Drive()
    rng, opened = np.random.default_rng(0), {}
    twist = STORE.types[TWIST]
    vector = STORE.types["geometry_msgs/msg/Vector3"]

    def key(source):
        kind_hash = STORE.hash_rihs01(source.kind)
        return Endpoint(0, "s", 1, SUBSCRIPTION, source.name, source.kind, kind_hash).key

    def velocity(vx):
        message = twist(vector(vx, 0.0, 0.0), vector(0.0, 0.0, 0.0))
        return bytes(STORE.serialize_cdr(message, TWIST))

    def hook(tick):
        if tick.number == 0:
            config = zenoh.Config()
            config.insert_json5("connect/endpoints", f'["tcp/127.0.0.1:{port}"]')
            config.insert_json5("scouting/multicast/enabled", "false")
            opened["session"] = zenoh.open(config)
        if 50 <= tick.number < 200:
            for source in INPUTS:
                opened["session"].put(key(source), rng.bytes(int(rng.integers(0, 200))))
        if tick.number in (300, 310):
            opened["session"].put(key(INPUTS[0]), velocity(0.1))
        if tick.number in (320, 330):
            opened["session"].put(key(INPUTS[0]), velocity(np.nan if tick.number == 320 else 1e30))

    network = Network(listen=f"tcp/127.0.0.1:{port}", drive=True)
    try:
        run = live_run(scenario, network, hook, drive, pace=2.0)
    finally:
        opened["session"].close()
    velocities = run.commands["velocity"]
    assert velocities[0].tolist() == [0.0, 0.0, 0.0]
    assert {tuple(v) for v in velocities[1:].tolist()} == {(0.1, 0.0, 0.0)}
    late = run.records["time"] > run.commands["time"][-1] + TIMEOUT + 0.05
    assert not run.records["command"][late].any()
    assert run.exit_reason == "timeout"
    assert [stage.equal for stage in recompute(run)] == [True] * 3
    lines = capsys.readouterr().err.splitlines()
    for text in ("/cmd_vel: message refused", "/head/command: message refused", "robot stops"):
        assert sum(text in line for line in lines) == 1


def test_a_taken_endpoint_is_refused():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        network = Network(listen=f"tcp/127.0.0.1:{taken.getsockname()[1]}")
        with pytest.raises(UsageError, match="--ros-listen"):
            live_run(scenario_of("duration=1", *ANALYTIC), network)


def test_without_zenoh_the_extra_is_named(monkeypatch, tmp_path, capsys):
    monkeypatch.setitem(sys.modules, "zenoh", None)
    assert entry(["run", "quick", "--ros", "--out", str(tmp_path), "--quiet"]) == 2
    assert "pip install -e '.[ros]'" in capsys.readouterr().err


def test_topics_from_the_command_line_do_not_change_a_run(tmp_path, capsys):
    words = ["--duration", "0.5", "--camera", "analytic", "--quiet", "--pace", "0"]
    address = f"tcp/127.0.0.1:{free_port()}"
    entry(["run", "quick", "--ros", "--ros-listen", address, "--out", str(tmp_path), *words])
    error = capsys.readouterr().err
    assert f"listens on {address}" in error
    run = open_run(tmp_path)
    assert len(run.commands) == 0
    assert "--ros" not in run.manifest["command"]
    assert (run.path / "robot.urdf").is_file()
    alone = run_scenario(scenario_of("duration=0.5", *ANALYTIC))
    assert run.manifest["state_hash"] == alone.manifest["state_hash"]
