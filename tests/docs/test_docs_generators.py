"""What makes the pages of the manual: each by what it must say, and by what it must refuse."""

import re
import shutil
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Annotated, Literal

import pytest
from pydantic import AfterValidator

pytest.importorskip("sphinx")

import api_pages
import case_pages
import command_pages
import diagrams
import gallery
import key_words
import library_pages
import mathml
import pages
import references
import study_keys

from trundle.criteria import find_criterion
from trundle.errors import InputError
from trundle.study_file.fields import Length, PositiveLength, Section
from trundle.study_file.read import read_text
from trundle.study_file.sections import KINDS
from trundle.study_file.sections.method import MethodSection
from trundle.study_file.sections.road import RoadSection, RoughnessSection

ROOT = Path(__file__).parents[2]
KIND = {kind.name: kind for kind in KINDS}


def taken(model, name):
    return key_words.taken_by(model.model_fields[name])


class Pair(Section):
    """Fields of kinds that no section has side by side."""

    both: tuple[Length, PositiveLength] = (1.0, 2.0)
    some: tuple[Annotated[int, AfterValidator(lambda value: value)], ...] = ()
    either: Literal["a", "b"] | None = None


# --- study keys ---------------------------------------------------------------------------------


def sections():
    for kind in KINDS:
        for model in [
            *study_keys.members_of(kind),
            *(one for _, one in study_keys.tables_of(kind)),
        ]:
            yield pytest.param(model, id=f"{kind.name}-{model.__name__}")


@pytest.mark.parametrize("model", list(sections()))
def test_every_key_says_what_it_means(model):
    for name, info in model.model_fields.items():
        assert re.fullmatch(r"[A-Z0-9].*\.", info.description or ""), f"{model.__name__}.{name}"
    assert model.__doc__


def test_a_field_says_kind_unit_bounds_and_default():
    step = taken(MethodSection, "dt")
    assert (step.kind, step.rules) == ('time, such as `"25 ms"`', ("> 0",))
    assert key_words.default_of(MethodSection.model_fields["dt"]) == "needed"
    assert taken(RoadSection, "class_").rules == (", ".join(f'`"{c}"`' for c in "ABCDEFGH"),)
    assert taken(RoadSection, "waviness").rules == (">= 1", "<= 4")
    assert key_words.default_of(RoughnessSection.model_fields["n_min"]) == '`"0.011 1/m"`'
    assert key_words.default_of(RoughnessSection.model_fields["n_max_follows_dt"]) == "`true`"
    assert key_words.default_of(MethodSection.model_fields["entry"]) == '`"drive_in"`'
    assert taken(MethodSection, "damping").inner[0][1].__name__ == "DampingSection"


def test_lists_pairs_and_choices_are_told_apart():
    assert taken(Pair, "both").kind == 'list of 2: length, such as `["1 m", "1 m"]`'
    assert key_words.default_of(Pair.model_fields["both"]) == '`["1 m", "2 m"]`'
    assert taken(Pair, "either").rules == ('`"a"`, `"b"`',)


def test_what_reads_a_field_in_a_way_that_is_not_known_is_refused():
    with pytest.raises(KeyError):
        taken(Pair, "some")


def test_tables_within_tables_are_written_as_the_file_has_them():
    found = {where for where, _ in study_keys.tables_of(KIND["building"])}
    assert {"[building.materials.NAME]", "[[building.slab]]", "[building.column.base]"} <= found
    assert {where for where, _ in study_keys.tables_of(KIND["method"])} == {"[method.damping]"}


def test_what_all_kinds_share_is_told_once():
    assert "payload" in study_keys.shared_by(KIND["vehicle"])
    assert "at" in study_keys.shared_by(KIND["feature"])
    assert study_keys.shared_by(KIND["building"]) == []


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_every_section_has_an_example_that_is_accepted(kind):
    example = study_keys.example_of(kind.name)
    assert example.startswith((f"[{kind.name}", f"[[{kind.name}]]"))
    _, problems = read_text(example, "example")
    assert not [one for one in problems if one.place.split(".")[0].split("[")[0] == kind.name]


