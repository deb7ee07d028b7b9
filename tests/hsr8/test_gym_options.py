"""Options of environments and policies, and runs after a refused reset."""

import gymnasium
import numpy as np
import pytest

from hsr8.errors import UsageError
from hsr8.gym import Environment, as_gaze, as_planner

FAST = {"robot.body": "kinematic", "camera.source": "analytic"}
COMMON = [
    ({"observe": "local_map"}, "observe: got str 'local_map'; expected a list of local_map, image"),
    ({"observe": None}, "observe: got NoneType None; expected a list"),
    ({"observe": ["local-map"]}, "observe: .*got 'local-map'; .*did you mean 'local_map'"),
    ({"max_tracks": 0}, "max_tracks: got int 0; expected an integer from 1 to 128"),
    ({"max_tracks": 129}, "max_tracks: got int 129; expected an integer from 1 to 128"),
    ({"max_tracks": True}, "max_tracks: got bool True; expected an integer"),
    ({"max_tracks": 3.0}, "max_tracks: got float 3.0; expected an integer"),
    ({"max_tracks": "3"}, "max_tracks: got str '3'; expected an integer"),
    ({"normalized": 1}, "normalized: .*got int 1; expected True or False"),
    ({"normalised": True}, "normalised: unknown option, .*max_tracks.*did you mean 'normalized'"),
]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        *COMMON,
        ({"decides": "gaze"}, "decides: got str 'gaze'; expected a list of motion, gaze"),
        ({"decides": ()}, r"decides: got tuple \(\); expected a list of motion, gaze"),
        ({"settings": "duration=2"}, "settings: .*got str 'duration=2'; expected a list"),
        ({"settings": None}, "settings: .*got NoneType None; expected a list"),
        ({"settings": ["duration=2", 3]}, r"settings: .*got list \['duration=2', 3\]; expected"),
        ({"settings": {3: 4}}, "settings: wrong key, got int 3; expected a string"),
        ({"reward": {"speed": 1.0}}, "reward: .*'speed'; expected .*progress, time, tracking"),
        ({"reward": {"time": True}}, "reward: .*of time, got bool True; expected a finite number"),
        ({"reward": {"time": "1"}}, "reward: .*of time, got str '1'; expected a finite number"),
        ({"reward": {"time": np.nan}}, "reward: .*of time, got float nan; expected a finite"),
        ({"reward": []}, r"reward: .*got list \[\]; expected a dictionary"),
        ({"end_on_contact": "no"}, "end_on_contact: .*got str 'no'; expected True or False"),
        ({"max_track": 3}, "max_track: unknown option, .*settings.*did you mean 'max_tracks'"),
    ],
)
def test_an_environment_refuses_an_invalid_option(options, message):
    with pytest.raises(UsageError, match=message):
        gymnasium.make("hsr8.gym:hsr8/Gaze-v0", **({"settings": FAST} | options))


@pytest.mark.parametrize("plugin", [as_gaze, as_planner])
@pytest.mark.parametrize(("options", "message"), COMMON)
def test_a_plugin_refuses_an_invalid_option(plugin, options, message):
    with pytest.raises(UsageError, match=message):
        plugin(lambda _: np.zeros(5), **options)


@pytest.mark.parametrize("plugin", [as_gaze, as_planner])
def test_a_plugin_requires_a_policy(plugin):
    with pytest.raises(UsageError, match="policy: got NoneType None; expected an object with pred"):
        plugin(None)


def test_settings_may_be_nested():
    nested = {"robot": {"body": "kinematic"}, "camera": {"source": "analytic", "period_ms": 80}}
    flat = FAST | {"camera.period_ms": 80}
    assert Environment(settings=nested).scenario == Environment(settings=flat).scenario
    assert Environment(settings=nested).scenario.camera.period_ms == 80


def test_a_run_may_follow_a_refused_reset():
    env = gymnasium.make("hsr8.gym:hsr8/Gaze-v0", scenario="quick", settings=FAST)
    with pytest.raises(UsageError, match="seed"):
        env.reset(seed=2**63)
    with pytest.raises(RuntimeError, match="expected reset"):
        env.step(np.zeros(2, np.float32))
    env.reset(seed=1)
    observation, *_ = env.step(np.zeros(2, np.float32))
    assert observation in env.observation_space
    env.close()


def test_an_image_without_a_render_mode_is_none_with_a_warning():
    env = gymnasium.make("hsr8.gym:hsr8/Gaze-v0", scenario="quick", settings=FAST)
    env.reset(seed=1)
    with pytest.warns(UserWarning, match="render_mode: .*got None; expected rgb_array"):
        assert env.render() is None
    env.close()
