from write_scenario_reference import PAGE, ReferencePage

from hsr8.scenario.public_keys import BASIC, EXPERIMENTAL, PUBLIC


def test_the_page_is_fresh_and_has_every_public_key():
    """If this fails: python scripts/write_scenario_reference.py."""
    page = ReferencePage()
    assert PAGE.read_text(encoding="utf-8") == page.text
    assert page.keys.keys() >= PUBLIC | BASIC | EXPERIMENTAL