def test_an_example_ends_where_the_next_section_begins():
    text = '[[road]]\nclass = "A"\n# of the next\n[[road]]\nclass = "B"\n[road_works]\na = 1\n'
    found = list(study_keys._blocks(text, "road"))
    assert found == ['[[road]]\nclass = "A"', '[[road]]\nclass = "B"']
    text = "[vehicle.a]\nkind = 1\n[vehicle.a.payload]\nmass = 2\n[vehicle.b]\nkind = 3\n"
    assert len(list(study_keys._blocks(text, "vehicle"))) == 2


# --- commands -----------------------------------------------------------------------------------


def test_every_command_has_an_example_and_says_what_it_does():
    found = dict(command_pages.commands())
    assert {"run", "assess", "vehicles", "vehicles show"} <= set(found)
    for name, command in found.items():
        assert command_pages.examples_of(name), name
        assert command.help, name
    assert not [one for one in command_pages.examples_of("vehicles") if " show" in one]


def test_an_option_says_what_it_takes_and_its_default():
    text = command_pages._page("assess", dict(command_pages.commands())["assess"])
    assert "| `--high-pass` | `TEXT` | `0.5 Hz` | Motion below this frequency is drift. |" in text
    assert "| `--criteria`, `-c` | `TEXT` | workshop to VC-E |" in text
    assert "| `--quiet`, `-q` |   |   |" in text
    assert "`RECORD...`" in text


def test_exit_codes_are_those_of_the_commands():
    assert [code for code, _ in command_pages._CODES] == [0, 1, 2, 3, 130]


# --- public names -------------------------------------------------------------------------------


def test_a_name_is_described_where_it_is_made():
    from trundle.simulate import Rayleigh
    from trundle.structure import Hat

    assert api_pages.home_of("Rayleigh", Rayleigh) == "trundle.dynamics"
    assert api_pages.home_of("Hat", Hat) == "trundle.structure.elements"


def test_aliases_and_constants_have_the_words_below_them():
    from trundle import criteria, units

    assert api_pages.alias_words("KMH", units.KMH).startswith("One kilometre per hour")
    assert api_pages.alias_words("Shape", criteria.Shape).startswith("What generic curves do")


def test_kinds_of_names_are_told_apart():
    from trundle import criteria, units

    assert api_pages._directive("a.b", InputError)[0] == ".. autoexception:: a.b"
    assert api_pages._directive("a.b", criteria.Criterion)[0] == ".. autoclass:: a.b"
    assert api_pages._directive("a.b", criteria.assess)[0] == ".. autofunction:: a.b"
    constant = api_pages._directive("trundle.units.KMH", units.KMH)
    assert constant[:2] == [".. py:data:: trundle.units.KMH", f"   :value: {units.KMH!r}"]
    assert constant[3].startswith("   One kilometre per hour")
    assert ".. py:type:: trundle.criteria.Shape" in api_pages._directive(
        "trundle.criteria.Shape", criteria.Shape
    )


# --- criteria, vehicles, cases ------------------------------------------------------------------


def test_limits_are_told_in_engineers_units():
    assert library_pages._limits(find_criterion("VC-C")) == "12.5 um/s, 1 to 80 Hz"
    assert library_pages._limits(find_criterion("VC-A")).startswith("um/s: 100 at 4 Hz, 50 at 8 Hz")


def test_wheels_of_both_sides_are_one_axle():
    from trundle.vehicle import describe

    wide = describe("container_truck_40ft").widened(2.0).build()
    axles, loads = library_pages._axles(wide)
    assert len(axles) == 3
    assert sum(loads) == pytest.approx(wide.total_mass / 1e3)


