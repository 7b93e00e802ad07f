"""What a command is pointed at is opened as what it is, or refused with the way out."""

import json
from pathlib import Path

import pytest

from studies import GOOD, run_main
from trundle._progress import silent
from trundle.cli import view_command
from trundle.cli.export_command import Wanted, _origin, modes_to
from trundle.cli.opened import open_path
from trundle.errors import InputError, StudyError
from trundle.study_file import study_from_text

DECK = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,3.,0.,0.
GRID,3,,6.,0.,0.
CBAR,1,1,1,2,0.,0.,1.
CBAR,2,1,2,3,0.,0.,1.
PBAR,1,1,0.02,1.0E-4,2.0E-4,1.0E-4
MAT1,1,3.0E10,,0.2,2500.
SPC1,1,123456,1
SPC1,1,123456,3
ENDDATA
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A study, a model without units, a folder without results, and a file of nothing."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(GOOD)
    (tmp_path / "beam.bdf").write_text(DECK)
    (tmp_path / "empty").mkdir()
    (tmp_path / "notes.txt").write_text("words\n")
    return tmp_path


def test_a_study_is_told_by_its_ending_in_any_case(folder):
    """S.TOML on a disk of Windows is a study too; there are no results yet."""
    (folder / "S2.TOML").write_text(GOOD)
    for name in ("s.toml", "S2.TOML"):
        opened = open_path(Path(name))
        assert opened.study.title == "Small"
        assert opened.structure is opened.study.floor
        assert opened.result is None
        assert opened.read is None


def test_a_model_needs_its_units_and_says_what_it_read(folder):
    """Two beams of 3 m of 0.02 m2 and 2500 kg/m3 are 300 kg in SI; in mm they would be nothing."""
    opened = open_path(Path("beam.bdf"), units="N, m")
    assert opened.study is None
    assert opened.read is not None
    assert len(opened.structure.nodes) == 3
    ends = opened.structure.nodes[:, 0]
    assert (ends.min(), ends.max()) == (0.0, 6.0)
    centimetres = open_path(Path("beam.bdf"), units="N, cm")
    assert centimetres.structure.nodes[:, 0].max() == pytest.approx(0.06)


@pytest.mark.parametrize(
    ("path", "options", "told"),
    [
        ("s.toml", {"units": "N, m"}, "are of models; a study says them itself"),
        ("s.toml", {"kind": "nastran"}, "are of models; a study says them itself"),
        ("empty", {"ignore": "X"}, "are of models; a study says them itself"),
        ("empty", {}, "empty: holds no results that can be read back"),
        ("beam.bdf", {"kind": "abaqus"}, "--kind 'abaqus': must be one of "),
        ("beam.bdf", {"units": "N, kg"}, "--units: "),
        ("beam.bdf", {"units": "metre"}, "--units: "),
        ("notes.txt", {}, "of no format that is known"),
        ("nothing.bdf", {}, "nothing.bdf: no such file"),
        ("nothing", {}, "nothing: no such file"),
    ],
)
def test_what_cannot_be_opened_is_refused_with_the_way_out(folder, path, options, told):
    """Options of models for what is none; formats, units and files that are not there."""
    with pytest.raises(InputError) as refused:
        open_path(Path(path), **options)
    assert told in str(refused.value)


def test_a_model_with_a_card_that_is_not_known_is_not_opened_by_halves(folder):
    """A spring that is passed over would be another model; by name it may be."""
    (folder / "odd.bdf").write_text(
        DECK.replace("SPC1,1,123456,3", "CWONDER,9,1,2\nSPC1,1,123456,3")
    )
    with pytest.raises(StudyError) as refused:
        open_path(Path("odd.bdf"), units="N, m")
    (problem,) = [p for p in refused.value.problems if "CWONDER" in f"{p.place} {p.value} {p.rule}"]
    assert problem.place == "odd.bdf, line 11"  # behind ten lines that stayed
    opened = open_path(Path("odd.bdf"), units="N, m", ignore=" cwonder , ,CWONDER")
    assert len(opened.structure.nodes) == 3


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("", None),
        ("8.54, 47.38", (8.54, 47.38)),
        ("-180,-89.9", (-180.0, -89.9)),
        ("0,0", (0.0, 0.0)),
    ],
)
def test_an_origin_is_longitude_and_then_latitude(text, place):
    """As GeoJSON has them (RFC 7946, 3.1.1)."""
    assert _origin(text) == place


@pytest.mark.parametrize("text", ["47", "1,2,3", "a,b", "181,0", "0,90", "0,-90", "nan,0", "0,nan"])
def test_an_origin_that_is_no_place_is_refused(text):
    """Poles have no longitude; what is no number is nowhere."""
    with pytest.raises(InputError, match="--origin"):
        _origin(text)


