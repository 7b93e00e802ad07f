"""What is published: what is in wheel and source archive, and the path of a new user."""

import json
import os
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "trundle"
OFFLINE = ("Could not find a version", "No matching distribution", "Connection", "resolve")


def run(*command, cwd, **more):
    """Run a command as a user does: nothing of this process's paths reaches it."""
    known = {k: v for k, v in os.environ.items() if k not in {"PYTHONPATH", "VIRTUAL_ENV"}}
    return subprocess.run(
        [*map(str, command)], cwd=cwd, env=known, capture_output=True, text=True, check=False,
        **more,
    )  # fmt: skip


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Wheel and source archive, by the builder that pyproject.toml names."""
    pytest.importorskip("hatchling")
    folder = tmp_path_factory.mktemp("dist")
    done = run(
        sys.executable, "-m", "hatchling", "build", "-d", folder, "-t", "wheel", "-t", "sdist",
        cwd=ROOT,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    (wheel,), (archive,) = folder.glob("*.whl"), folder.glob("*.tar.gz")
    return wheel, archive


@pytest.mark.slow
def test_the_wheel_holds_all_that_the_package_reads(built):
    """Every file of the package but caches: code, types, templates, data, and both licences."""
    with zipfile.ZipFile(built[0]) as file:
        names = set(file.namelist())
    wanted = {
        f"trundle/{path.relative_to(PACKAGE).as_posix()}"
        for path in PACKAGE.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert {name for name in names if name.startswith("trundle/")} == wanted
    for one in (
        "trundle/py.typed",
        "trundle/report/templates/record.html.j2",
        "trundle/criteria/data/vc.toml",
        "trundle/report/vendor/three/LICENSE",
    ):
        assert one in names
    beside = {name.partition("/")[2] for name in names if ".dist-info/" in name}
    assert {"licenses/LICENSE", "licenses/src/trundle/report/vendor/three/LICENSE"} <= beside


@pytest.mark.slow
def test_the_archive_holds_the_project_and_no_leavings(built):
    """Source, tests, docs and what make needs; no caches, results, hidden or built files."""
    with tarfile.open(built[1]) as file:
        names = [name.partition("/")[2] for name in file.getnames()]
    tops = {name.split("/")[0] for name in names}
    assert tops == {
        "src", "tests", "docs", "examples", "benchmarks", "scripts", "CHANGELOG.md", "CITATION.cff",
        "CONTRIBUTING.md", "LICENSE", "Makefile", "PKG-INFO", "README.md", "constraints.txt",
        "pyproject.toml", ".gitignore",
    }  # fmt: skip
    for name in names:
        parts = name.split("/")
        assert "__pycache__" not in parts
        assert not any(part.startswith(".") for part in parts if part != ".gitignore"), name
        assert not any(part.endswith(("-results", ".egg-info", ".pyc")) for part in parts), name


def test_the_citation_names_the_project_as_its_metadata_do():
    """Title, licence, authors and abstract are those of pyproject.toml; no version to fall behind."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    lines = (ROOT / "CITATION.cff").read_text("utf-8").splitlines()
    said = dict(line.split(": ", 1) for line in lines if ": " in line and line[0] != " ")
    assert said["cff-version"] == "1.2.0"
    assert (said["title"], said["license"]) == (project["name"], project["license"])
    assert said["abstract"].rstrip(".") == project["description"]
    assert [f"  - name: {one['name']}" for one in project["authors"]] == [
        line for line in lines if "name:" in line
    ]
    assert "version" not in said


def test_pins_name_no_host():
    """What is installed comes from wherever the machine's pip looks."""
    text = (ROOT / "constraints.txt").read_text("utf-8")
    assert "://" not in text
    assert "index" not in text.partition("\n")[2]


@pytest.mark.longest
def test_a_new_user_installs_the_wheel_and_runs_a_study_and_a_record(built, tmp_path):
    """In a bare environment, with what pip finds: version, new, check, run, report, assess, as in the README.

    TRUNDLE_PYTHON names another Python than this one.
    """
    python = os.environ.get("TRUNDLE_PYTHON", sys.executable)
    assert run(python, "-m", "venv", tmp_path / "env", cwd=tmp_path).returncode == 0
    binaries = tmp_path / "env" / "bin"
    done = run(
        binaries / "python", "-m", "pip", "install", "-q", "--only-binary", ":all:", built[0],
        cwd=tmp_path,
    )  # fmt: skip
    if done.returncode and any(word in done.stderr for word in OFFLINE):
        pytest.skip("pip reaches no index")
    assert done.returncode == 0, done.stderr

    def trundle(*arguments):
        """Return what the installed command prints."""
        found = run(binaries / "trundle", *arguments, cwd=tmp_path)
        assert found.returncode == 0, (arguments, found.stdout, found.stderr)
        return found.stdout

    assert built[0].name.split("-")[1] in trundle("--version")
    trundle("new", "unit.toml")
    study = tmp_path / "unit.toml"
    text = study.read_text("utf-8")
    assert text.count("runs = 50 ") == 2
    study.write_text(text.replace("runs = 50 ", "runs = 4 "), "utf-8")
    trundle("check", "unit.toml")
    trundle("run", "unit.toml", "--out", "unit-results")
    assert "VC-A" in (tmp_path / "unit-results" / "report.html").read_text("utf-8")
    if any(map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))):
        trundle("report", "unit-results", "--pdf")
        assert (tmp_path / "unit-results-report.pdf").read_bytes().startswith(b"%PDF-")
    t = np.arange(0.0, 20.0, 0.005)
    rows = zip(t, 30.0 * np.sqrt(2.0) * np.sin(2.0 * np.pi * 10.0 * t), strict=True)
    lines = ["time [s],z [um/s]", *(f"{at:.3f},{value:.4f}" for at, value in rows)]
    (tmp_path / "logger.csv").write_text("\n".join(lines), "utf-8")
    (said,) = json.loads(trundle("assess", "logger.csv", "--json"))
    # a tone of 30 um/s: VC-A allows 50, VC-B 25
    assert said["answers"][0]["class"] == "VC-A"
    assert (tmp_path / "logger-results" / "report.html").is_file()
