"""[[road]] and [roughness]: labels, levels, waves and patches, in units of their own."""

import numpy as np
import pytest

from studies import GOOD
from trundle.errors import StudyError
from trundle.road import RoadClass, RoughnessBand, synthesise
from trundle.study_file import study_from_text

ROAD = '[[road]]\nclass = "B"\n'


def loaded(roads=ROAD, more="", folder="."):
    return study_from_text(GOOD.replace(ROAD, roads) + more, folder=folder)


def told(roads=ROAD, more="", folder="."):
    with pytest.raises(StudyError) as caught:
        loaded(roads, more, folder)
    return {p.place: p for p in caught.value.problems}


def survey(folder, name="road.csv", first=0.0, last=60.0):
    """Write the heights of a road of class A [m], from one station to another [m]."""
    band = RoughnessBand(n_min=0.05, n_max=4.0)
    road = synthesise(RoadClass("A"), length=last - first, rng=np.random.default_rng(3), band=band)
    rows = (f"{s + first:.6f},{z:.9f}" for s, z in zip(road.station, road.elevation, strict=True))
    (folder / name).write_text("station [m],height [m]\n" + "\n".join(rows) + "\n")


@pytest.mark.parametrize("name", "ABCDEFGH")
def test_every_class_is_the_one_of_its_letter(name):
    """ISO 8608: the geometric mean of class A is 16e-6 m3 at 0.1 1/m, times 4 each class on."""
    road = loaded(f'[[road]]\nclass = "{name}"\n').roads[name]
    assert road.spectrum.roughness == pytest.approx(16e-6 * 4 ** "ABCDEFGH".index(name))


def test_the_levels_of_a_class_are_its_limits():
    """ISO 8608, table: class B from 32e-6 to 128e-6 m3, with 64e-6 as the geometric mean."""
    both = '[[road]]\nclass = "B"\nlevel = "{}"\n'
    roads = loaded("".join(both.format(one) for one in ("lower", "upper")) + ROAD).roads
    assert list(roads) == ["B lower", "B upper", "B"]
    found = [road.spectrum.roughness for road in roads.values()]
    assert found == pytest.approx([32e-6, 128e-6, 64e-6])


def test_labels_say_what_differs_and_a_name_comes_before_them():
    """Two roads of one class differ by level or waviness; one with a name is called by it."""
    roads = loaded(
        '[[road]]\nclass = "C"\nwaviness = 2.4\n'
        '[[road]]\nclass = "C"\nlevel = "upper"\nwaviness = 2.4\n'
        '[[road]]\nclass = "C"\nwaviness = 2\n'
        '[[road]]\nclass = "C"\nname = "Straße, nass <1>"\n'
        '[[road]]\nroughness = "20 cm3"\n'
        '[[road]]\nflatness = "FF 35"\n'
        "[[road]]\nsmooth = true\n"
    ).roads
    assert list(roads) == [
        "C w=2.4", "C upper w=2.4", "C", "Straße, nass <1>", "2e-05 m3", "FF 35", "smooth",
    ]  # fmt: skip
    assert roads["2e-05 m3"].spectrum.roughness == pytest.approx(20e-6)  # 1 cm3 is 1e-6 m3


def test_two_roads_of_one_label_are_refused():
    """Their results would be one."""
    assert told(ROAD + '[[road]]\nsmooth = true\nname = "B"\n')["road[2]"].value == "'B' 2 times"


@pytest.mark.parametrize(
    ("road", "words"),
    [
        ('class = "B"\nroughness = "1e-6 m3"', "got class and roughness"),
        ('smooth = true\nclass = "B"', "got class and smooth"),
        ("smooth = false", "got none of them"),
        ('name = "x"', "got none of them"),
        ("smooth = true\nwaviness = 2", "a road of smooth has no waviness"),
        ('roughness = "1e-6 m3"\nlevel = "upper"', "a road of roughness has no level"),
        ('class = "B"\nfrom = "3 m"\nbeyond = "mirror"', "a road of class has no beyond, from"),
        ('file = "x.csv"\nwaviness = 2.0', "a road of file has no waviness"),
        ("class = 'B'\nunit = 'mm'", "a road of class has no unit"),
    ],
)
def test_a_road_is_one_thing(road, words):
    """A key that is not of its kind would be dropped: what is left is not what was meant."""
    assert words in told(f"[[road]]\n{road}\n")["road[1]"].rule


@pytest.mark.parametrize("waviness", ["0.99", "4.01", "nan", "inf", '"2"', "true"])
def test_a_waviness_is_a_number_from_1_to_4(waviness):
    """ISO 8608 has 1.5 to 3 of measured roads."""
    assert list(told(f"{ROAD}waviness = {waviness}\n")) == ["road[1].waviness"]


def test_waves_in_other_units_are_cycles_a_metre():
    """5 cycles a kilometre, 1 a 10 cm, a patch of 150 mm."""
    band = loaded(
        more='[roughness]\nn_min = "50 1/km"\nn_max = "0.1 1/cm"\ncontact_patch = "150 mm"\n'
        "gaussian_amplitudes = true\n"
    ).band
    assert (band.n_min, band.n_max, band.contact_patch) == pytest.approx((0.05, 10.0, 0.15))
    assert band.gaussian_amplitudes is True


