"""What a command prints cannot steer a terminal, and every terminal can show it."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

import trundle.cli
from studies import GOOD, run_main
from trundle.cli.saying import printable, say
from trundle.cli.screen import print_table

HOSTILE = "a\x1b[31m\u202e"


def test_what_is_neither_shown_nor_a_blank_becomes_a_question_mark(capsys):
    """Escapes, bells, halves of a character and marks that turn a line round; blanks stay."""
    assert printable("a\x1b[2J\x07\u202e\udcff\x9b.csv\nb") == "a?[2J????.csv\nb"
    for text in ("größe 1\u00a0000\u202fm ✓ 床", "│ a │\n└───┘", ""):
        assert printable(text) == text
    say(HOSTILE)
    say(HOSTILE, error=True)
    assert tuple(capsys.readouterr()) == ("a?[31m?\n",) * 2


def test_every_command_prints_by_way_of_it():
    """A print of its own in any module would let names of files through."""
    modules = Path(trundle.cli.__file__).parent.glob("*.py")
    prints = {
        module.name
        for module in modules
        for node in ast.walk(ast.parse(module.read_text("utf-8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
        if node.func.id == "print"
    }
    assert prints == {"saying.py"}


def test_titles_headings_and_cells_of_tables_are_cleaned(capsys):
    """Rich passes escapes in a text on as they are."""
    print_table(HOSTILE, (HOSTILE,), [(HOSTILE,)])
    assert capsys.readouterr().out.count("a?[31m?") == 3


@pytest.mark.parametrize("command", ["check", "new", "assess"])
def test_names_of_files_do_not_steer_the_terminal(tmp_path, monkeypatch, capsys, command):
    """Names that are shown before anything failed: on the output, as on the error stream."""
    monkeypatch.chdir(tmp_path)
    name = HOSTILE + (".csv" if command == "assess" else ".toml")
    if command == "check":
        Path(name).write_text(GOOD)
    if command == "assess":
        rows = "\n".join(f"{i / 200:.3f},{(i * 7) % 11 - 5}" for i in range(4000))
        Path(name).write_text(f"time [s],z [um/s]\n{rows}\n")
    code, said = run_main(monkeypatch, capsys, command, name)
    assert code == 0
    assert "\x1b" not in said.out + said.err
    assert "a?[31m?" in said.out


def test_a_terminal_of_another_alphabet_shows_question_marks(tmp_path):
    """With ASCII alone no character of a title or a table stops a command."""
    (tmp_path / "u.toml").write_text(GOOD.replace('"Small"', '"Größe"'), encoding="utf-8")
    for arguments in (("check", "u.toml"), ("vehicles",), ("--help",)):
        done = subprocess.run(
            [sys.executable, "-m", "trundle", *arguments], cwd=tmp_path, check=False,
            env={**os.environ, "PYTHONIOENCODING": "ascii"}, capture_output=True, text=True,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        assert "Traceback" not in done.stderr
        if arguments[0] == "check":
            assert "Gr??e" in done.stdout
