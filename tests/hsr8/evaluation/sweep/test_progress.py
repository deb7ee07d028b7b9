from hsr8.evaluation.sweep.progress import SweepProgress, spell


def test_every_run_has_a_line_where_there_is_no_terminal(row, capsys):
    progress = SweepProgress(5, 2)
    progress.on_row(row(7))
    progress.on_row(row(8, success=False, collisions=1))
    progress.on_row({"seed": 9, "outcome": "crashed", "error": "killed by SIGKILL"})
    progress.tick()
    progress.close()
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 3
    assert lines[0].startswith("3/5 runs   1 succeeded, 0 not")
    assert lines[0].endswith("seed 7: good")
    assert "1 succeeded, 1 not, 1 crashed" in lines[2]
    assert "killed by SIGKILL" in lines[2]


def test_times_are_spelled():
    assert spell(7.2) == "7 s"
    assert spell(600) == "10 min"
    assert spell(2 * 3600 + 5 * 60) == "2 h 05 min"
