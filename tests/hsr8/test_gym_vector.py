"""Environments in processes, and the environment checker of stable-baselines3."""

import importlib
import sys
import warnings

import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import hsr8
from hsr8.errors import UsageError
from hsr8.gym import Environment, make_vec

SETTINGS = ["robot.body=kinematic", "camera.source=analytic", "duration=1.0"]


def test_without_gymnasium_the_extra_is_named(monkeypatch):
    for name in [name for name in sys.modules if name.startswith("hsr8.gym")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "gymnasium", None)
    with pytest.raises(ImportError, match=r"hsr8\.gym: .*gymnasium.*; install hsr8\[gym\]"):
        importlib.import_module("hsr8.gym")


@pytest.mark.parametrize(
    ("n", "options", "message"),
    [
        (
            2,
            {"vector_kwargs": {"context": "fork"}},
            "context: OpenGL .*got 'fork'; expected forkserver or spawn",
        ),
        (
            2,
            {"vector_kwargs": {"context": "foo"}},
            "context: unknown start method, got 'foo'; expected forkserver or spawn",
        ),
        (2, {"vectorization_mode": "sync"}, "vectorization_mode: .*got 'sync'; expected"),
        (0, {}, "n: got int 0; expected an integer of at least 1"),
        (1.0, {}, "n: got float 1.0; expected an integer of at least 1"),
        (True, {}, "n: got bool True; expected an integer of at least 1"),
        (1, {"max_tracks": 0}, "max_tracks: got int 0; expected an integer from 1 to 128"),
    ],
)
def test_invalid_arguments_are_refused_by_name(n, options, message):
    with pytest.raises(UsageError, match=message):
        make_vec("hsr8/Gaze-v0", n, **options)


@pytest.mark.timeout(300)
def test_processes_run_the_seeds_of_their_environments():
    envs = make_vec(
        "hsr8/Gaze-v0",
        2,
        scenario="quick",
        settings=SETTINGS,
        vector_kwargs={"autoreset_mode": AutoresetMode.SAME_STEP},
    )
    try:
        envs.reset(seed=[4, 5])
        ended = np.zeros(2, bool)
        while not ended.any():
            _, _, terminated, truncated, infos = envs.step(np.zeros((2, 2), np.float32))
            ended = terminated | truncated
    finally:
        envs.close()
    gaze = hsr8.gym.as_gaze(lambda: lambda _: np.zeros(2))
    expected = [
        hsr8.run("quick", seed=seed, settings=SETTINGS, gaze=gaze()).metrics["state_hash"]
        for seed in (4, 5)
    ]
    assert infos["final_info"]["metrics"]["state_hash"].tolist() == expected


def test_stable_baselines3_has_no_complaint():
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    for decides in (("gaze",), ("motion",), ("motion", "gaze")):
        env = Environment("quick", decides=decides, settings=SETTINGS, observe=["local_map"])
        with warnings.catch_warnings():
            warnings.simplefilter("error", UserWarning)
            checker.check_env(env)
        env.close()
