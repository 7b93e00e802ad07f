"""Ctrl-C that a library swallows is not lost."""

import subprocess
import sys
import textwrap

import pytest


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_an_interrupt_lost_in_a_callback_is_raised_at_the_next_word_of_progress(name):
    """Within a callback from C Python prints and forgets it; the next stage of a run stops."""
    script = textwrap.dedent(
        f"""
        import ctypes, os, signal
        signal.signal(signal.{name}, signal.SIG_DFL)
        from trundle.cli.interrupts import listen
        from trundle.cli.screen import progress_bar
        listen()
        callback = ctypes.CFUNCTYPE(None)(lambda: os.kill(os.getpid(), signal.{name}))
        callback()
        print("went on", flush=True)
        with progress_bar(quiet=True) as tell:
            try:
                tell("coupled", 0.5)
            except KeyboardInterrupt:
                print("stopped", flush=True)
        """
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False
    )
    assert done.stdout.split("\n")[:2] == ["went on", "stopped"], done.stderr


def test_without_a_signal_progress_is_told():
    """What is told arrives, in the order in which it was told."""
    from trundle.cli.interrupts import interruptible

    heard = []
    tell = interruptible(lambda what, share: heard.append((what, share)))
    tell("a", 0.25)
    tell("b", 0.5)
    assert heard == [("a", 0.25), ("b", 0.5)]


def test_what_was_started_with_ctrl_c_ignored_goes_on_ignoring_it():
    """A job that a script put in the background is not stopped by Ctrl-C in the foreground."""
    script = textwrap.dedent(
        """
        import os, signal
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        from trundle.cli.interrupts import listen
        listen()
        os.kill(os.getpid(), signal.SIGINT)
        print("went on")
        """
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False
    )
    assert done.stdout == "went on\n", done.stderr
