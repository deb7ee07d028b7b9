from hypothesis import given
from hypothesis import strategies as st

from hsr8.seeds import named_rng


@given(st.integers(0, 2**32 - 1))
def test_a_subsystem_draws_the_same_for_the_same_seed(seed):
    assert named_rng(seed, "body").random() == named_rng(seed, "body").random()


@given(st.integers(0, 2**32 - 1))
def test_subsystems_draw_independently(seed):
    draws = {named_rng(seed, name).random() for name in ("body", "camera", "belief")}
    assert len(draws) == 3
