import os
import signal

import pytest

from hsr8.cli.termination import like_ctrl_c


def test_sigterm_is_an_interruption():
    with pytest.raises(KeyboardInterrupt), like_ctrl_c():
        os.kill(os.getpid(), signal.SIGTERM)


def test_afterwards_signals_are_as_before():
    before = signal.getsignal(signal.SIGTERM)
    with like_ctrl_c():
        assert signal.getsignal(signal.SIGTERM) is not before
    assert signal.getsignal(signal.SIGTERM) is before
