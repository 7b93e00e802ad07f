"""The page of a study: verdicts under the right heading, reasons, units, and names that are text."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from hand_made import BANDS, Page, class_map_of, result_of, study_of

from trundle.criteria import find_criterion
from trundle.errors import FitnessWarning
from trundle.report.canvas import Drawing
from trundle.report.pages.study import _numbered, _render, unused_numbers
from trundle.results.maps import MapKey, StudyMap
from trundle.results.mesh_change import MeshChange
from trundle.results.modes import FirstModes
from trundle.road import class_limits
from trundle.simulate import Coverage, TruncationChange
from trundle.structure import self_weight_deflection
from trundle.study.plans import Printed
from trundle.views import map as views_map
from trundle.views.map import map_payload

CURVES = ('curves = ["VC-A"]', 'curves = ["VC-A", "VC-B", "stepper-B"]')
TWO_ROADS = '\n[[road]]\nclass = "C"\n'
TWO_POINTS = '\n[[point]]\nname = "stage"\nat = ["8 m", "4 m"]\n'
MAP = '\n[map]\nspacing = "3 m"\ncriterion = "VC-A"\n'
NOTES = "where and when; what else is known"
TITLE = 'Halle <1> & "Süd" </script>'
ROUTE = "<i>main & rear"
POINT = "Gerät, <b>1 & 2"
NAMES = (
    ('title = "Small"', f"title = '{TITLE}'"),
    ('name = "main"', f'name = "{ROUTE}"'),
    ('name = "tool"', f'name = "{POINT}"'),
)


def page_of(result):
    return Page(_render(result, []))


@pytest.fixture(scope="module")
def louder():
    """Flat spectra of 10 um/s, twice that in the band of 16 Hz; the second road six times that."""
    study = study_of(TWO_ROADS, CURVES)
    level = np.where(np.isclose(BANDS, 10**1.2), 20e-6, 10e-6)[None]
    return result_of(study, lambda key: level * (6.0 if key.road == "C" else 1.0))


def test_the_line_of_a_cell_has_what_is_met_and_what_is_not(louder):
    """By hand: 95 % of the factors 0.5, 1, 4 is 3.7; 3.7 x 20 = 74 um/s at 16 Hz.

    VC-A (50 um/s there) has the margin 50 / 74 = 0.676 and one run of three, of 80 um/s, above it;
    VC-B fails too, and it is the wider of both that is named.
    """
    page = page_of(louder)
    first, second = page.rows("verdict")
    assert (first["vehicle on"], first["road class"], first["point"]) == ("main", "B", "tool")
    assert first["strictest velocity criterion met"] == "none"
    assert first["first not met"] == "VC-A"
    assert first["governing band [Hz]"] == "16"
    assert first["runs above it"] == "33 %"
    assert first["margin"] == ""  # of a criterion that is met: none is
    row = page.tables["verdict"][0][1]
    assert row[6].startswith("0.676")
    # six times louder: 60, 120 and 480 um/s, and 50 / (6 x 74)
    assert second["road class"] == "C"
    assert second["runs above it"] == "100 %"
    assert page.tables["verdict"][0][2][6].startswith("0.113")


def test_a_pass_that_more_runs_might_fail_says_so():
    """Flat 10 um/s: 37 um/s of 95 % pass VC-A by 50 / 37, and fail VC-B by 25 / 37.

    Two of three runs lie above the 95 % level with a chance of 0.7 %, so that the middle run, of 10
    um/s, bounds the margin: 50 / 10. The largest lies above it by 14 %: no bound below.
    """
    page = page_of(result_of(study_of("", CURVES), 1e-5))
    (line,) = page.rows("verdict")
    assert line["strictest velocity criterion met"] == "VC-A (not surely)"
    assert line["margin"] == "1.35 (at most 5)"
    assert line["first not met"] == "VC-B"
    (every,) = page.rows("verdict", 1)
    assert every["VC-A"] == "✓ pass?1.35 (at most 5)"
    assert every["VC-B"].startswith("✗ fail0.676")


def test_a_road_that_still_passes_is_the_square_of_the_margin():
    """Mean of class B, 64e-6 m3, times (50 / 37)^2 is 116.9e-6: more than class A's upper 32e-6."""
    (line,) = page_of(result_of(study_of("", CURVES), 1e-5)).rows("verdict")
    assert "what is met holds on a road of at least 117e-6 m3 (all of class A)" in line[NOTES]


