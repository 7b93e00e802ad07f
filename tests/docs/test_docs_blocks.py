"""What pages show can be done: studies are accepted, code compiles, commands and options exist."""

import re
import shlex
import tomllib
from pathlib import Path

import pytest
import typer.main
from typer.testing import CliRunner

import trundle
from trundle.cli.app import app
from trundle.study_file.read import read_text

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("**/*.md"))]
PAGES = [page for page in PAGES if "generated" not in page.parts]
BLOCK = re.compile(r"^( *)```([^\n]*)\n(.*?)^\1```", re.MULTILINE | re.DOTALL)
UNSAID = ("this is required", "a study needs at least one")
"""What a part of a study may lack."""


def blocks(*kinds):
    """Return the blocks of some kinds, with where they stand."""
    found = []
    for page in PAGES:
        text = page.read_text("utf-8")
        for block in BLOCK.finditer(text):
            line = text[: block.start()].count("\n") + 1
            if block[2].strip() in kinds:
                found.append(pytest.param(block[3], id=f"{page.name}:{line}"))
    return found


def problems_of(text):
    """Return what the reader has against a study, or a part of one."""
    _, problems = read_text(text, "page")
    return [str(one) for one in problems if one.rule not in UNSAID]


@pytest.mark.parametrize("text", blocks("toml"))
def test_studies_and_their_parts_are_accepted(text):
    assert tomllib.loads(text)
    assert not problems_of(text)


def test_a_mistake_in_a_study_would_be_seen():
    assert problems_of('[[road]]\nclas = "B"')
    assert problems_of('[floor]\nkind = "plan"\nmesh_size = "1 kg"')
    assert not problems_of('[[road]]\nclass = "B"')


@pytest.mark.parametrize("text", blocks("python"))
def test_code_compiles(text):
    compile(text, "page", "exec")


def commands_in(text):
    """Give what a shell would be given of trundle's commands."""
    for line in text.replace("\\\n", " ").splitlines():
        words = line.strip().removeprefix("$ ")
        if words.startswith("trundle "):
            yield words


def called(line):
    """Return the command that a line calls, and the options that it gives."""
    words = shlex.split(line, comments=True)[1:]
    command = typer.main.get_command(app)
    while words and words[0] in getattr(command, "commands", {}):
        command = command.commands[words.pop(0)]
    return command, words


def mistakes(line):
    command, words = called(line)
    known = {"--help", "-h", *(name for one in command.params for name in one.opts)}
    given = [word.partition("=")[0] for word in words if re.match(r"--?[a-z]", word)]
    wrong = [word for word in given if word not in known]
    alone = not getattr(command, "commands", None) or given or command.name == "vehicles"
    return wrong if alone else [*wrong, f"no such command: {line}"]


LINES = [
    pytest.param(line, id=f"{block.id} {line[:50]}")
    for block in blocks("", "sh", "bash", "console", "text")
    for line in commands_in(block.values[0])
]


@pytest.mark.parametrize("line", LINES)
def test_commands_and_options_exist(line):
    assert not mistakes(line)


def test_a_mistake_in_a_command_would_be_seen():
    assert mistakes("trundle run unit.toml --worker 8")
    assert mistakes("trundle runn unit.toml")
    assert not mistakes("trundle run unit.toml -w 8   # --worker")
    assert len(LINES) > 30


def test_inline_commands_exist():
    for page in PAGES:
        for line in re.findall(r"`(trundle [^`\n]+)`", page.read_text("utf-8")):
            assert not mistakes(line), f"{page.name}: {line}"


def links():
    """Give the links of pages to files of the project."""
    for page in [*PAGES, ROOT / "CHANGELOG.md"]:
        text = BLOCK.sub("", page.read_text("utf-8"))
        for link in re.findall(r"\]\(([^)\s]+)\)", text):
            if not re.match(r"[a-z]+:|#", link) and "generated/" not in link:
                yield page, link.partition("#")[0]


def test_links_lead_to_files():
    found = list(links())
    assert len(found) > 30
    assert not [f"{page.name}: {link}" for page, link in found if not (page.parent / link).exists()]


TEXTS = [path for path in (ROOT / "docs").rglob("*.md") if "generated" not in path.parts]


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: path.stem)
def test_nothing_that_is_written_is_left_out_or_shown_raw(path):
    """A line that begins with % is a remark to the builder; a formula at a cell's beginning is none if its end is a number."""
    lines = re.sub(r"```.*?```", "", path.read_text("utf-8"), flags=re.DOTALL).splitlines()
    assert [line for line in lines if line.startswith("%")] == []
    cells = [cell.strip() for line in lines if line.startswith("|") for cell in line.split("|")]
    assert [cell for cell in cells if re.match(r"\$.*\d$", cell)] == []
    assert [line for line in lines if re.search(r"\(docs/[a-z_-]+\.md\)", line)] == []


def test_the_wheel_that_the_first_page_installs_is_this_version():
    text = (ROOT / "docs" / "get_started.md").read_text("utf-8")
    assert set(re.findall(r"trundle-([\d.]+)-py3", text)) == {trundle.__version__}


def shown(number):
    """Return what "Get started" says that its commands print."""
    text = (ROOT / "docs" / "get_started.md").read_text("utf-8")
    return re.findall(r"```text\n(.*?)```", text, re.DOTALL)[number]


def printed(*words, monkeypatch, folder):
    monkeypatch.chdir(folder)
    monkeypatch.setenv("COLUMNS", "100")
    result = CliRunner().invoke(app, list(words))
    assert result.exit_code == 0, result.output
    return result.output


@pytest.mark.slow
def test_a_new_study_is_checked_as_the_first_page_says(tmp_path, monkeypatch):
    here = {"monkeypatch": monkeypatch, "folder": tmp_path}
    assert printed("new", "unit.toml", **here) == shown(0)
    found, said = printed("check", "unit.toml", **here), shown(1).splitlines()
    told = [line for line in said if not line.startswith("takes:")]  # time is the machine's
    assert [line for line in told if line not in found.splitlines()] == []


@pytest.mark.slow
def test_a_record_is_assessed_as_the_first_page_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "docs" / "get_started.md").read_text("utf-8")
    exec(compile(re.search(r"```python\n(.*?)```", text, re.DOTALL)[1], "page", "exec"), {})
    found = printed("assess", "record.csv", monkeypatch=monkeypatch, folder=tmp_path)
    rows = [line for line in shown(4).splitlines() if "│" in line]
    assert len(rows) == 10
    assert [row for row in rows if row not in found] == []


@pytest.mark.longest
def test_a_new_study_is_run_as_the_first_page_says(tmp_path, monkeypatch):
    here = {"monkeypatch": monkeypatch, "folder": tmp_path}
    printed("new", "unit.toml", **here)
    found = printed("run", "unit.toml", **here)
    rows = [line for line in shown(3).splitlines() if "│" in line]
    assert len(rows) == 7
    assert [row for row in rows if row not in found] == []
    assert (tmp_path / "unit-results" / "report.html").exists()
