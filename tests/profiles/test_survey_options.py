"""Which tracks, which stretch, in which units: what a survey's reader states, by hand."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.profiles import ProfileOptions, read_profile

S = np.arange(0.0, 12.0, 0.5)
LEFT = np.array([(3 * i) % 7 for i in range(len(S))], dtype=float)
RIGHT = np.array([(5 * i) % 4 for i in range(len(S))], dtype=float)
PLAIN = {"detrend": False}


def kept(tmp_path, text, name="road.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    return path


def two(heading="station [m],left [mm],right [mm]", mark=",", factor=1.0):
    rows = (f"{a:g}{mark}{b:g}{mark}{c:g}" for a, b, c in zip(S * factor, LEFT, RIGHT, strict=True))
    return heading + "\n" + "\n".join(rows) + "\n"


def test_tracks_lie_in_the_order_in_which_they_are_named(tmp_path):
    """right at 0.8 m and left at -0.7 m, as stated: the road sorts them from right to left."""
    options = ProfileOptions(tracks=("right", "LEFT"), lateral=(0.8, -0.7), **PLAIN)
    road = read_profile(kept(tmp_path, two()), options).road
    assert road.lateral.tolist() == [-0.7, 0.8]
    np.testing.assert_allclose(road.tracks[0].elevation, 1e-3 * LEFT, atol=1e-15)
    np.testing.assert_allclose(road.tracks[1].elevation, 1e-3 * RIGHT, atol=1e-15)


def test_a_track_may_be_named_by_its_number_and_lies_in_the_middle_alone(tmp_path):
    """The second column of heights is track 2; one track needs no place."""
    road = read_profile(kept(tmp_path, two()), ProfileOptions(tracks=("2",), **PLAIN)).road
    assert road.lateral.tolist() == [0.0]
    np.testing.assert_allclose(road.tracks[0].elevation, 1e-3 * RIGHT, atol=1e-15)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"tracks": ("middle",)}, "'middle' is no track of it; there are: left, right"),
        ({"tracks": ("3",)}, "'3' is no track of it"),
        ({"tracks": ("0",)}, "'0' is no track of it"),
        ({"tracks": ("t",)}, "'t' is several of its tracks"),
        ({"tracks": ("left", "1")}, "tracks names one column twice: left, 1"),
        ({"lateral": (0.5,)}, r"lateral gives 1 places for 2 tracks \(left, right\)"),
        ({"lateral": (0.5, 0.5)}, r"two tracks lie at one place: \[0\.5, 0\.5\] m"),
        ({}, "does not say where they lie"),
        ({"tracks": ("left",), "first": 3.0, "last": 4.0}, "fewer than 4 of them between 3 and 4"),
        ({"tracks": ("right",), "unit": "kg"}, r"heights \(right\), 'kg', is no length"),
    ],
)
def test_options_that_do_not_fit_are_refused_with_what_there_is(tmp_path, options, said):
    """A name that is none, a number beyond, places too few, a stretch too short."""
    with pytest.raises(InputError, match=said):
        read_profile(kept(tmp_path, two()), ProfileOptions(**options))


def test_a_stretch_holds_both_of_its_ends_in_the_files_own_chainage(tmp_path):
    """2.5 to 6 m of stations every 0.5 m: eight points, still called so."""
    options = ProfileOptions(tracks=("left",), first=2.5, last=6.0, **PLAIN)
    (track,) = read_profile(kept(tmp_path, two()), options).road.tracks
    np.testing.assert_allclose(track.station, np.arange(2.5, 6.01, 0.5))
    np.testing.assert_allclose(track.elevation, 1e-3 * LEFT[5:13], atol=1e-15)


def test_a_stretch_is_given_in_metres_whatever_the_stations_are(tmp_path):
    """Stations in feet: 1.5 m is 4.92 ft, so the first station taken is 5 ft, 1.524 m."""
    text = two("station [ft],left [mm],right [mm]", factor=2.0)
    options = ProfileOptions(tracks=("left",), first=1.5, **PLAIN)
    (track,) = read_profile(kept(tmp_path, text), options).road.tracks
    assert track.station[0] == pytest.approx(5.0 * 0.3048)
    assert track.station[-1] == pytest.approx(23.0 * 0.3048)


def test_the_trend_is_that_of_the_stretch_and_of_each_track(tmp_path):
    """A road that rises by 2 % for 6 m and falls then: the first half alone has no trend left."""
    rise = np.where(S < 6.0, 20.0 * S, 240.0 - 20.0 * S)
    rows = "\n".join(f"{a:g},{b:g}" for a, b in zip(S, rise + 500.0, strict=True))
    path = kept(tmp_path, f"station [m],h [mm]\n{rows}\n")
    (half,) = read_profile(path, ProfileOptions(last=5.5)).road.tracks
    np.testing.assert_allclose(half.elevation, 0.0, atol=1e-12)
    (whole,) = read_profile(path).road.tracks
    slope, level = np.polyfit(S, 1e-3 * rise, 1)
    np.testing.assert_allclose(whole.elevation, 1e-3 * rise - slope * S - level, atol=1e-12)
    (kept_as_it_is,) = read_profile(path, ProfileOptions(**PLAIN)).road.tracks
    np.testing.assert_allclose(kept_as_it_is.elevation, 1e-3 * (rise + 500.0), atol=1e-12)


def test_names_with_commas_quotes_and_umlauts_are_names(tmp_path):
    """As a spreadsheet quotes them, in Windows' letters: the track is found by part of its name."""
    text = two('Strecke [m];"Höhe, rechts <außen> [mm]";"Höhe, links [mm]"', mark=";")
    path = kept(tmp_path, text, encoding="cp1252")
    options = ProfileOptions(tracks=("<AUSSEN>".replace("SS", "ß"),), **PLAIN)
    (track,) = read_profile(path, options).road.tracks
    np.testing.assert_allclose(track.elevation, 1e-3 * LEFT, atol=1e-15)
    with pytest.raises(InputError, match=r"'höhe' is several of its tracks; .* rechts <außen>"):
        read_profile(path, ProfileOptions(tracks=("höhe",)))


