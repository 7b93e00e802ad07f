"""Exit codes and streams of the whole command: input, mathematics, an interrupt, a closed pipe."""

import errno
import json
import os
import signal
import subprocess
import sys
import threading

import pytest

from studies import GOOD, run_main
from trundle.cli import commands, interrupts
from trundle.errors import ComputationError, InputError, UnrestrainedModeError


@pytest.fixture
def raising(monkeypatch, capsys):
    """Return what runs 'criteria' where that ends in an error; its code, and what it said."""

    def run(error, *options):
        def criteria(**_settings):
            raise error

        monkeypatch.setattr(commands, "criteria", criteria)
        return run_main(monkeypatch, capsys, "criteria", *options)

    return run


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (InputError("no such file"), 2, "error: no such file\n"),
        (ComputationError("it overflowed"), 1, "error: the computation failed: it overflowed\n"),
        (UnrestrainedModeError("it floats"), 1, "error: the computation failed: it floats\n"),
    ],
)
def test_input_and_mathematics_have_exit_codes_of_their_own(raising, error, code, words):
    """Two is the user's to mend and one is not: a script must be able to tell them apart."""
    found, said = raising(error)
    assert found == code
    assert (said.out, said.err) == ("", words)
    found, said = raising(error, "--json")
    assert found == code
    assert json.loads(said.out) == {"error": str(error)}
    assert said.err == words


def test_an_interrupt_says_what_stands(raising):
    """130 is what shells expect of Ctrl-C; what was finished is not lost, and that is told."""
    code, said = raising(KeyboardInterrupt())
    assert code == 130
    assert said.out == ""
    assert said.err.startswith("interrupted: no results were written, and earlier ones still stand")


def test_what_is_no_trundle_error_is_not_dressed_as_one(raising):
    """A defect must be seen as one, and not as a mistake of the user."""
    with pytest.raises(ZeroDivisionError):
        raising(ZeroDivisionError())


def test_a_file_that_the_system_refuses_is_told_by_its_name(raising):
    """Names that are too long, files of others: wherever they are met, they are input."""
    for number in (errno.ENAMETOOLONG, errno.EACCES):
        code, said = raising(OSError(number, os.strerror(number), "b.bdf"), "--json")
        assert code == 2
        assert said.err == f"error: b.bdf: {os.strerror(number)}\n"
    with pytest.raises(OSError, match="no file"):
        raising(OSError("of no file: a defect"))


def test_a_message_cannot_steer_the_terminal(raising):
    """Escape, bell and a right-to-left mark become question marks; line breaks and umlauts stay."""
    _, said = raising(InputError("größe \x1b[2J\x07\u202e.csv\nremedy: ✓"))
    assert said.err == "error: größe ?[2J??.csv\nremedy: ✓\n"


def test_a_signal_to_end_is_an_interrupt(monkeypatch):
    """A scheduler's SIGTERM ends as Ctrl-C does: what was finished is kept."""
    monkeypatch.setattr(interrupts, "_asked", threading.Event())
    numbers = (signal.SIGINT, signal.SIGTERM)
    before = [signal.getsignal(number) for number in numbers]
    try:
        interrupts.listen()
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGTERM)
    finally:
        for number, handler in zip(numbers, before, strict=True):
            signal.signal(number, handler)


@pytest.mark.parametrize(
    "arguments",
    [
        ("nonsense",),
        ("check",),
        ("check", "s.toml", "--colour"),
        ("run", "s.toml", "--workers", "0"),
        ("mitigate", "s.toml", "--runs", "0"),
        ("assess",),
        ("assess", "r.csv", "--events", "nan"),
        ("assess", "r.csv", "--events", "0.5"),
        ("transfer", "s.toml", "--from", "tool", "--lines", "1"),
        ("export", "s.toml", "x.vtu", "--frames", "1"),
    ],
)
def test_slips_of_the_command_line_are_input_and_change_nothing(
    monkeypatch, capsys, tmp_path, arguments
):
    """Exit code 2 as for any other input, without a traceback; no file appears."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(GOOD)
    code, said = run_main(monkeypatch, capsys, *arguments)
    assert code == 2
    assert "Traceback" not in said.err + said.out
    assert [file.name for file in tmp_path.iterdir()] == ["s.toml"]


def test_a_reader_that_leaves_early_is_no_traceback():
    """The output goes into a pipe whose other end is closed, as head closes it."""
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        [sys.executable, "-m", "trundle", "criteria"],
        stdout=writer, stderr=subprocess.PIPE, text=True, check=False, timeout=60,
    )  # fmt: skip
    os.close(writer)
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
