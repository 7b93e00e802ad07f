"""Changes of a study: each alters what it names, several go together, and nothing else moves."""

from dataclasses import replace

import numpy as np
import pytest

from studies import GOOD
from trundle.dynamics import ModalRatio
from trundle.errors import InputError
from trundle.mitigate.changes import (
    AS_IT_IS,
    Change,
    changed_study,
    each_change,
    every_combination,
)
from trundle.signals import Isolator
from trundle.study_file import study_from_text
from trundle.vehicle import library_vehicle

OTHER = """
[[route]]
name = "back"
vehicle = "truck"
path = [["12 m", "4 m"], ["0 m", "4 m"]]
speed = "30 km/h"

[[point]]
name = "tool B"
at = ["9 m", "3 m"]
isolator = { frequency = "1 Hz", damping = "5 %" }
"""
SOFT = Isolator(frequency=2.0, damping_ratio=0.1)


@pytest.fixture(scope="module")
def study():
    return study_from_text(GOOD.replace("[[road]]", OTHER + "\n[[road]]", 1))


def test_the_slab_is_thicker_by_its_mass_and_by_nothing_else(study):
    """0.1 m more of 2450 kg/m3 on 12 m by 6 m are 17.64 t; beams, loads and edges stay."""
    thick = changed_study(study, Change(slab_thickness=0.3))
    more = 0.1 * 2450.0 * 12.0 * 6.0
    assert thick.floor.moving_mass() - study.floor.moving_mass() == pytest.approx(more, rel=0.01)
    assert thick.plan.slab.thickness == 0.3
    assert thick.plan.slab.superimposed_mass == study.plan.slab.superimposed_mass
    assert thick.mesh_size == study.mesh_size
    assert len(thick.floor.nodes) == len(study.floor.nodes)
    assert study.plan.slab.thickness == 0.2  # what is changed is a new value
    assert thick.drives is study.drives


def test_a_floor_that_came_as_a_mesh_keeps_its_slab(study):
    """Its thickness is nowhere to be changed: refused, by its name."""
    mesh = replace(study, plan=None)
    with pytest.raises(InputError, match=rf"{study.floor.name} came as a mesh: its slab cannot"):
        changed_study(mesh, Change(slab_thickness=0.3))
    assert changed_study(mesh, Change(damping_ratio=0.05)).plan is None


def test_another_vehicle_drives_every_route_as_before(study):
    """Both routes, their ways and speeds; a study of two directions keeps them."""
    car = library_vehicle("car_bmw_320i")
    changed = changed_study(study, Change(vehicle=car))
    assert [drive.vehicle for drive in changed.drives.values()] == [car, car]
    for name, drive in changed.drives.items():
        assert drive.route is study.drives[name].route
        assert drive.run_in == study.drives[name].run_in


def test_an_isolator_stands_under_every_point_in_place_of_its_own(study):
    """One point had one of 1 Hz, the other none."""
    assert list(study.isolations) == ["tool B"]
    changed = changed_study(study, Change(isolation=SOFT))
    assert changed.isolations == {"tool": SOFT, "tool B": SOFT}
    assert changed_study(study, Change()).isolations == study.isolations


def test_damping_is_that_of_every_mode_by_every_method(study):
    """6 % at any frequency, whatever the method's own law was; step and modes stay."""
    changed = changed_study(study, Change(damping_ratio=0.06))
    for method, before in zip(changed.methods, study.methods, strict=True):
        ratios = method.interaction.damping.ratios(2.0 * np.pi * np.array([1.0, 10.0, 80.0]))
        np.testing.assert_allclose(ratios, 0.06)
        assert isinstance(method.interaction.damping, ModalRatio)
        assert method.interaction.integration is before.interaction.integration
        assert method.name == before.name


def test_a_change_of_nothing_is_the_study_itself(study):
    """The first row of every comparison must be what a run of the study says."""
    same = changed_study(study, Change())
    assert same is study
    assert Change().label == AS_IT_IS


def test_two_changes_go_together_and_the_later_word_counts():
    """A slab of 0.3 m but 0.25 m is one of 0.25 m; labels of nothing are left out."""
    slab, other = (Change(label=f"slab {t}", slab_thickness=t) for t in (0.3, 0.25))
    damped = Change(label="damping", damping_ratio=0.05, isolation=SOFT)
    both = slab.but(damped)
    assert (both.slab_thickness, both.damping_ratio, both.isolation) == (0.3, 0.05, SOFT)
    assert both.label == "slab 0.3, damping"
    assert slab.but(other).slab_thickness == 0.25
    assert Change().but(slab).label == slab.but(Change()).label == "slab 0.3"
    assert Change().but(Change()).label == AS_IT_IS
    assert slab.damping_ratio is None  # neither has changed


def test_combinations_hold_each_choice_of_each_kind_once():
    """2 slabs, 1 damping, 3 isolators: 3 * 2 * 4 = 24 together, 1 + 2 + 1 + 3 = 7 one by one."""
    levers = [
        [Change(label=f"s{t}", slab_thickness=t) for t in (0.3, 0.4)],
        [Change(label="d", damping_ratio=0.05)],
        [],
        [Change(label=f"i{f}", isolation=Isolator(frequency=f, damping_ratio=0.1))
         for f in (1.0, 2.0, 3.0)],
    ]  # fmt: skip
    every = every_combination(levers)
    assert len(every) == len({one.label for one in every}) == 24
    assert len({(c.slab_thickness, c.damping_ratio, id(c.isolation)) for c in every}) == 24
    assert every[0].label == AS_IT_IS
    each = each_change(levers)
    assert [one.label for one in each] == [AS_IT_IS, "s0.3", "s0.4", "d", "i1.0", "i2.0", "i3.0"]
    assert [one.label for one in every_combination([])] == [AS_IT_IS]
    assert len(each_change([[], []])) == 1
