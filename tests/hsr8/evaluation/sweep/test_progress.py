from hsr8.evaluation.sweep.progress import SweepProgress


def test_every_run_has_a_line_where_there_is_no_terminal(result, capsys):
    progress = SweepProgress(5, 2)
    progress.on_result(result(7))
    progress.on_result(result(8, success=False, collisions=1), "crowd")
    progress.on_result({"seed": 9, "outcome": "crashed", "error": "killed by SIGKILL"})
    progress.refresh()
    progress.close()
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 3
    assert lines[0].startswith("3/5 runs   1 succeeded, 0 failed, 0 crashed")
    assert lines[0].endswith("seed 7: success")
    assert lines[1].endswith("crowd seed 8: 1 collision")
    assert "1 succeeded, 1 failed, 1 crashed" in lines[2]
    assert "killed by SIGKILL" in lines[2]
