import numpy as np
import pytest

from hsr8.errors import ScenarioError
from hsr8.scenario.loader import dump, load_scenario, loads
from hsr8.scenario.track import n_placed, recordings
from hsr8.world.field.generator import draw_layout

# Three people cross a field of 5 m x 5 m in 8 s, from x = -4 to 4, one after the other.
LANES = {"a": (0.0, -1.5), "b": (3.0, 0.0), "c": (6.0, 1.5)}
SLOW = ["robot.speed.vx=0.4", "walking.limits.vx=0.4"]  # the crowd walks at 1 m/s


def csv(lanes=LANES, x=(-4.0, 4.0), speed=1.0):
    """Rows of people who walk along x, each from a time and at a y."""
    rows = ["t,x,y,id"]
    for name, (begin, y) in lanes.items():
        times = np.arange(0.0, (x[1] - x[0]) / speed + 1e-9, 0.5)
        rows += [f"{begin + t},{x[0] + speed * t},{y},{name}" for t in times.tolist()]
    return "\n".join(rows) + "\n"


@pytest.fixture
def load(tmp_path):
    def load(text=None, keys="", more=(), top=""):
        (tmp_path / "crowd.csv").write_text(csv() if text is None else text)
        file = tmp_path / "mine.toml"
        file.write_text(
            f'extends = "course"\n{top}\n[world]\nn_static = 0\nn_moving = 0\n[[world.mover]]\n'
            f'motion = "track"\nfile = "crowd.csv"\n{keys}\n'
        )
        return load_scenario(str(file), [*SLOW, *more])

    return load


def test_every_id_that_enters_the_field_is_a_mover(load):
    scenario = load()
    assert n_placed(scenario) == 3
    movers = draw_layout(scenario, 0).movers
    assert [mover.motion.id for mover in movers] == ["a", "b", "c"]
    assert [mover.color for mover in movers] == ["red", "green", "blue"]
    assert {m.color for m in draw_layout(load(keys='color = "violet"'), 0).movers} == {"violet"}
    # "c" appears after the run, "a" has left before it.
    assert n_placed(load(more=["duration=5"])) == 2
    assert n_placed(load(keys="start = 8.0")) == 2


def test_positions_in_the_world_are_scaled_and_moved(load):
    keys = "scale = 0.5\ntime_scale = 2.0\noffset = [0.25, 0.5]\nstart = 1.0\nend = 'stay'"
    scenario = load(keys=keys)
    motion = draw_layout(scenario, 0).movers[0].motion
    assert motion.position(0.0) == pytest.approx((0.25 + 0.5 * -3.0, 0.5 + 0.5 * -1.5))
    assert motion.position(4.0) == pytest.approx((0.25 + 0.5 * -1.0, 0.5 + 0.5 * -1.5))
    assert motion.velocity(4.0) == pytest.approx((0.25, 0.0))


def test_the_seed_draws_the_start_of_the_recording(load):
    scenario = load(keys="latest_start = 5.0\nend = 'repeat'")
    drawn = [draw_layout(scenario, seed).movers[0].motion.begin for seed in range(6)]
    assert len(set(drawn)) == 6
    assert 0.0 <= min(drawn) < 2.0
    assert 3.0 < max(drawn) <= 5.0
    assert draw_layout(scenario, 3).movers == draw_layout(loads(dump(scenario)), 3).movers


def test_a_drawn_start_keeps_clear_of_the_robot(load):
    scenario = load(
        keys="latest_start = 10.0\nend = 'repeat'", more=["robot.start.position=[0.0, 0.0]"]
    )
    for seed in range(2):
        for mover in draw_layout(scenario, seed).movers:
            assert np.hypot(*mover.position) >= mover.radius + 0.9


def test_a_repeated_crowd_comes_again(load):
    (_, recording) = next(recordings(load(keys='end = "repeat"')))
    track = recording.tracks()[0]
    period = 14.0 + 2.0 * track.linger
    assert track.position(1.0) == pytest.approx(track.position(1.0 + period))
    assert track.present(1.0)
    assert not track.present(13.0)


