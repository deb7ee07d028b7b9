import os
import signal

import pytest

from hsr8.cli.termination import like_ctrl_c


def test_sigterm_interrupts():
    with pytest.raises(KeyboardInterrupt), like_ctrl_c():
        os.kill(os.getpid(), signal.SIGTERM)


def test_the_handlers_are_restored():
    before = signal.getsignal(signal.SIGTERM)
    with like_ctrl_c():
        assert signal.getsignal(signal.SIGTERM) is not before
    assert signal.getsignal(signal.SIGTERM) is before
