import os
import subprocess

from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.files.text import shell_line

WORDS = st.lists(st.binary(min_size=1, max_size=8).filter(lambda b: b"\0" not in b), min_size=1)


@settings(max_examples=40, deadline=None)
@given(WORDS)
def test_a_shell_reads_the_words_from_a_printable_line(words):
    line = shell_line(map(os.fsdecode, words))
    assert line.isprintable()
    command = ["bash", "-c", f"printf '%s\\0' {line}"]
    printed = subprocess.run(command, capture_output=True, check=True).stdout
    assert printed.split(b"\0")[:-1] == words
