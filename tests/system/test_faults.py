"""Every kind of fault: recovery, or a named failure."""

import json

import numpy as np
import pytest

from hsr8.cli.main import entry
from hsr8.recording.run import open_run

START, LASTS = 0.7, 0.4  # of the faults that the robot recovers from [s]
RECOVERY = {  # magnitudes that a walking robot recovers from within a second; see NO_FALL
    "attitude-bias": "magnitude=0.03",
    "gyro-bias": "magnitude=0.05",
    "encoder-offset": 'magnitude=0.02,joint="l_ankle_pitch"',
    "foot-gain": 'magnitude=0.6,foot="right"',
    "servo-weak": "magnitude=0.7",
    "servo-stuck": 'joint="head_pan"',
    "push": "magnitude=0.5",
    "bump": "magnitude=0.003,position=[0.1,0.0],radius=0.2",
}
FALL = {  # magnitudes that make it fall
    "attitude-bias": "magnitude=0.4",
    "encoder-offset": "magnitude=0.2",
    "servo-weak": "magnitude=0.05",
    "servo-stuck": 'joint="l_hip_pitch"',
    "push": "magnitude=5.0",
}
NO_FALL = {  # permanent faults that slow down or turn a walk without a fall
    "imu-frozen": "",
    "encoder-frozen": "",
    "foot-sensor-dropout": "",
    "servo-delay": "magnitude=0.03",
    "low-friction": "magnitude=0.05",
}
BODY = [
    *("world.size=[4.0,4.0]", "world.n_static=0", "world.n_moving=0"),
    *("robot.start={position=[0.0,0.0],heading_deg=0.0}", "command.vx=0.15"),
]


def fault(kind, keys="", start=START, lasts=LASTS):
    """TOML text of a fault."""
    lasting = f"duration={lasts}" if lasts else ""
    keys = ",".join(part for part in (f"start={start}", lasting, keys) if part)
    return f'{{kind="{kind}",{keys}}}'


def walked(simulate, text, duration):
    outcome, recorded, _ = simulate(
        "walk", *BODY, f"fault=[{text}]", body="full", duration=duration
    )
    assert np.isfinite([r.truth.qpos for r in recorded.records]).all()
    return outcome, recorded


@pytest.mark.parametrize("kind", RECOVERY)
def test_a_walking_robot_recovers_from(simulate, kind):
    outcome, recorded = walked(simulate, fault(kind, RECOVERY[kind]), 1.8)
    assert outcome.exit_reason == "completed"
    events = [e[1] for e in recorded.events if e[1] != "push"]
    assert events == ["fault", "fault"]
    assert recorded.records[-1].truth.robot[0] > 0.12


@pytest.mark.parametrize("kind", FALL)
def test_a_walking_robot_falls_by(simulate, kind):
    lasts = 0.05 if kind == "push" else None
    text = fault(kind, FALL[kind], start=1.0, lasts=lasts)
    outcome, recorded = walked(simulate, text, 4.0)
    assert outcome.exit_reason == "fall"
    assert "fall" in [e[1] for e in recorded.events]


@pytest.mark.parametrize("kind", NO_FALL)
def test_a_walking_robot_stays_on_its_feet_under(simulate, kind):
    outcome, recorded = walked(simulate, fault(kind, NO_FALL[kind], lasts=None), 2.2)
    assert outcome.exit_reason == "completed"
    assert not any(r.truth.fallen for r in recorded.records)


def test_a_mover_that_appears_stops_the_robot_or_is_passed(simulate):
    stands = '{motion="line",start=[0.5,0.0],heading_deg=90.0,speed=0.000001}'
    settings = (
        *BODY[:-1],
        'mission={kind="points",points=[[1.0,0.0]]}',
        f"world.mover=[{stands}]",
        f"fault=[{fault('mover-appears', 'mover=0', start=1.0, lasts=0)}]",
    )
    outcome, recorded, _ = simulate("quick", *settings, duration=20.0)
    assert outcome.exit_reason == "goal"
    assert not any(r.truth.contacts for r in recorded.records)
    gap = [r.truth.clearance for r in recorded.records]
    before = [g for r, g in zip(recorded.records, gap, strict=True) if r.time < 0.99]
    assert min(before) > 2.0  # from a beacon
    assert min(gap) < 0.5


def test_begin_and_end_of_a_fault_are_events_of_their_time(simulate):
    both = ",".join(
        [fault("attitude-bias", "magnitude=0.02"), fault("camera-drops", "magnitude=0.5", lasts=0)]
    )
    _, recorded, _ = simulate("quick", f"fault=[{both}]", duration=1.2)
    assert recorded.events == [
        (0.7, "fault", "attitude-bias, magnitude 0.02, axis pitch: begins"),
        (0.7, "fault", "camera-drops, magnitude 0.5: begins"),
        (1.1, "fault", "attitude-bias, magnitude 0.02, axis pitch: ends"),
    ]


ALL = [
    fault("camera-black", start=0.2, lasts=0.2),
    fault("missed-detections", "magnitude=0.3", start=0.3, lasts=0.5),
    fault("false-detections", "magnitude=0.5", start=0.3, lasts=0.5),
    fault("camera-drops", "magnitude=0.3", start=0.4, lasts=0.5),
    fault("camera-latency", "magnitude=0.1", start=0.5, lasts=0.4),
    fault("attitude-bias", "magnitude=0.02", start=0.2),
    fault("gyro-bias", "magnitude=0.05", start=0.2),
    fault("imu-frozen", start=0.6, lasts=0.1),
    fault("encoder-offset", "magnitude=0.01", start=0.2),
    fault("encoder-frozen", 'joint="head_pan"', start=0.3, lasts=0.4),
    fault("foot-sensor-dropout", 'foot="left"', start=0.3, lasts=0.4),
    fault("foot-gain", "magnitude=0.5", start=0.2),
    fault("servo-stuck", 'joint="head_tilt"', start=0.3, lasts=0.4),
    fault("servo-delay", "magnitude=0.005", start=0.2, lasts=0.8),
    fault("mover-appears", start=0.4, lasts=0.4),
]
PHYSICAL = [
    fault("servo-weak", "magnitude=0.7", start=0.3),
    fault("push", "magnitude=0.3,point=[0.0,0.1,0.05]", start=0.5, lasts=0.1),
    fault("low-friction", "magnitude=0.3,position=[0.0,0.0],radius=3.0", start=0.4),
    fault("bump", "magnitude=0.004,position=[0.0,0.0],radius=0.5", start=0.45),
]


def test_a_run_with_all_faults_is_computed_again_bit_for_bit(tmp_path, capsys):
    words = ["run", "quick", "--camera", "analytic", "--duration", "1.2", "--quiet"]
    words += ["--set", f"fault=[{','.join([*ALL, *PHYSICAL])}]"]
    entry([*words, "--out", str(tmp_path)])
    run = open_run(tmp_path)
    assert np.sum(run.events["kind"] == "fault") > 20
    capsys.readouterr()
    assert entry(["verify", str(run.path), "--json"]) == 0
    stages = json.loads(capsys.readouterr().out)["stages"]
    assert all(stage["equal"] for stage in stages)