def test_what_is_not_computed_is_never_passed():
    """Bands to 31.5 Hz alone, very quiet: no pass anywhere, the bands missing and the way out."""
    page = page_of(result_of(study_of("", CURVES), 1e-9, shown_to=35.0))
    line, why = page.tables["verdict"][0][1:]
    assert line[3] == "not assessed"
    assert why[2].startswith("Not assessed: ")
    assert "40" in why[2]
    assert "31.5" not in why[2]
    (every,) = page.rows("verdict", 1)
    assert not any("pass" in cell for cell in every.values())
    assert every["VC-A"].startswith("not assessed")
    assert "pass" not in {
        name for row in page.classes["verdict"][0] for name in " ".join(row).split()
    }
    assert "✓" not in page.said("verdict")


def test_a_fail_stands_even_where_bands_are_missing():
    """Above the limit in a band that is known: it fails, and what is unknown keeps no fail back."""
    page = page_of(result_of(study_of("", CURVES), 1e-3, shown_to=35.0))
    (every,) = page.rows("verdict", 1)
    assert every["VC-A"].startswith("✗ fail0.0135")  # 50 / 3700
    assert page.rows("verdict")[0]["first not met"] == "VC-A"


def test_a_wheel_still_on_the_floor_keeps_everything_from_passing():
    """The record ends at 4 s, the last wheel at 9 s: both times are told, and nothing is passed."""
    coverage = Coverage(leaves=9.0, ends=4.0)
    page = page_of(result_of(study_of("", CURVES), 1e-9, coverage=coverage))
    assert "✓" not in page.said("verdict")
    assert "the record ends at 4 s" in page.said("verdict")
    assert "9 s" in page.tables["verdict"][0][2][2]


def test_an_empty_field_of_the_lights_is_explained_where_there_is_one():
    """In print, too, where no pointer shows what a field is."""
    words = "empty, a criterion for another direction of motion"
    level = "electron-microscope-horizontal"
    both = study_of("", ('curves = ["VC-A"]', f'curves = ["VC-A", "{level}"]'))
    assert words in _render(result_of(both), [])
    assert words not in _render(result_of(study_of()), [])


def test_every_verdict_stands_in_its_own_column():
    """Two roads and two points, each 2.5 times the last: by hand 50 / 3.7 over 4, 10, 25, 62.5."""
    study = study_of(TWO_ROADS + TWO_POINTS, CURVES)
    names = list(study.points)
    level = {("B", 0): 4e-6, ("B", 1): 10e-6, ("C", 0): 25e-6, ("C", 1): 62.5e-6}
    result = result_of(study, lambda key: [level[key.road, i] for i in range(2)])
    page = page_of(result)
    head, *rows = page.tables["verdict"][1]
    assert head == ["vehicle on, road, point", "VC-A", "VC-B", "Stepper, maker B"]
    assert [row[0] for row in rows] == [
        "main, B, tool",
        "main, B, stage",
        "main, C, tool",
        "main, C, stage",
    ]
    margins = [float(re.search(r"[\d.]+", row[1]).group()) for row in rows]
    expected = [50.0 / (3.7 * 1e6 * level[key]) for key in (("B", 0), ("B", 1), ("C", 0), ("C", 1))]
    np.testing.assert_allclose(margins, expected, rtol=2e-3)
    assert ["pass" in row[1] for row in rows] == [True, True, False, False]
    where = [(row["road class"], row["point"]) for row in page.rows("verdict")]
    assert where == [("B", names[0]), ("B", names[1]), ("C", names[0]), ("C", names[1])]


def test_numbers_of_cells_are_in_the_units_of_their_headings(louder):
    """Percentiles of 0.5, 1, 4 by hand: 0.55, 1, 3.7; 0.2 gal and 20 / 3 um/s at the median."""
    page = page_of(louder)
    assert page.tables["results"][0][0][4:] == [
        "peak acceleration [gal], median (5–95 %)",
        "record RMS velocity [um/s], median (5–95 %)",
    ]
    first, second = page.tables["results"][0][1:]
    assert first == ["main", "B", "coupled", "tool", "0.2 (0.11–0.74)", "6.67 (3.67–24.7)"]
    assert second[4] == "1.2 (0.66–4.44)"


