import bench


def test_only_stages_that_are_much_slower_are_listed():
    kept = {"physics": 1.0, "vision": 0.5, "mission": 0.01, "whole loop": 3.0}
    measured = {"physics": 1.19, "vision": 0.61, "mission": 0.03, "whole loop": 3.7, "new": 9.0}
    lines = bench.slower(measured, kept)
    assert [line.partition(":")[0] for line in lines] == ["vision", "whole loop"]
    assert "22% above 0.50" in lines[0]