def test_modes_are_those_asked_for_or_those_of_the_method(folder):
    """The study keeps modes to 30 Hz; 12 Hz are asked for; without a study 30 Hz are taken."""
    study = study_from_text(GOOD)
    asked = modes_to(study.floor, "12 Hz", silent, study)
    kept = modes_to(study.floor, "", silent, study)
    assert asked.frequencies.max() < 12.0 < kept.frequencies.max() < 30.0
    assert len(kept.frequencies) == len(study.floor.modes(30.0).frequencies)
    assert len(modes_to(study.floor, "", silent, None).frequencies) == len(kept.frequencies)
    for text in ("12", "12 kg", "fast"):
        with pytest.raises(InputError, match=f"--f-max '{text}': "):
            modes_to(study.floor, text, silent, study)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("export", "s.toml", "x.xyz"), "x.xyz: of no format that is written"),
        (("export", "s.toml", "nowhere/x.vtu"), "nowhere/x.vtu: cannot be written"),
        (("export", "s.toml", "x.geojson"), "needs results of a study"),
        (("export", "beam.bdf", "x.pvd", "--units", "N, m"), "a model alone has no crossing"),
        (("export", "s.toml", "x.pvd", "--case", "nobody"), "no case 'nobody'; there are: main"),
        (("export", "s.toml", "x.pvd", "--road", "Z"), "'Z'"),
        (("export", "s.toml", "x.vtu", "--f-max", "0 Hz"), "greater than 0"),
        (("export", "s.toml", "x.vtu", "--kind", "dwg"), "dwg"),
        (("view", "s.toml", "--no-crossing", "--out", "nowhere/v.html"), "there is no folder"),
        (
            ("view", "s.toml", "--no-crossing", "--out", "empty"),
            "--out 'empty': must end with .htm",
        ),
        (("view", "s.toml", "--no-crossing", "--out", "."), "--out '.': must end with .htm"),
        (("view", "s.toml", "--no-crossing", "--out", ""), "must end with .htm or .html"),
        (("view", "beam.bdf", "--units", "N, m", "--out", "beam.bdf"), "must end with .htm"),
        (("view", "s.toml", "--no-crossing", "--out", "v" * 250 + ".html"), "name too long"),
        (("view", "b" * 300 + ".bdf"), "name too long"),
        (("model", "b" * 300 + ".bdf"), "name too long"),
        (("transfer", "s.toml", "--from", "tool", "--out", "c" * 250 + ".csv"), "name too long"),
        (("view", "s.toml", "--case", "nobody"), "no case 'nobody'"),
        (("view", "empty"), "holds no results"),
        (("model", "notes.txt"), "of no format that is known"),
    ],
)
def test_mistakes_of_export_and_view_leave_nothing_behind(
    folder, monkeypatch, capsys, arguments, told
):
    """Exit code 2 with the reason, no traceback, and no file that was not there."""
    before = sorted(folder.rglob("*"))
    code, said = run_main(monkeypatch, capsys, *arguments)
    assert code == 2
    assert told in said.err
    assert "Traceback" not in said.err
    assert sorted(folder.rglob("*")) == before


def test_a_view_says_where_it_is_and_names_are_no_html(folder, monkeypatch, capsys):
    """The page is named after the study; a title that ends a script stays a title."""
    title = "</script><script>alert(1)</script>"
    (folder / "größe.toml").write_text(GOOD.replace('"Small"', f'"{title}"'), encoding="utf-8")
    code, said = run_main(monkeypatch, capsys, "view", "größe.toml", "--no-crossing")
    assert code == 0
    page = folder / "größe-view.html"
    assert said.out == (
        f"größe-view.html: open it in a browser ({page.stat().st_size / 1e6:.1f} MB)\n"
    )
    assert "<script>alert(1)" not in page.read_text("utf-8")


def test_what_nothing_holds_is_looked_at_without_modes(folder, monkeypatch, capsys):
    """A beam without supports falls: its mesh is shown, and that there are no modes is told."""
    (folder / "loose.bdf").write_text(
        "\n".join(line for line in DECK.splitlines() if not line.startswith("SPC1"))
    )
    code, said = run_main(monkeypatch, capsys, "view", "loose.bdf", "--units", "N, m")
    assert code == 0
    assert "warning: no modes: " in said.out
    assert (folder / "loose-view.html").stat().st_size > 1000
    (folder / "loose-view.html").unlink()
    view_command.view(
        Path("loose.bdf"), Path("q.html"), wanted=Wanted(units="N, m"), crossing=True, quiet=True
    )
    assert capsys.readouterr().out == ""
    assert (folder / "q.html").stat().st_size > 1000


def test_a_model_as_json_is_one_document(folder, monkeypatch, capsys):
    """For programs: nothing but JSON on the output."""
    code, said = run_main(monkeypatch, capsys, "model", "beam.bdf", "--units", "N, m", "--json")
    assert code == 0
    assert isinstance(json.loads(said.out), dict)