def test_words_behind_a_table_are_told(tmp_path):
    """A note of the surveyor below the numbers: passed over, with its line."""
    path = kept(tmp_path, two() + "end of survey, wet\n")
    read = read_profile(path, ProfileOptions(tracks=("left",), **PLAIN))
    assert read.told == ("line 26 behind the table is passed over: 'end of survey, wet'",)
    assert len(read.road.tracks[0].station) == 24


@pytest.mark.parametrize(
    ("heading", "rows", "said"),
    [
        ("station [km],h [mm]", [(1e5 + k, k % 2) for k in range(5)], "are their unit and step ri"),
        ("station [mm],h [mm]", [(1e-4 * k, 0) for k in range(5)], "are their unit and step right"),
        ("station [m],h [m]", [(k, 2e5) for k in range(5)], "a height of 'h' is beyond 100000 m"),
    ],
)
def test_stations_and_heights_that_no_road_has_are_refused(tmp_path, heading, rows, said):
    """Beyond 10,000 km, closer than a micrometre, higher than 100 km."""
    text = heading + "\n" + "\n".join(f"{a!r},{b!r}" for a, b in rows) + "\n"
    with pytest.raises(InputError, match=said):
        read_profile(kept(tmp_path, text))


def erd(*, lines=(), channels=2, step="0.5", names="SHORTNAMLElev.  RElev."):
    head = ["ERDFILEV2.00", f"{channels}, 5, -1, 1, 5, {step}, -1,", "TITLE   a run", names]
    rows = ["0 10", "1 20", "2 10", "1 0", "0 10"]
    return "\n".join([*head, "UNITSNAMmm      in", "XUNITS  ft", *lines, "END", *rows]) + "\n"


def test_an_erd_file_has_a_start_a_step_and_a_unit_for_each_channel(tmp_path):
    """Stations of 100 ft and half feet more; the left in mm and the right in inches."""
    path = kept(tmp_path, erd(lines=["XSTART  100"]), "run.erd")
    options = ProfileOptions(lateral=(0.9, -0.9), **PLAIN)
    right, left = read_profile(path, options).road.tracks
    np.testing.assert_allclose(left.station, 0.3048 * (100.0 + 0.5 * np.arange(5)))
    np.testing.assert_allclose(left.elevation, 1e-3 * np.array([0, 1, 2, 1, 0]), atol=1e-15)
    np.testing.assert_allclose(right.elevation, 0.0254 * np.array([10, 20, 10, 0, 10]), rtol=1e-12)


def test_long_names_of_channels_win_and_go_on_below(tmp_path):
    """32 columns each, the second on a line that continues the first."""
    names = (
        "LONGNAME" + "Left wheel path".ljust(32) + "\n&1000   Right <wheel> path\nSHORTNAMa       b"
    )
    path = kept(tmp_path, erd(names=names), "run.erd")
    with pytest.raises(InputError, match=r"2 tracks \(Left wheel path, Right <wheel> path\)"):
        read_profile(path, ProfileOptions())


def test_a_file_that_is_not_there_is_said(tmp_path):
    """A folder is no file either."""
    for path in (tmp_path / "none.csv", tmp_path):
        with pytest.raises(InputError, match="no such file"):
            read_profile(path)