def test_names_are_text_wherever_they_stand():
    """Tags in title, route and point: the page has none of them, and shows each as it is given."""
    study = study_of(MAP, *NAMES, CURVES)
    note = study_of('\n[[note]]\ntitle = "<h1>x"\ntext = "a < b & c"\n').notes
    study = replace(study, notes=note, publications=("<cite>Müller",))
    result = result_of(study, 1e-5)
    result = replace(result, maps=_maps(study, {"VC-A": 2.0, "VC-B": 1.0, "stepper-B": 3.0}))
    warned = FitnessWarning(subject="<u>who", message="say <s>what & why")
    cells = {key: replace(cell, warnings=(warned,)) for key, cell in result.cells.items()}
    page = page_of(replace(result, cells=cells))
    assert {"b", "i", "u", "s", "cite"}.isdisjoint(page.tags)
    assert page.tags.count("h1") == 1
    assert page.headings[0] == TITLE
    (line,) = page.rows("verdict")
    assert (line["vehicle on"], line["point"]) == (ROUTE, POINT)
    assert page.tables["verdict"][1][1][0] == f"{ROUTE}, B"
    assert page.tables["results"][0][1][:4] == [ROUTE, "B", "coupled", POINT]
    assert "<u>who: say <s>what & why" in page.said("limits")
    assert "<h1>xa < b & c" in page.said("notes")
    assert "<cite>Müller" in page.said("methods")
    assert f"title = '{TITLE}'" in page.said("inputs")  # the study file as it is


@pytest.mark.parametrize("more", ["", TWO_ROADS + MAP])
def test_contents_lead_to_what_is_there(more):
    """Each link is a section's, each section that is a verdict or a table has one, and no two ids."""
    study = study_of(more, CURVES)
    result = result_of(study, 1e-5)
    if study.map is not None:
        result = replace(result, maps=_maps(study, {"VC-A": 2.0, "VC-B": 1.0, "stepper-B": 3.0}))
    page = page_of(result)
    assert len(page.ids) == len(set(page.ids))
    links = {link.removeprefix("#") for link in page.links}
    assert links <= set(page.ids)
    assert ("map" in links) == (study.map is not None)
    assert {"verdict", "results", "figures", "limits", "inputs", "numbers"} <= links


def test_without_criteria_there_is_no_verdict():
    """Nothing was asked for: no section, no link to one, and no word of a pass."""
    study = replace(study_of(), assessment=None)
    page = page_of(result_of(study))
    assert "verdict" not in page.ids
    assert "#verdict" not in page.links
    assert "pass" not in page.said("results")
    assert page.tables["results"][0][1][0] == "main"


def _maps(study, margins, **more):
    classes = class_map_of(study.map.grids, margins, **more)
    n = study.map.n_places
    names = ("rms_velocity", "peak_acceleration", "response_factor", "vdv")
    numbers = {name: np.full(n, np.nan) for name in names}
    numbers["rms_velocity"] = np.linspace(1e-6, 2e-6, n)
    return {
        MapKey(case.name, road): StudyMap(
            classes=classes, numbers=numbers, band_levels=np.zeros((n, len(BANDS)))
        )
        for case in study.cases
        for road in study.roads
    }


