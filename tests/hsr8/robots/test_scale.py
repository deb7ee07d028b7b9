from dataclasses import is_dataclass
from typing import get_args, get_type_hints

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.keys import texts
from hsr8.robots.scale import RobotScale
from hsr8.scenario.schema import Scenario
from hsr8.scenario.section import Section

ratio = st.floats(0.05, 20.0)
scales = st.builds(RobotScale, ratio, ratio, ratio, ratio)


def annotated(annotation, name="scenario"):
    """Names and units of all fields of a section and of the sections in it."""
    if isinstance(annotation, type) and (
        issubclass(annotation, Section) or is_dataclass(annotation)
    ):
        for key, hint in get_type_hints(annotation, include_extras=True).items():
            yield from annotated(hint, f"{annotation.__name__}.{key}")
    for mark in getattr(annotation, "__metadata__", ()):
        if isinstance(mark, str):
            yield name, mark
    for part in get_args(annotation):
        yield from annotated(part, name)


UNITS = dict(annotated(Scenario))
# A relative length, and times of a pendulum.
EXCEPTIONS = (
    "World.scale",
    "TrackMover.scale",
    "TrackMover.time_scale",
    "Footsteps.single_support",
    "Footsteps.double_support",
)


@given(scales)
def test_units_scale_as_products_of_length_speed_and_turn(scale):
    def equal(unit, value):
        assert scale.factor(unit) == pytest.approx(value, rel=1e-12)

    assert scale.factor("m") == scale.length
    assert scale.factor("m/s") == scale.speed
    assert scale.factor("rad/s") == scale.turn
    equal("s", scale.time)
    equal("1/s", 1.0 / scale.time)
    equal("1/m²", scale.length**-2)
    equal("m²/s", scale.length * scale.speed)
    equal("m/s²", scale.speed / scale.time)
    equal("m/s^1.5", scale.length * scale.time**-1.5)
    equal("N s", scale.weight * scale.length**0.5)


@given(scales, st.sampled_from(sorted(set(UNITS.values()))))
def test_a_scale_and_its_inverse_cancel(scale, unit):
    inverse = RobotScale(
        1.0 / scale.length, 1.0 / scale.speed, 1.0 / scale.turn, 1.0 / scale.weight
    )
    assert scale.factor(unit) * inverse.factor(unit) == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize("unit", ["", "1", "kg", "m/s/s", "m//s", "m/", "cm", "m^-1", "m/1"])
def test_other_units_are_refused(unit):
    with pytest.raises(ValueError, match="expected powers of m, s, rad and N"):
        RobotScale().factor(unit)


def sections(annotation):
    """All sections and parameter classes that an annotation names."""
    if isinstance(annotation, type) and (
        issubclass(annotation, Section) or is_dataclass(annotation)
    ):
        yield annotation
        for hint in get_type_hints(annotation).values():
            yield from sections(hint)
    for part in get_args(annotation):
        yield from sections(part)


def test_annotated_units_agree_with_the_documentation():
    for section in set(sections(Scenario)):
        for key, text in texts(section).items():
            name = f"{section.__name__}.{key}"
            if name in UNITS and name not in EXCEPTIONS:
                assert f"[{UNITS[name]}]" in text, name