@pytest.mark.parametrize(
    ("text", "keys", "more", "key", "expected"),
    [
        (
            *(None, "offset = [0.0, 9.0]", (), "file"),
            "no track enters the field of 5 m x 5 m during the run, got positions from [-4, 7.5] "
            "to [4, 10.5] in W; expected another scale, offset or start",
        ),
        (
            *(None, "", ("robot.speed.vx=0.3",), "file"),
            "id a, t = 0.000 s: too fast for the world, got 1 m/s; expected at most 3 "
            "robot.speed.vx = 0.9 m/s: a smaller scale or a larger time_scale",
        ),
        (
            *(csv(x=(-1.0, 4.0)), "", (), "file"),
            "id b, t = 3.000 s: appears in the field, got [-1.000, 0.000]; expected the first "
            'sample outside the field or before start, a smaller world.size, or end = "stay"',
        ),
        (
            *(None, "", ("world.obstacle=[{position=[1.0, -1.4]}]",), "file"),
            "id a, t = 5.000 s: overlaps world.obstacle[0] at [1.000, -1.400], got 0.100 m "
            "between the axes; expected at least 0.160 m",
        ),
        (
            *(csv({"a": (0.0, 0.0), "b": (0.0, 0.1)}), "", (), "radius"),
            "overlaps id a in the field, got 0.100 m between the axes; expected at least 0.160 m: "
            "a radius of at most 0.050 or a larger scale",
        ),
    ],
)
def test_a_recording_that_does_not_fit_the_world_is_refused(load, text, keys, more, key, expected):
    with pytest.raises(ScenarioError) as caught:
        load(text, keys, more)
    (line,) = str(caught.value).splitlines()[1:]
    assert f": world.mover[0].{key}: crowd.csv, " in line
    assert expected in line


def test_a_mover_may_appear_in_the_field_where_it_waits_and_stays(load):
    motion = draw_layout(load(csv(x=(-1.0, 1.0)), 'end = "stay"'), 0).movers[1].motion
    assert motion.position(0.0) == pytest.approx((-1.0, 0.0))
    assert motion.position(99.0) == pytest.approx((1.0, 0.0))


def test_overlaps_outside_the_field_and_at_other_times_are_no_mistake(load):
    later = {"a": (0.0, 0.0), "b": (2.0, 0.0)}
    assert n_placed(load(csv(later))) == 2
    outside = csv({"a": (0.0, 0.0)}) + csv({"b": (0.0, 2.9), "c": (0.0, 2.95)}).split("\n", 1)[1]
    assert n_placed(load(outside)) == 1


def test_two_recordings_must_not_meet_unless_their_start_is_drawn(load):
    other = '[[world.mover]]\nmotion = "track"\nfile = "crowd.csv"\noffset = [0.0, 0.1]\n'
    with pytest.raises(ScenarioError, match=r"world\.mover\[1\]\.radius: crowd\.csv, id"):
        load(keys=other)
    assert n_placed(load(keys=f"{other}latest_start = 9.0\nend = 'repeat'")) == 6


def test_drawn_obstacles_keep_clear_of_the_tracks(load):
    scenario = load(more=["world.n_static=6"])
    for seed in range(2):
        layout = draw_layout(scenario, seed)
        for o in layout.static:
            for _, y in LANES.values():
                assert abs(o.position[1] - y) >= 0.3 + 0.08 + o.radius - 1e-9


def test_drawn_movers_never_meet_the_crowd(load):
    scenario = load(more=["world.n_moving=3", "world.motions=['shuttle', 'wander']"])
    for seed in range(2):
        layout = draw_layout(scenario, seed)
        at = layout.motion().positions(np.arange(0.0, 30.0, 0.05))
        for i, a in enumerate(layout.movers):
            for k, b in enumerate(layout.movers[:i]):
                gap = np.hypot(*(at[:, i] - at[:, k]).T).min()
                assert gap >= a.radius + b.radius