def test_data_of_the_map_are_what_the_script_reads():
    """JSON between its tags, whatever names hold: ranks, margins, bands by name and shares."""
    study = study_of(MAP, *NAMES, CURVES)
    n = study.map.n_places
    margin = np.linspace(0.5, 2.0, n)
    margin[3] = np.nan
    result = result_of(study, 1e-5)
    result = replace(result, maps=_maps(study, {"VC-A": margin, "VC-B": 0.5 * margin}))
    text = _render(result, [])
    found = re.search(r'id="map-data">(.*?)</script>', text, re.DOTALL).group(1)
    assert "<" not in found
    data = json.loads(found)
    (view,) = data["views"]
    assert view["title"] == f"{ROUTE}, class B"
    assert data["names"] == ["not assessed", "none", "VC-A", "VC-B"]
    assert len(data["colours"]) == len(data["names"])
    ranks = np.array(view["ranks"], float)
    assert ranks.shape == (len(view["y"]), len(view["x"]))
    expected = np.where(margin >= 2.0, 3, np.where(margin >= 1.0, 2, 1)).astype(float)
    expected[3] = 0
    np.testing.assert_array_equal(ranks.ravel(), expected)
    shown, band, share = (np.array(r, float).ravel() for r in view["readings"][:3])
    np.testing.assert_allclose(shown, margin, rtol=5e-3)
    assert np.isnan(shown[3])
    assert set(band[~np.isnan(band)]) == {10.0}
    assert set(share[~np.isnan(share)]) == {25.0}
    assert [level[1] for level in data["levels"]] == ["um/s", "gal", "1", "m/s^1.75"]
    np.testing.assert_allclose(np.ravel(view["readings"][3]), np.linspace(1.0, 2.0, n), rtol=5e-3)
    assert data["points"] == [{"name": POINT, "x": 3.0, "y": 3.0}]
    assert view["points"] == [POINT]
    assert view["routes"] == [ROUTE]
    assert "option" not in Page(text).tags  # nothing to choose


def test_the_worst_place_of_a_map_stands_in_the_line():
    """The smallest margin to the criterion of the line, where it is in plan: row by row, x first."""
    study = study_of(MAP, CURVES)
    margin = np.full(study.map.n_places, 2.0)
    margin[5] = 0.25
    result = result_of(study, 1e-3)  # fails everything: VC-A is the first not met
    result = replace(result, maps=_maps(study, {"VC-A": margin, "VC-B": 3.0}))
    (line,) = page_of(result).rows("verdict")
    assert (
        "smallest margin on the map 0.25 at (4.5, 4.5) m" in line[NOTES]
    )  # second of four in the second row


def test_fields_of_the_map_say_on_which_side_of_a_limit_a_place_is():
    """100 log10 of the margin, rounded down: 0 at the limit itself, -1 just below, 30 at twice it."""
    study = study_of(MAP, CURVES)
    margin = np.full(study.map.n_places, 2.0)
    margin[:3] = 1.0, 0.9999, np.nan
    result = result_of(study, 1e-5)
    result = replace(result, maps=_maps(study, {"VC-A": margin, "VC-B": 0.5}, complete=True))
    (view,) = map_payload(result)["views"]
    widest, strictest = (np.ravel(np.array(rows, float)) for rows in view["fields"])
    np.testing.assert_array_equal(widest[:4], [0.0, -1.0, np.nan, 30.0])
    assert set(strictest) == {-31.0}  # 100 log10(0.5) = -30.1
    assert view["complete"] == [True, True]
    least = int(np.nanargmin(margin))
    x, y = study.map.grids[0].xy[least]
    assert view["worst"] == {"x": x, "y": y, "margin": 1.0}


def test_a_page_carries_as_many_maps_as_it_can_and_the_worst_of_them(monkeypatch):
    study = study_of(TWO_ROADS + MAP, CURVES)
    result = replace(result_of(study), maps=_maps(study, {"VC-A": 2.0, "VC-B": 0.5}))
    every = [view["title"] for view in map_payload(result)["views"]]
    assert len(every) == 3  # two roads, and the worst
    monkeypatch.setattr(views_map, "_MOST_READINGS", 1)
    assert [view["title"] for view in map_payload(result)["views"]] == every[-1:]


def test_classes_have_the_limits_of_the_standard(louder):
    """ISO 8608: Gd(n0) of class A has the mean 16e-6 m3, each next four times that; limits twice."""
    rows = page_of(louder).tables["inputs"][1]
    assert rows[0] == ["class", "lower limit", "geometric mean", "upper limit"]
    for i, row in enumerate(rows[1:]):
        mean = 16 * 4**i
        assert row == ["ABCDEFGH"[i], f"{mean // 2}", f"{mean}", f"{2 * mean}"]
        np.testing.assert_allclose(class_limits(row[0]), 1e-6 * np.array(row[1:], float))


