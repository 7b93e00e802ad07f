"""What a coarser mesh changes: which bands matter, whose change is named, when it has settled."""

import numpy as np
import pytest

from trundle.results.mesh_change import MeshChange, mesh_warnings, mesh_words

BANDS = np.array([4.0, 8.0, 10**1.5])


def change_of(coarse, fine, *, frequencies=((5.0, 8.0), (5.0, 8.0)), **changes):
    """Levels of two cases at two points in three bands on both meshes."""
    values = {
        "sizes": (1.0, 0.5), "frequencies": np.array(frequencies), "cases": ("a, <b>", "Süd"),
        "points": ("tool", "Käfig"), "bands": BANDS, "levels": np.array([coarse, fine], dtype=float),
    }  # fmt: skip
    return MeshChange(**{**values, **changes})


def uniform(value=1.0):
    return np.full((2, 2, 3), value)


def test_the_largest_change_is_named_with_case_point_and_band():
    """Second case, first point, third band 22 % low: its name is 31.5 Hz, of 31.62."""
    coarse = uniform()
    coarse[1, 0, 2] = 0.78
    coarse[0, 1, 0] = 1.21
    words = mesh_words(change_of(coarse, uniform()))
    assert "band levels by up to 22 % (Süd, tool, 31.5 Hz)" in words
    assert words.startswith("from elements of 1 m to 0.5 m the first 2 frequencies change by")
    assert words.endswith("as much again may be left")


def test_a_tenth_of_the_loudest_is_left_out_at_its_own_point():
    """A whisper beside 100 um/s decides nothing; the same whisper where nothing is louder does."""
    fine = uniform(1e-6)
    fine[0, 0, 0] = 1e-4
    coarse = fine.copy()
    coarse[:, :, 1] *= 1.5
    found = change_of(coarse, fine).level_changes()
    assert np.isnan(found[0, 0, 1])
    assert found[0, 1, 1] == pytest.approx(0.5)
    assert found[1, 0, 1] == pytest.approx(0.5)


def test_bands_without_a_number_are_no_change():
    """NaN in a band on either mesh: not looked at; the rest is."""
    fine, coarse = uniform(), uniform(1.05)
    fine[0, 0, 1] = coarse[0, 1, 2] = np.nan
    change = change_of(coarse, fine)
    assert int(np.isnan(change.level_changes()).sum()) == 2
    assert "up to 5 %" in mesh_words(change)
    assert mesh_warnings(change) == ()


def test_the_frequency_change_is_the_largest_either_way():
    """5 to 5.2 Hz is 4 % of the finer mesh's; 8 down to 7.5 Hz is 6.25 %, and the larger."""
    change = change_of(uniform(), uniform(), frequencies=((5.2, 7.5), (5.0, 8.0)))
    assert change.frequency_change == pytest.approx(0.0625)
    assert "change by up to 6.2 %" in mesh_words(change)
    (warning,) = mesh_warnings(change)
    assert "below 1.1 is relied on" in warning.message


def test_without_modes_or_levels_nothing_is_claimed_of_them():
    """No frequencies: no change of them; the levels alone are held."""
    change = change_of(uniform(1.3), uniform(), frequencies=np.zeros((2, 0)))
    assert change.frequency_change == 0.0
    (warning,) = mesh_warnings(change)
    assert warning.message.startswith("levels have not settled: from elements of 1 m to 0.5 m")
    assert "below 1.3 is relied on" in warning.message
    assert "0.5 m band levels change by up to 30 %" in warning.message
    assert "frequencies" not in warning.message


def test_a_change_that_was_not_looked_at_is_a_doubt_and_no_settled_mesh():
    """None is not settled."""
    (warning,) = mesh_warnings(None)
    assert warning.subject == "mesh"
    assert "was not looked at" in warning.message


@pytest.mark.parametrize("value", [0.0, np.nan])
def test_still_points_and_bands_without_numbers_are_left_out(value):
    """A point that is held, and a case of which no band is excited: the others have settled."""
    levels = np.ones((2, 2, 1, 3))
    levels[:, 1] = value
    change = MeshChange(
        sizes=(2.0, 1.0), frequencies=np.ones((2, 1)), cases=("a", "b"), points=("p",),
        bands=np.array([4.0, 8.0, 16.0]), levels=levels,
    )  # fmt: skip
    assert mesh_warnings(change) == ()
    assert np.isnan(change.level_changes()[1]).all()
    assert "band levels by up to 0 %" in mesh_words(change)


def test_where_no_level_was_compared_nobody_says_that_it_has_settled():
    """No level is known on either mesh: frequencies alone settle no level."""
    change = MeshChange(
        sizes=(2.0, 1.0), frequencies=np.ones((2, 1)), cases=("a",), points=("p",),
        bands=np.array([4.0]), levels=np.full((2, 1, 1, 1), np.nan),
    )  # fmt: skip
    (warning,) = mesh_warnings(change)
    assert "whether levels have settled is not known" in warning.message
    assert "none was compared" in mesh_words(change)