def test_every_comparison_of_the_validation_page_is_read():
    text = (ROOT / "docs" / "validation.md").read_text("utf-8")
    rows = list(case_pages.rows_of(text))
    lines = re.findall(r"^\| .+ \| .+ \| .+ \| .* \| .+ \| .+ \| .+ \|$", text, re.MULTILINE)
    heads = sum(line.startswith("| quantity |") for line in lines)
    assert len(rows) == len(lines) - heads > 800
    assert {row.unit for row in rows} >= {"", "Hz", "um/s"}


def test_a_publication_is_shown_with_what_computes_it_again():
    row = case_pages.Row(
        case="V9 OpenSees", quantity="mode 1", expected="3.67", computed="3.68", unit="Hz",
        error="+0.1 %", tolerance="2 %", source="OpenSeesPy 3.7",
    )  # fmt: skip
    text = "\n".join(case_pages._one("A program", [row]))
    assert 'make validate ONLY="V9 and OpenSees"' in text
    assert "| mode 1 | 3.67 | 3.68 | Hz | +0.1 % | 2 % |" in text


def test_what_takes_most_of_its_tolerance_is_furthest():
    """A tenth of 1 % and half of 0.2 Hz, whatever their units; bars stay in their cell."""
    rows = [
        case_pages.Row(
            case="V1", quantity=name, expected="1", computed="1", unit="", source="",
            error=error, tolerance=tolerance,
        )
        for name, error, tolerance in (("a", "+0.1 %", "1 %"), ("|b|", "-0.1", "0.2"))
    ]  # fmt: skip
    assert case_pages._furthest(rows) == "\\|b\\|: -0.1 of 0.2"


def test_what_a_case_is_asked_for_by_selects_its_tests():
    text = (ROOT / "docs" / "validation.md").read_text("utf-8")
    for case, part in case_pages._SECTION.findall(text):
        file = re.search(r"^From `(tests/validation/\S+)`", part, re.MULTILINE)
        if file and any(row.case == case for row in case_pages.rows_of(text)):
            words = case_pages._asked(case).strip('"').lower().split(" and ")
            rows = [row for row in case_pages.rows_of(text) if row.case == case]
            marks = tuple(mark for mark, _ in case_pages._PUBLISHED)
            if any(row.source.startswith(marks) for row in rows):
                assert all(word in file[1] for word in words), case


# --- gallery and diagrams -----------------------------------------------------------------------


def test_the_comment_above_a_study_is_what_it_shows():
    text = "# A truck on a floor.\n#   trundle run study.toml\n# It turns.\n\n# later\ntitle = 1\n"
    assert gallery._said_above(text) == "A truck on a floor. It turns."


def test_a_picture_is_drawn_anew_when_its_example_changes(tmp_path):
    shutil.copytree(ROOT / "examples" / "from_python", tmp_path / "one")
    before = gallery._content(tmp_path / "one")
    assert before == gallery._content(ROOT / "examples" / "from_python")
    with (tmp_path / "one" / "study.toml").open("a", encoding="utf-8") as file:
        file.write("# changed\n")
    assert gallery._content(tmp_path / "one") != before


def test_a_plan_is_drawn_without_running_the_study(tmp_path):
    from trundle.study_file.build import load_study

    gallery._draw(load_study(ROOT / "examples" / "from_python" / "study.toml"), tmp_path / "a.svg")
    text = (tmp_path / "a.svg").read_text("utf-8")
    assert "km/h" in text
    assert "tool" in text


def test_every_folder_of_examples_has_an_entry():
    for folder in gallery.examples():
        assert folder.name in gallery._WITHOUT_STUDY or (folder / "study.toml").exists()


def test_the_chain_leads_from_road_to_verdict():
    words = [
        one.text for one in ET.fromstring(diagrams.chain()).iter() if one.tag.endswith("}text")
    ]
    names = ["Road", "Vehicle", "Floor", "Levels", "Verdict"]
    assert [word for word in words if word in names] == names


