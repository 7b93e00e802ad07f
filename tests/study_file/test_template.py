"""The template of a new study: it is sound, and so is everything that it offers behind a #."""

import re
import tomllib
from importlib.resources import files

import numpy as np
import pytest

from trundle.road import RoadClass, RoughnessBand, synthesise
from trundle.study_file import study_from_text
from trundle.study_file.read import read_text
from trundle.study_file.sections import KINDS

TEXT = files("trundle.study_file").joinpath("template.toml").read_text("utf-8")
COARSE = TEXT.replace('mesh_size = "1 m"', 'mesh_size = "2.5 m"')


def offered(begin, end=None):
    """Return the template with some commented lines put into force."""
    start = COARSE.index(begin)
    stop = len(COARSE) if end is None else COARSE.index(end, start)
    block = re.sub(r"(?m)^# ?", "", COARSE[start:stop])
    return COARSE[:start] + block + COARSE[stop:]


def test_a_new_study_has_no_mistake_and_is_what_its_comments_say():
    """Two bays of 12 m by two of 10 m; 5 ms shows 80 Hz; modes to 1.25 times the last band."""
    study = study_from_text(COARSE)
    assert study.extent == ((0.0, 24.0), (0.0, 20.0))
    (method,) = study.methods
    integration = method.interaction.integration
    assert integration.f_max == pytest.approx(1.25 * 80 * 10**0.05, rel=5e-3)
    assert 1.0 / integration.dt >= 2.5 * 80.0
    # at 15 km/h the 80 Hz band ends at 80 2^(1/6) Hz: the road must reach that wave
    assert study.band.n_max * 15 / 3.6 >= 80 * 2 ** (1 / 6)
    assert study.map.criterion == "VC-B"
    assert study.map.runs == 50


def test_every_kind_of_section_that_is_required_is_in_it():
    """Whoever starts from it is asked for nothing more."""
    data = tomllib.loads(TEXT)
    assert {kind.name for kind in KINDS if kind.required} <= set(data)
    assert not read_text(TEXT, "template")[1]


def test_every_block_that_is_offered_is_put_into_force_here():
    """Lines behind a # that hold a key or a table; each run of them has its test below."""
    runs = re.findall(r"(?m)(?:^#.*\n)+", TEXT)
    first = (re.search(r"(?m)^# (?:(\w+) = |\[+([\w.]+)\]+$)", run) for run in runs)
    assert [found[1] or found[2] for found in first if found] == [
        "duration", "vehicle.van", "road", "point", "report", "shape", "speeds", "peaks",
    ]  # fmt: skip


def test_the_van_that_is_offered_bounces_and_hops_as_it_says():
    """1480 kg over 120 kg on springs: f2/f1 + f1/f2 is 2 sqrt(1 + 1480/120) = 7.3 at least.

    12 Hz over 1.6 Hz is 7.6; 11 Hz would be 7.0.
    """
    text = offered("# [vehicle.van]", "\n[[route]]").replace('= "truck"', '= "van"')
    van = study_from_text(text).drives["access road"].vehicle
    assert van.n_contacts == 2
    assert van.total_mass == pytest.approx(3500.0)


def test_the_front_of_a_report_is_as_it_says():
    """A date of TOML's own kind is written as it stands; units are those that reports usually have."""
    plan = study_from_text(offered("# [report]", "\n# --- what it is held")).report
    assert plan.heading == (
        ("Client", "Client Ltd"),
        ("Job", "2026-117"),
        ("Revision", "A"),
        ("Date", "2026-11-27"),
        ("Author", "A. N. Engineer"),
    )
    usual = study_from_text(COARSE).report
    units = ("acceleration", "velocity", "displacement", "load")
    assert [getattr(plan, name) for name in units] == [getattr(usual, name) for name in units]


def test_curves_of_ones_own_are_read_where_the_template_says(tmp_path):
    """A maker's table, flat curves below 8 Hz, and doses of 40 passages."""
    (tmp_path / "maker.csv").write_text(
        "# quantity = band_rms_velocity\nfrequency [Hz], limit [um/s]\n1, 50\n80, 50\n"
    )
    text = offered("# shape", "\n# --- the whole floor")
    text = text.replace("   # your own curves; events = 40", "\nevents = 40  # ")
    text = text.replace('"VC-E"]', '"VC-E", "maker"]')
    assessment = study_from_text(text, folder=tmp_path).assessment
    assert "maker" in {curve.name for curve in assessment.criteria}
    assert assessment.events == 40.0


def test_the_duration_that_is_offered_is_one():
    """20 s behind a #."""
    assert study_from_text(offered("# duration", "\n\n# ---")).duration == 20.0


def test_the_roads_and_joints_that_are_offered_lie_on_the_route(tmp_path):
    """A survey, 478 m at the start, a flatness, and joints at 6, 12 and 18 m with steps of 2 mm.

    The survey has a chainage of its own, in which there is no 6 m: joints are for the others, or
    for it at 484 m.
    """
    road = synthesise(
        RoadClass("B"), length=150.0, rng=np.random.default_rng(1),
        band=RoughnessBand(n_min=0.05, n_max=4.0),
    )  # fmt: skip
    rows = (
        f"{s + 408:.4f},{1e3 * z:.6f}" for s, z in zip(road.station, road.elevation, strict=True)
    )
    (tmp_path / "profile.csv").write_text("station [m],height [mm]\n" + "\n".join(rows) + "\n")
    text = offered("# [[road]]", "\n# --- where the response is read")
    study = study_from_text(text, folder=tmp_path)
    assert list(study.roads) == ["B", "surveyed", "FF 35"]
    for name in ("B", "FF 35"):
        assert [f.shape.step for f in study.roads[name].features] == [0.002] * 3
    assert [f.station for f in study.roads["B"].features] == [6.0, 12.0, 18.0]
    assert study.roads["surveyed"].start == 478.0
    both = ('roads = ["B", "FF 35"]', 'roads = ["surveyed"]'), ('at = "6 m"\n', 'at = "484 m"\n')
    for old, new in both:
        assert text.count(old) == 1
        text = text.replace(old, new)
    surveyed = study_from_text(text, folder=tmp_path).roads["surveyed"]
    assert [f.station - surveyed.start for f in surveyed.features] == [6.0, 12.0, 18.0]


def test_the_isolated_point_that_is_offered_stands_on_2_hz():
    """Beside the tool, at the same place."""
    text = offered("# [[point]]", "\n# --- how").replace("# or { table", "#or { table")
    study = study_from_text(re.sub(r"\s+# ?or \{ table.*|\s+#or \{ table.*", "", text))
    assert list(study.points) == ["tool", "stage"]
    isolator = study.isolations["stage"]
    assert np.abs(isolator.response(np.array([2.0 * np.sqrt(2.0)]))) == pytest.approx(1.0)


def test_what_a_map_may_have_more_is_sound():
    """Speeds, peaks and every step, in one map."""
    text = offered("# speeds").replace('places = "nodes"', "# places")
    text = re.sub(r"(?m)^\s+\(a slower.*$", "", text)
    plan = study_from_text(text).map
    assert plan.speeds == pytest.approx((10 / 3.6, 20 / 3.6))
    assert plan.peaks
    assert plan.every_step


def test_nodes_are_mapped_without_a_spacing():
    """As the template says: in place of a grid."""
    text = COARSE.replace('spacing = "2 m"', 'places = "nodes"')
    assert study_from_text(text).map.n_places > 80
