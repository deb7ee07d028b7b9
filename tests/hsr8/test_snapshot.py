import io
import os
import pickle
import struct
from enum import Enum
from hashlib import sha256

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.errors import UsageError
from hsr8.loop import Simulation
from hsr8.scenario.loader import load_scenario
from hsr8.snapshot import MAGIC, decode, encode
from navigation.belief.belief import Motion
from walking.get_up.get_up import Outcome
from walking.phase import Phase

ANCHORS = {"model": None, "robot model": None}


def forged(payload):
    """A snapshot whose checksum is right."""
    return MAGIC + struct.pack("<Q", len(payload)) + sha256(payload).digest() + payload


def test_shared_things_stay_shared():
    rng = np.random.default_rng(3)
    back = decode(encode({"a": rng, "b": [rng]}), ANCHORS, "x")
    assert back["a"] is back["b"][0]
    assert back["a"].random() == np.random.default_rng(3).random()


def test_enumerations_need_no_names_but_their_own(monkeypatch):
    """As Python 3.11.2, which Debian has, would otherwise write them."""

    def by_name(self, _protocol):
        return getattr, (type(self), self.name)

    monkeypatch.setattr(Enum, "__reduce_ex__", by_name)
    members = [Motion.MOVING, Phase.DOUBLE_SUPPORT, Outcome.UP]
    assert decode(encode({"a": members}), ANCHORS, "x")["a"] == members


@pytest.mark.parametrize("tick", [1, 77, 260])
def test_a_run_goes_on_from_any_tick(tick):
    settings = ['robot.body="kinematic"', 'camera.source="analytic"', "duration=2.0"]
    scenario = load_scenario("quick", settings)
    with Simulation(scenario, 5) as first:
        while first.tick < tick:
            first.step()
        content = encode(first.snapshot())
        while first.exit_reason is None:
            first.step()
    with Simulation(scenario, 5) as second:
        anchors = ANCHORS | {"model": second.model}
        anchors["robot model"] = first._robot._walking._robot
        second.restore(decode(content, anchors, "x"))
        assert second.tick == tick
        while second.exit_reason is None:
            second.step()
    assert second.outcome() == first.outcome()


class Evil:
    def __reduce__(self):
        return os.system, ("touch evil",)


class Reads:
    def __reduce__(self):
        return open, ("/etc/hostname",)


class Gets:
    def __reduce__(self):
        return getattr, (ANCHORS, "clear")


class Loads:
    """A function of the project that opens a file."""

    def __reduce__(self):
        return load_scenario, ("/etc/hostname",)


@pytest.mark.parametrize("what", [Evil, Reads, Gets, Loads])
def test_nothing_but_data_is_read(what, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UsageError, match="is refused: it asks for"):
        decode(forged(pickle.dumps({"a": what()}, 5)), ANCHORS, "x")
    assert list(tmp_path.iterdir()) == []


@given(place=st.integers(0, 200), value=st.integers(1, 255))
def test_damage_is_told(place, value):
    content = bytearray(encode({"a": np.arange(20.0)}))
    content[place % len(content)] ^= value
    with pytest.raises(UsageError, match=r"is damaged|is cut off|is no snapshot|of format"):
        decode(bytes(content), ANCHORS, "x")


@given(payload=st.binary(max_size=60))
def test_whatever_is_forged_is_one_clear_error(payload):
    try:
        parts = decode(forged(payload), ANCHORS, "x")
    except UsageError:
        return
    assert isinstance(parts, dict)


@pytest.mark.parametrize("pid", ["owner", "", ("model", "__class__")])
def test_nothing_but_the_models_is_handed_out(pid):
    class Writer(pickle.Pickler):
        def persistent_id(self, obj):
            return pid if obj == "anchor" else None

    buffer = io.BytesIO()
    Writer(buffer, 5).dump({"a": "anchor"})
    with pytest.raises(UsageError, match="is refused: it asks for"):
        decode(forged(buffer.getvalue()), ANCHORS, "x")