def test_the_layers_are_those_of_the_contract():
    drawn = ET.fromstring(diagrams.stack(diagrams.layers()))
    words = {one.text for one in drawn.iter() if one.tag.endswith("}text")}
    packages = {path.parent.name for path in (ROOT / "src" / "trundle").glob("*/__init__.py")}
    assert packages <= words
    assert not any(word.startswith("_") for word in words)


# --- formulas, tables, lists ---------------------------------------------------------------------


def test_formulas_are_drawn_by_the_browser():
    text = mathml.as_mathml(r"\ddot{u} + \omega^2 u = \frac{F}{m}", block=True)
    assert "<mfrac" in text
    assert 'display="block"' in text


def test_lines_of_a_formula_are_a_table():
    for formula in (r"a &= b \\ c &= d", r"\begin{align*}a &= b \\ c &= d\end{align*}"):
        assert mathml.as_mathml(formula, block=True).count("<mtr>") == 2


def test_sizes_of_brackets_are_the_browsers():
    assert mathml.as_mathml(r"\Big[ a \bigr)", block=False).count("<mo") == 2


def test_a_fraction_without_braces_has_two_numbers():
    text = "".join(mathml.as_mathml(r"\tfrac12 G", block=False).split())
    assert "<mn>1</mn><mn>2</mn></mfrac>" in text


def test_an_accented_letter_has_its_index_beside_it():
    """A sum keeps what stands below and above it."""
    text = "".join(mathml.as_mathml(r"\sum_i^n \dot y_j", block=True).split())
    assert '<msub><moveraccent="true"><mi>y</mi>' in text
    assert "</mover><mi>j</mi></msub>" in text
    assert text.count("<munderover") == 1


def test_single_limits_have_no_range_that_never_ends():
    """0.3 gal hold at any frequency; those of a stepper from 1 to 100 Hz."""
    limits = [library_pages._limits(find_criterion(name)) for name in ("0.3 gal", "stepper-B")]
    assert limits == ["0.3 gal", "0.1 gal, 1 to 100 Hz"]


def test_a_star_is_escaped_in_words_and_kept_in_code():
    assert (
        api_pages._plain("Write ``figures/*.png``, of *x*.") == r"Write `figures/*.png`, of \*x\*."
    )


def test_an_option_in_a_sentence_is_no_dash():
    """Two strokes would be set as one dash."""
    page = command_pages._page("assess", dict(command_pages.commands())["assess"])
    assert "else `--unit` and `--rate` do" in page


def test_a_formula_that_is_not_understood_is_refused():
    with pytest.raises(Exception, match="nosuch"):
        mathml.as_mathml(r"\nosuch{x}", block=False)


def test_bars_and_lines_do_not_break_a_table():
    text = pages.table(("a",), [(pages.code("x|y"),), ("two\nlines",), ("",)])
    assert [line.count("|") - line.count("\\|") for line in text.split("\n") if line] == [2] * 5


def test_a_page_that_has_not_changed_keeps_its_time(tmp_path):
    path = tmp_path / "deep" / "page.md"
    pages.write_page(path, "one")
    before = path.stat().st_mtime_ns
    pages.write_page(path, "one")
    assert path.stat().st_mtime_ns == before
    pages.write_page(path, "two")
    assert path.read_text("utf-8") == "two"


def test_a_list_of_pages_is_of_those_that_there_are(tmp_path):
    listed = "```{toctree}\n:glob:\n\ntheory/*\n```\n"
    assert references.fitted(listed, tmp_path) == ""
    (tmp_path / "theory").mkdir()
    (tmp_path / "theory" / "beams.md").write_text("# Beams\n")
    assert references.fitted(listed, tmp_path) == listed
    (tmp_path / "theory" / "index.md").write_text("# All\n\n```{toctree}\nbeams\n```\n")
    assert "theory/index\n" in references.fitted(listed, tmp_path)
