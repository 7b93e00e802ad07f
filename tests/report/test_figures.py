"""Drawings: what is drawn does not cover itself, and many axles or methods are no mistake."""

import numpy as np
import pytest

import trundle as tr
from studies import GOOD, LIBRARY
from trundle.report.figures import vehicle
from trundle.report.figures.vehicle import _label_rows

AXLES = ",\n".join(
    f'  {{ setback = "{1.3 * i:g} m", stiffness = "1 MN/m", damping = "20 kN s/m" }}'
    for i in range(11)
)
LONG = f"""kind = "planar"
bodies = [{{ mass = "60 t", pitch_inertia = "900000 kg m2", centre = "6.5 m" }}]
axles = [
{AXLES}
]"""


@pytest.mark.parametrize("seed", range(5))
def test_labels_in_a_row_do_not_cover_each_other(seed):
    """Whatever the axles: labels of one row are a width apart, and no row is left out."""
    places = np.sort(np.random.default_rng(seed).uniform(0.0, 12.0, 9))
    rows = _label_rows(places, 2.0)
    assert set(rows) == set(range(max(rows) + 1))
    for row in set(rows):
        own = places[np.array(rows) == row]
        assert (np.diff(own) >= 2.0).all()
    assert _label_rows(np.array([0.0, 3.0, 6.0]), 2.0) == [0, 0, 0]


def test_a_vehicle_of_many_axles_is_drawn(tmp_path):
    """Eleven axles are more than there are colours."""
    study = tr.study_from_text(
        GOOD.replace(LIBRARY, LONG).replace('"12 m", "3 m"', '"11 m", "3 m"')
    )
    result = tr.run_study(study)
    drawn = list(vehicle.drawings(result))
    for drawing in drawn:
        drawing.save(tmp_path)
    assert [d.name for d in drawn] == ["vehicle", "vehicle_modes", "axle_forces"]
    assert len(list(tmp_path.glob("*.png"))) == 3