def test_waves_that_nobody_names_are_those_of_iso_8608():
    """0.011 to 2.83 cycles a metre, a wheel in a point, and as far as steps follow."""
    for study in (loaded(), loaded(more="[roughness]\n")):
        band = study.band
        assert (band.n_min, band.n_max, band.contact_patch) == (0.011, 2.83, 0.0)
        assert not band.gaussian_amplitudes
        assert study.band_follows_dt


def test_waves_end_where_the_step_can_follow_and_not_where_it_is_told_not_to():
    """At 15 km/h and 5 ms: 24 cycles a metre of 30."""
    more = '[roughness]\nn_max = "30 1/m"\n'
    study = loaded(more=more)
    (method,) = study.methods
    assert study.band_for(study.drives["main"], method).n_max == pytest.approx(24.0)
    fixed = told(more=more + "n_max_follows_dt = false\n")
    assert fixed["roughness.n_max"].value == "30 1/m"
    just = more.replace("30", "24") + "n_max_follows_dt = false\n"
    assert loaded(more=just).band.n_max == 24.0


def test_a_class_of_a_road_is_that_of_the_library():
    """Two ways to one road: by the file, and by the class itself."""
    road, direct = (
        loaded(f'{ROAD}level = "upper"\nwaviness = 2.2\n').roads["B upper w=2.2"],
        (RoadClass("B", level="upper", waviness=2.2)),
    )
    assert road.spectrum.roughness == direct.spectrum.roughness
    assert road.spectrum.waviness == direct.spectrum.waviness


def test_a_survey_begins_at_the_route_with_its_own_first_station(tmp_path):
    """Surveyed from 100 m on; unless a station is named, its first is the route's start."""
    survey(tmp_path, "Straße 1.csv", 100.0, 160.0)
    road = '[[road]]\nfile = "Straße 1.csv"\nbeyond = "mirror"\n'
    patch = '[roughness]\ncontact_patch = "0.2 m"\n'
    study = loaded(road, patch, tmp_path)
    assert list(study.roads) == ["Straße 1"]
    assert study.roads["Straße 1"].start == pytest.approx(100.0)
    later = loaded(road + 'from = "12000 cm"\n', patch, tmp_path).roads["Straße 1"]
    assert later.start == pytest.approx(120.0)
    assert study.files["Straße 1.csv"] == (tmp_path / "Straße 1.csv").read_bytes()


def test_a_survey_is_found_where_the_results_keep_it(tmp_path):
    """Read back from another folder under another name: the same heights."""
    from trundle.study_file import load_study

    survey(tmp_path)
    road = '[[road]]\nfile = "road.csv"\nbeyond = "level"\n'
    text = GOOD.replace(ROAD, road) + '[roughness]\ncontact_patch = "0.2 m"\n'
    (tmp_path / "s.toml").write_text(text)
    before = load_study(tmp_path / "s.toml").roads["road"]
    (tmp_path / "road.csv").rename(tmp_path / "kept.bin")
    with pytest.raises(StudyError, match="no such file"):
        load_study(tmp_path / "s.toml")
    after = load_study(tmp_path / "s.toml", files={"road.csv": tmp_path / "kept.bin"}).roads["road"]
    np.testing.assert_array_equal(after.tracks[0].elevation, before.tracks[0].elevation)


def test_a_survey_that_stops_short_is_told_for_the_route_that_needs_it(tmp_path):
    """20 m of survey cannot carry 12 m of route, a truck of 12.5 m and its run-in."""
    survey(tmp_path, last=20.0)
    road = '[[road]]\nfile = "road.csv"\n'
    problem = told(road, '[roughness]\ncontact_patch = "0.2 m"\n', tmp_path)["road[1]"]
    assert problem.rule.startswith("route 'main' needs")
    assert problem.value == "0.10 to 19.90 m"  # half a patch inside both ends
    assert 'beyond = "mirror" or "level"' in problem.remedy


def test_a_survey_is_driven_on_a_patch():
    """A tyre of no length would feel every sample."""
    found = told(ROAD.replace('class = "B"', 'file = "gone.csv"'))
    assert list(found) == ["road[1].file"]
    assert found["road[1].file"].rule == "gone.csv: no such file"


def test_waves_of_a_methods_own_are_told_of_the_method():
    """Steps of 5 ms follow 24 cycles a metre at 15 km/h; the study's 2.83 are no mistake."""
    more = "[roughness]\nn_max_follows_dt = false\n"
    text = GOOD.replace('dt = "5 ms"', 'dt = "5 ms"\nn_max = "90 1/m"') + more
    with pytest.raises(StudyError) as caught:
        study_from_text(text)
    (problem,) = caught.value.problems
    assert (problem.place, problem.value) == ("method[1].n_max", "90 1/m")
    assert "waves to 24 1/m" in problem.rule


def test_who_drives_needs_a_road_and_is_asked_for_it_once():
    """Without one nothing of roads is looked at: not a survey's length, not a feature's road."""
    feature = '[[feature]]\nkind = "bump"\nat = "4 m"\nlength = "1 m"\nheight = "1 cm"\n'
    for more in ("", feature, f'{feature}roads = ["B"]\n'):
        found = told("", more)
        assert list(found) == ["road"]
        assert found["road"].value == "nothing"


def test_where_nobody_drives_there_is_no_road():
    """Its one label says so."""
    walker = '[[walker]]\nname = "guard"\nguide = "p354"\npace = "2 Hz"\nat = ["3 m", "1 m"]\n'
    alone = GOOD.partition("[vehicle.truck]")[0] + GOOD[GOOD.index("[[point]]") :] + walker
    assert list(study_from_text(alone).roads) == ["no road"]
