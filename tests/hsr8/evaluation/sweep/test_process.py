import os

from hsr8.evaluation.sweep.process import environment, start


def test_a_command_line_runs_in_a_process_of_its_own():
    process = start(["--version"])
    printed, said = process.communicate(timeout=60.0)
    assert printed.startswith("hsr8 ")
    assert said == ""
    assert process.returncode == 0


def test_one_thread_unless_the_user_says_otherwise(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    found = environment()
    assert (found["OMP_NUM_THREADS"], found["OPENBLAS_NUM_THREADS"]) == ("3", "1")
    assert found["PATH"] == os.environ["PATH"]
