from hsr8.suggestion import suggestion


def test_the_closest_word_is_suggested():
    assert suggestion("quik", ["paper", "quick"]) == "; did you mean 'quick'?"


def test_nothing_close_is_no_suggestion():
    assert suggestion("zzz", ["paper", "quick"]) == ""
    assert suggestion("quick", []) == ""
