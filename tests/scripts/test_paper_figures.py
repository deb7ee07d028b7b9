"""Facts behind the paper's figures."""

import field_figure
import figure_style
import gaze_figures
import numpy as np
import pytest

from navigation.motion.avoid_obstacle import spiral_turn

PRINTED, DEFAULT = "printed sum, 0.75 and 0.25", "blend by distance (default)"


@pytest.fixture(scope="module")
def panels():
    return {p.name: p for p in field_figure.panels()}


def test_every_path_of_figure_3_ends_at_the_goal_and_none_of_the_default_enters_the_disc(panels):
    """The printed weights cannot keep all paths out: the sum turns 19.5 deg at most."""
    for name, panel in panels.items():
        if "sum" in name or "default" in name:
            assert panel.arrived.all(), name
    printed, default = (panels[n] for n in (PRINTED, DEFAULT))
    assert default.clearance.min() > 0.05
    assert default.clearance.min() > printed.clearance.min()


def test_the_printed_sum_turns_at_most_asin_one_third(panels):
    goal, total = panels["move-to-goal, eq. (8)"].arrows, panels[PRINTED].arrows
    cosine = (goal * total).sum(axis=1)
    assert cosine.min() >= np.cos(np.arcsin(1 / 3)) - 1e-9


def test_within_d_con_the_paths_bend_towards_the_arrival_heading(panels):
    for path in panels[DEFAULT].paths:
        gone = np.hypot(*np.diff(path, axis=0).T) > 1e-9
        steps = np.diff(path, axis=0)[gone]
        distance = np.hypot(*(path[:-1][gone] - field_figure.TARGET).T)
        heading = np.arctan2(steps[:, 1], steps[:, 0])
        error = np.abs(heading - field_figure.GOAL_HEADING)
        near, far = error[distance < 0.1], error[(distance > 0.7) & (distance < 0.9)]
        assert near.mean() < max(far.mean(), 0.35)


def test_the_avoiding_field_circulates_in_opposite_senses_and_k_r_bends_the_outer_part(panels):
    u, points = panels["avoid-obstacle, eq. (9)"].arrows, field_figure.grid()
    away = points - np.array(field_figure.OBSTACLE)
    spin = away[:, 0] * u[:, 1] - away[:, 1] * u[:, 0]
    goal = field_figure.TARGET - np.array(field_figure.OBSTACLE)
    side = goal[0] * away[:, 1] - goal[1] * away[:, 0]
    acts = (np.abs(u).sum(axis=1) > 0.0) & (np.abs(side) > 0.05) & (np.abs(spin) > 1e-3)
    assert np.all(np.sign(spin[acts]) == -np.sign(side[acts]))
    gap = np.linspace(0.0, 1.0, 50)
    same = spiral_turn(gap, 0.25, 0.4, 0.3) == spiral_turn(gap, 0.25, 0.4, 0.1)
    assert np.array_equal(same, gap <= 0.4)


def test_the_gaze_window_is_what_the_camera_sees_of_the_floor():
    fov, height = (1.5, 1.22), 0.47
    corners = figure_style.window(0.0, -0.7, fov, height)
    assert corners[:, 1].max() == pytest.approx(-corners[:, 1].min())
    nearest = height / np.tan(0.7 + 0.61)
    assert corners[:, 0].min() == pytest.approx(nearest, rel=1e-6)
    assert np.hypot(*corners.T).max() <= figure_style.FAR + 1e-9
    turned = figure_style.window(0.8, -0.7, fov, height)
    angle = np.arctan2(*turned.mean(axis=0)[::-1])
    assert angle == pytest.approx(0.8, abs=1e-6)


@pytest.mark.gl
def test_the_tour_has_gazes_that_the_head_reaches(monkeypatch):
    monkeypatch.setattr(gaze_figures, "DURATION", 5.0)
    (look, *_) = gaze_figures.looks(gaze_figures.recorded())
    view = look.after.belief.view
    assert abs(view.pan - look.frame.gaze.pan) < 0.3
    assert look.after.time > look.frame.time
