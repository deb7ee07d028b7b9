from write_data_reference import PAGE, page


def test_the_page_is_fresh():
    """If this fails: python scripts/write_data_reference.py."""
    assert PAGE.read_text(encoding="utf-8") == page()


def test_every_column_has_a_meaning():
    rows = [line for line in page().splitlines() if line.startswith("| `")]
    assert len(rows) > 150
    for row in rows:
        assert row.split(" | ")[-1].strip(" |"), row