def test_published_values_fall_among_the_runs():
    """0.5, 1, 4 times 0.1 gal: 0.01 gal is below all, 1 gal above all, 0.2 gal at two of three."""
    study = study_of(TWO_ROADS, CURVES)
    printed = tuple(
        Printed(case="main", road=road, method="coupled", peak_acceleration=peak, rms_velocity=rms)
        for road, peak, rms in (("B", 1e-4, 12.345e-6), ("C", 2e-3, 1.0))
    )
    page = page_of(result_of(replace(study, printed=printed), 1e-5))
    first, second = page.tables["printed"][0][2:]
    assert first[:6] == ["main", "B", "coupled", "0.01", "0.1 (0.055–0.37)", "below all"]
    assert first[6:8] == ["12.345", "3.33 (1.83–12.3)"]
    assert first[8] not in {"below all", "above all"}  # 1.67, 3.33 and 13.3 um/s on both sides
    assert second[3] == "0.2"
    assert second[8] == "above all"


def test_what_modes_left_out_change_is_in_per_cent():
    """The largest of both points: 0.3 of a per cent of velocity, 12 % of acceleration."""
    study = study_of(TWO_POINTS)
    result = result_of(study)
    change = TruncationChange(
        f_max=15.0, velocity=np.array([0.001, 0.003]), acceleration=np.array([0.12, 0.04])
    )
    cells = {key: replace(cell, truncation=change) for key, cell in result.cells.items()}
    page = page_of(replace(result, cells=cells))
    assert page.rows("results", 1) == [
        {
            "vehicle on": "main", "method": "coupled", "modes to [Hz]": "30",
            "compared with [Hz]": "15", "velocity": "0.3 %", "acceleration": "12 %",
        }
    ]  # fmt: skip


def test_frequencies_and_number_of_modes_are_told():
    """24 of 40 frequencies are written, and how many there are."""
    study = study_of()
    frequencies = np.linspace(5.0, 44.0, 40)
    modes = FirstModes(frequencies=frequencies, vertical=np.zeros((len(study.floor.nodes), 8)))
    page = page_of(replace(result_of(study), modes=modes))
    told = dict(page.tables["inputs"][0])
    assert told["modes used"] == "40"
    assert told["first natural frequencies [Hz]"].split(", ") == [
        f"{f:.2f}" for f in np.arange(5.0, 29.0)
    ]


def test_the_mass_of_the_floor_is_in_tonnes():
    """By hand: slab and beams all move, 67.46 t; of the columns, 9.41 t, all but what is held."""
    told = dict(page_of(result_of(study_of())).tables["inputs"][0])
    slab = 12.0 * 6.0 * (0.2 * 2450.0 + 300.0)
    beams = 0.3 * 0.6 * 2450.0 * 2 * 12.0
    columns = 6 * 0.4 * 0.4 * 2450.0 * 4.0
    moving = 1e3 * float(told["mass moving vertically"].removesuffix(" t"))
    assert slab + beams + 0.5 * columns < moving < slab + beams + columns


def test_the_largest_deflection_is_in_millimetres():
    """Statics say metres below level: a thousand times as many millimetres, without a sign."""
    study = study_of()
    told = dict(page_of(result_of(study)).tables["inputs"][0])
    words = told["largest deflection under self-weight and superimposed mass"]
    assert float(words.removesuffix(" mm")) == pytest.approx(
        -1e3 * self_weight_deflection(study.floor).min(), rel=5e-3
    )


def test_a_mesh_that_has_not_settled_is_told_beside_the_verdict():
    """8 % of a band's level from one mesh to the other, with case, point and band."""
    study = study_of("", CURVES)
    fine = np.ones((1, 1, len(BANDS)))
    coarse = fine.copy()
    coarse[0, 0, 10] = 1.08
    change = MeshChange(
        sizes=(3.0, 1.5), frequencies=np.array([[5.1, 8.0], [5.0, 8.0]]), cases=("main",),
        points=("tool",), bands=BANDS, levels=np.stack([coarse, fine]),
    )  # fmt: skip
    said = page_of(replace(result_of(study), mesh=change)).said("verdict")
    assert "from elements of 3 m to 1.5 m" in said
    assert "change by up to 2 %" in said
    assert "8 % (main, tool, 10 Hz)" in said


