"""Every tutorial can be followed: its files load, its commands run, and say what the page says."""

import contextlib
import io
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import trundle as tr

TUTORIALS = Path(__file__).parents[2] / "docs" / "tutorials"
PAGES = sorted(page for page in TUTORIALS.glob("*.md") if page.stem != "index")
LONGEST = ("days-traffic", "floor-study", "notebook", "own-building")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
NAMED = re.compile(r"# ([\w-]+\.toml)\n")
CODE = re.compile(r"# ends with code (\d)")
BORDERS = re.compile(r"[\s┃│]+")


def blocks_of(page):
    """Return the fenced blocks of a page, each with its kind."""
    return BLOCK.findall(page.read_text("utf-8"))


def studies_of(page):
    """Return the whole study files of a page by their names."""
    return {NAMED.match(text)[1]: text for kind, text in blocks_of(page) if kind == "toml"}


def plain(line):
    """Return a line without the borders of tables: what is said, not how it is set."""
    return BORDERS.sub(" ", line).strip()


def typed(line, folder):
    """Type a command of a page, and return what it says."""
    words = shlex.split(line, comments=True)
    assert words[0] == "trundle", f"tutorials type nothing but trundle: {line}"
    said = subprocess.run(
        [sys.executable, "-m", "trundle", *words[1:]],
        cwd=folder, capture_output=True, text=True, check=False,
        env={**os.environ, "PYTHONIOENCODING": "utf-8", "PYTHONPATH": os.pathsep.join(sys.path)},
    )  # fmt: skip
    expected = int(CODE.search(line)[1]) if CODE.search(line) else 0
    assert said.returncode == expected, said.stdout + said.stderr
    return said.stdout + said.stderr


def executed(text, names):
    """Run a block of Python as a notebook would, and return what it prints."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(text, "<tutorial>", "exec"), names)
    return printed.getvalue()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_study_files_of_tutorials_load(page):
    """All of them are whole: each is a study as it stands."""
    for name, text in studies_of(page).items():
        study = tr.study_from_text(text)
        assert study.assessment is not None, name


def test_every_tutorial_is_listed():
    """None is forgotten in the index, and none that is listed is missing."""
    listed = re.search(
        r"```\{toctree\}.*?```", (TUTORIALS / "index.md").read_text("utf-8"), re.DOTALL
    )
    assert set(listed[0].split("\n")[3:-1]) == {page.stem for page in PAGES}


def followed():
    """Return every page with the mark that its length asks for."""
    long, short = pytest.mark.longest, pytest.mark.slow
    marks = [long if page.stem in LONGEST else short for page in PAGES]
    return [pytest.param(p, marks=m, id=p.stem) for p, m in zip(PAGES, marks, strict=True)]


@pytest.mark.parametrize("page", followed())
def test_a_tutorial_can_be_followed(page, tmp_path, monkeypatch):
    """Blocks are taken in their order; what stands below one is what it says.

    Lines are compared without borders of tables; those of three dots stand for any. The numbers are
    a snapshot by design: readers hold them against their own screens.
    """
    monkeypatch.chdir(tmp_path)
    names, said = {"__name__": "__main__"}, ""
    for kind, text in blocks_of(page):
        if kind == "toml":
            (tmp_path / NAMED.match(text)[1]).write_text(text, "utf-8")
        elif kind == "python":
            said = executed(text, names)
        elif kind == "sh":
            said = "".join(typed(line, tmp_path) for line in text.splitlines())
        elif kind == "text":
            heard = [plain(line) for line in said.splitlines()]
            for line in filter(None, map(plain, text.splitlines())):
                assert line == "..." or line in heard, f"{page.name}: {line!r} is not said"
        else:
            pytest.fail(f"{page.name}: a block of {kind!r} is followed by nobody")
    assert names.keys() - {"__name__"} or said
