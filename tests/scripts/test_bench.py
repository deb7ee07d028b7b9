import bench


def test_only_what_is_much_slower_is_told():
    kept = {"physics": 1.0, "vision": 0.5, "mission": 0.01, "whole loop": 3.0}
    found = {"physics": 1.19, "vision": 0.61, "mission": 0.03, "whole loop": 3.7, "new": 9.0}
    told = bench.slower(found, kept)
    assert [line.partition(":")[0] for line in told] == ["vision", "whole loop"]
    assert "22% above 0.50" in told[0]


def test_worlds_grow_at_the_same_density():
    for n in (8, 16, 32, 64, 128):
        static, moving, size = bench.world_of(n)
        side = float(size.partition("[")[2].partition(",")[0])
        assert int(static.partition("=")[2]) + int(moving.partition("=")[2]) == n
        assert abs(side**2 / n - 25.0 / 16.0) < 0.01