def test_together_and_alone_are_set_side_by_side():
    """Two alike of 10 um/s: by energy sqrt(2) as loud, by sum twice; each governs with half."""
    text = (
        '\n[[route]]\nname = "back"\nvehicle = "truck"\npath = [["12 m", "3 m"], ["0 m", "3 m"]]\n'
    )
    text += 'speed = "15 km/h"\n\n[[traffic]]\nname = "both"\nroutes = ["main", "back"]\n'
    study = study_of(text)
    result = result_of(study, lambda key: 2e-5 if key.case == "both" else 1e-5)
    page = page_of(result)
    (row,) = page.rows("together")
    assert row["together"].startswith("fail 0.676")  # 50 / (3.7 x 20)
    assert row["by energy"] == f"{50.0 / (37.0 * np.sqrt(2.0)):.3g}"
    assert row["by sum"] == f"{50.0 / 74.0:.3g}"
    assert row["each alone"] == "main 1.35, back 1.35"
    assert "50 % of the energy" in row["governed by"]
    assert [line["vehicle on"] for line in page.rows("verdict")] == ["main", "back", "both"]


def test_captions_bear_their_numbers_and_names_that_are_nowhere_are_told():
    """A number stands in brackets behind its own caption; a slip in a name is returned."""
    one = Drawing(name="plan", title="t", caption="A plan.", draw=lambda: None)
    assert _numbered(one, {"plan": "Figure 8", "mesh": "Figure 9"}).caption == "A plan. (Figure 8)"
    assert _numbered(one, {"mesh": "Figure 9"}).caption == "A plan."
    numbering = {"plan": "1", "plann": "2", "classes": "3", "axle_forces": "4", "map_rms": "5"}
    result = result_of(replace(study_of(), numbering=numbering))
    assert unused_numbers(result) == ["plann", "map_rms"]  # there is no map


def test_the_table_of_classes_bears_its_number():
    """The number given to the classes stands in that heading, and in no other."""
    study = replace(study_of(), numbering={"classes": "Table <3>"})
    page = page_of(result_of(study))
    named = [heading for heading in page.headings if "Table <3>" in heading]
    assert len(named) == 1
    assert named[0].startswith("Displacement PSD")
    assert named[0].endswith("(Table <3>)")


def test_criteria_of_one_title_do_not_move_verdicts_to_other_columns():
    """Two curves titled alike: a column each, in which its own verdicts stand."""
    study = study_of('\n[[road]]\nclass = "C"\n')
    wide = replace(find_criterion("VC-A"), name="one", title="Microscope")
    strict = replace(find_criterion("VC-C"), name="two", title="Microscope")
    study = replace(study, assessment=replace(study.assessment, criteria=(wide, strict)))
    result = result_of(study, lambda key: 1e-6 if key.road == "B" else 1e-3)
    head, *rows = page_of(result).tables["verdict"][1]
    assert head == ["vehicle on, road", "Microscope", "Microscope"]
    quiet, loud = rows
    assert ["pass" in cell for cell in quiet[1:]] == [True, True]
    assert ["fail" in cell for cell in loud[1:]] == [True, True]


def test_why_a_limit_on_peaks_is_not_assessed_is_said():
    """Steps and modes end at 35 Hz, and so does what is known of a peak."""
    study = study_of("", ('curves = ["VC-A"]', 'curves = ["stepper-B"]'))
    page = page_of(result_of(study, 1e-9, shown_to=35.0))
    assert page.rows("verdict", 1)[0]["Stepper, maker B"].startswith("not assessed")
    assert "Not assessed: " in page.said("verdict")


def test_no_velocity_criterion_is_met_only_where_some_were_asked_for():
    """Peaks alone were asked for and pass: nothing has failed."""
    study = study_of("", ('curves = ["VC-A"]', 'curves = ["stepper-B"]'))
    (line,) = page_of(result_of(study, 1e-9)).rows("verdict")
    assert line["strictest velocity criterion met"] == "none asked for"
    assert line["first not met"] == "none asked for"


@pytest.mark.parametrize("name", ["printed", "printed_bound"])
def test_a_number_of_a_table_that_is_not_there_is_told(name):
    """Nothing is printed beside ours: there is no such table to bear the number."""
    study = replace(study_of(), numbering={name: "Table 3"})
    assert unused_numbers(result_of(study)) == [name]
