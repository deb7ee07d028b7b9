from write_scenario_reference import BASIC, PAGE, ReferencePage

from hsr8.scenario.reference import public_keys


def test_the_page_is_fresh_and_has_every_public_key():
    """If this fails: python scripts/write_scenario_reference.py."""
    page = ReferencePage()
    assert PAGE.read_text(encoding="utf-8") == page.text
    assert page.keys.keys() >= BASIC | set(public_keys())
