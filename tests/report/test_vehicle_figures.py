"""Vehicles in pictures: loads in tonnes, springs, natural motions, and forces in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from hand_made import result_of, study_of
from matplotlib.patches import Circle, FancyBboxPatch

from trundle.report.figures import vehicle as figures
from trundle.report.figures.vehicle_sheet import vehicle_sheet
from trundle.road import RoadClass, RoughnessBand
from trundle.units import KMH
from trundle.vehicle import GRAVITY, Axle, Body, Description, Hinge, sprung_mass

VAN = Description(
    name="van <1>",
    bodies=(Body(mass=3200.0, pitch_inertia=5000.0, centre=1.0),),
    axles=(
        Axle(body=0, setback=0.0, stiffness=2e5, damping=4e3),
        Axle(body=0, setback=4.0, stiffness=3e5, damping=6e3),
    ),
    source="a <maker>",
)
"""By moments about the rear axle, 3/4 of 3.2 t stand on the front one."""


def words(axes):
    return [text.get_text() for text in axes.texts]


def test_loads_and_springs_stand_under_their_axle():
    """Statics: 3.2 t with the centre 1 m behind the front of 4 m: 2.4 t and 0.8 t; k and c as given."""
    van = VAN.build()
    (axes,) = figures.vehicle_figure(van).axes
    labels = {
        float(t.get_position()[0]): t.get_text() for t in axes.texts if "MN/m" in t.get_text()
    }
    assert set(labels) == {0.0, 4.0}
    assert labels[0.0].split("\n")[1:] == ["2.40 t", "k = 0.2 MN/m", "c = 4 kN s/m"]
    assert labels[4.0].split("\n")[1:] == ["0.80 t", "k = 0.3 MN/m", "c = 6 kN s/m"]
    assert "van <1>\n3.20 t" in words(axes)
    assert axes.get_xlabel() == "distance behind the front axle [m]"
    dots = [float(line.get_xdata()[0]) for line in axes.lines if line.get_marker() == "o"]
    assert dots == [0.0, 4.0]


def test_the_arrow_of_travel_points_to_the_front():
    """Setbacks are behind the front axle, at larger x: it drives towards smaller ones."""
    (axes,) = figures.vehicle_figure(VAN.build()).axes
    (arrow,) = [text for text in axes.texts if text.get_text() == "direction of travel"]
    assert arrow.xy[0] < arrow.get_position()[0]
    assert arrow.arrowprops["arrowstyle"] == "->"


def test_natural_motions_are_those_of_bounce_and_pitch():
    """Two degrees of freedom solved by hand: det(K - w2 M) = 0; motion over an axle is z + x phi."""
    figure = figures.vehicle_modes_figure(VAN.build())
    mass, inertia, k = 3200.0, 5000.0, (2e5, 3e5)
    arms = np.array([-1.0, 3.0])  # of the axles behind the centre
    stiffness = np.array([[sum(k), k @ arms], [k @ arms, k @ arms**2]])
    a, b, c = (
        mass * inertia,
        -(mass * stiffness[1, 1] + inertia * stiffness[0, 0]),
        np.linalg.det(stiffness),
    )
    squares = (-b + np.array([-1.0, 1.0]) * np.sqrt(b * b - 4.0 * a * c)) / (2.0 * a)
    assert len(figure.axes) == 2
    for axes, square in zip(figure.axes, squares, strict=True):
        assert axes.get_title() == f"{np.sqrt(square) / (2.0 * np.pi):.2f} Hz"
        turn = (mass * square - stiffness[0, 0]) / stiffness[0, 1]
        motion = 1.0 + arms * turn
        heights = np.array([bar.get_height() for bar in axes.patches])
        np.testing.assert_allclose(heights, motion / motion[np.abs(motion).argmax()], atol=1e-9)
        assert axes.get_ylim() == (-1.15, 1.15)


def test_a_vehicle_of_two_routes_is_drawn_once_at_all_its_speeds():
    """Speeds of both routes and those that a publication asks for, each once, rising."""
    text = (
        '\n[[route]]\nname = "back"\nvehicle = "truck"\npath = [["12 m", "3 m"], ["0 m", "3 m"]]\n'
    )
    study = study_of(text + 'speed = "8 km/h"\n')
    study = replace(study, force_speeds=(15 * KMH, 20 * KMH))
    drawn = {one.name: one for one in figures.drawings(result_of(study))}
    assert set(drawn) == {"vehicle", "vehicle_modes", "axle_forces"}
    figure = drawn["axle_forces"].draw()
    titles = [axes.get_title() for axes in figure.axes]
    assert [title.partition(",")[0] for title in titles] == ["8 km/h", "15 km/h", "20 km/h"]


def test_two_vehicles_have_pictures_of_their_own():
    """A second vehicle's pictures bear its name and a number, and its own source."""
    text = '\n[vehicle.car]\nkind = "car_bmw_320i"\n\n[[route]]\nname = "back"\nvehicle = "car"\n'
    study = study_of(text + 'path = [["12 m", "3 m"], ["0 m", "3 m"]]\nspeed = "8 km/h"\n')
    drawn = {one.name: one for one in figures.drawings(result_of(study))}
    car = study.drives["back"].vehicle
    assert drawn["vehicle_2"].title == f"Vehicle: {car.name}"
    assert car.source in drawn["vehicle_2"].caption
    assert f"{car.total_mass / 1e3:.2f} t" in words(drawn["vehicle_2"].draw().axes[0])[0]
    assert {"vehicle", "axle_forces", "vehicle_modes_2", "axle_forces_2"} <= set(drawn)


def test_a_road_that_is_given_is_not_the_one_forces_are_drawn_on():
    """Joints are taken off their random road; where none is random, class A is what is said."""
    study = study_of('\n[[road]]\nname = "flat"\nsmooth = true\n', ('[[road]]\nclass = "B"\n', ""))
    forces = [one for one in figures.drawings(result_of(study)) if one.name == "axle_forces"]
    assert str(RoadClass("A")) in forces[0].caption
    study = study_of()
    forces = [one for one in figures.drawings(result_of(study)) if one.name == "axle_forces"]
    assert str(study.roads["B"]) in forces[0].caption


def test_forces_are_dynamic_and_as_large_as_their_spectrum_says():
    """Less the static load, in tonnes; the variance of the force is the integral of its PSD.

    A sprung mass on a road of class A: ``|H|^2 G`` with the closed-form transfer of one degree of
    freedom. Four runs of 25 s hold some 100 periods of its 2 Hz: the RMS is within a fifth.
    """
    mass, f0, zeta, speed = 1000.0, 2.0, 0.3, 10.0
    k = mass * (2.0 * np.pi * f0) ** 2
    one = sprung_mass(mass=mass, stiffness=k, damping=2.0 * zeta * np.sqrt(k * mass))
    band, road = RoughnessBand(n_min=0.02, n_max=1.0), RoadClass("A")
    f = np.linspace(0.02 * speed, 1.0 * speed, 20_001)
    r = f / f0
    above = 1.0 + (2.0 * zeta * r) ** 2
    transfer = mass**2 * (2.0 * np.pi * f) ** 4 * above / ((1.0 - r**2) ** 2 + above - 1.0)
    psd = 16e-6 * (f / speed / 0.1) ** -2.0 / speed
    expected = np.sqrt(np.trapezoid(transfer * psd, f)) / GRAVITY / 1e3
    squares = []
    for seed in range(4):
        (axes,) = figures.axle_forces_figure(one, road, band, [speed], seed=seed).axes
        (line,) = axes.lines
        time, force = line.get_data()
        squares.append(np.mean(force[time > 2.0] ** 2))
        assert abs(force[time > 2.0].mean()) < 0.1 * expected
    assert np.sqrt(np.mean(squares)) == pytest.approx(expected, rel=0.2)
    assert axes.get_ylabel() == "force [t]"
    assert axes.get_title() == f"36 km/h, {road}"


def test_a_sheet_has_axle_loads_in_kilonewtons_where_the_wheels_are():
    """2.4 t and 0.8 t times 9.81 m/s2; a wheel at each axle, standing on the ground."""
    van = VAN.build()
    figure = vehicle_sheet(VAN, van, 10.0)
    side = figure.axes[0]
    loads = {t.xy[0]: t.get_text().split("\n")[1] for t in side.texts if "kN" in t.get_text()}
    assert loads == {
        0.0: f"{2.4 * GRAVITY:.4g} kN", 4.0: f"{0.8 * GRAVITY:.4g} kN",
    }  # fmt: skip
    wheels = {}
    for patch in side.patches:
        if isinstance(patch, Circle):
            wheels.setdefault(patch.center[0], []).append((patch.center[1], patch.radius))
    assert set(wheels) == {0.0, 4.0}
    assert all(height == max(r for _, r in some) for some in wheels.values() for height, _ in some)
    assert side.get_title() == "van <1> (3.2 t)"
    assert side.get_xlabel() == "behind the front axle [m]; travels to the left"
    assert side.get_aspect() == 1.0
    assert "3.2 t" in words(side)


def test_both_wheels_of_an_axle_are_one_load():
    """A van of two tracks: each wheel has half, and the sheet adds them up under one name."""
    wide = VAN.widened(1.6)
    van = wide.build()
    assert van.n_contacts == 4
    side = vehicle_sheet(wide, van, 10.0).axes[0]
    loads = [t.get_text().split("\n") for t in side.texts if "kN" in t.get_text()]
    assert [load for _, load in loads] == [f"{2.4 * GRAVITY:.4g} kN", f"{0.8 * GRAVITY:.4g} kN"]
    assert all("left" not in name and "right" not in name for name, _ in loads)


def test_bodies_lie_over_their_axles_and_meet_at_the_hinge():
    """Tractor over 0 to 3 m and trailer from the hinge at 2.5 m to 9 m; the hinge between them."""
    train = Description(
        name="train",
        bodies=(
            Body(mass=6000.0, pitch_inertia=9000.0, centre=1.0),
            Body(mass=20_000.0, pitch_inertia=90_000.0, centre=6.5),
        ),
        axles=(
            Axle(body=0, setback=0.0, stiffness=1e6),
            Axle(body=0, setback=3.0, stiffness=1e6),
            Axle(body=1, setback=9.0, stiffness=1e6),
        ),
        hinges=(Hinge(bodies=(0, 1), setback=2.5),),
    )
    side = vehicle_sheet(train, train.build(), 10.0).axes[0]
    boxes = [patch for patch in side.patches if isinstance(patch, FancyBboxPatch)]
    spans = [(box.get_x(), box.get_x() + box.get_width()) for box in boxes]
    (first, second) = spans
    assert first[0] < 0.0
    assert 3.0 < first[1] < 9.0
    assert 0.0 < second[0] < 2.5
    assert second[1] > 9.0
    hinge = [line for line in side.lines if line.get_marker() == "o"]
    assert [float(line.get_xdata()[0]) for line in hinge] == [2.5]
    assert {"6 t", "20 t"} <= set(words(side))


def test_forces_of_a_sheet_are_the_closed_form():
    """One degree of freedom on class A at 36 km/h: density in kN/rtHz, and the share of its weight.

    The ground is drawn grey from where the class is extrapolated on: 2.83 cycle/m times 10 m/s.
    """
    mass, f0, zeta, speed = 1000.0, 2.0, 0.3, 10.0
    k = mass * (2.0 * np.pi * f0) ** 2
    one = sprung_mass(mass=mass, stiffness=k, damping=2.0 * zeta * np.sqrt(k * mass))
    described = Description(
        name="mass", bodies=(Body(mass=mass),), axles=(Axle(body=0, setback=0.0, stiffness=k),)
    )
    axes = vehicle_sheet(described, one, speed).axes[-1]
    curve = next(line for line in axes.lines if "of static" in str(line.get_label()))
    f, density = curve.get_data()
    r = f / f0
    above = 1.0 + (2.0 * zeta * r) ** 2
    size = mass * (2.0 * np.pi * f) ** 2 * np.sqrt(above / ((1.0 - r**2) ** 2 + above - 1.0))
    psd = 16e-6 * (f / speed / 0.1) ** -2.0 / speed
    np.testing.assert_allclose(density, size * np.sqrt(psd) / 1e3, rtol=1e-9)
    fine = np.linspace(0.5, 80.0, 100_001)
    power = np.interp(fine, f, size**2 * psd)
    share = np.sqrt(np.trapezoid(power, fine)) / (mass * GRAVITY)
    told = float(curve.get_label().rpartition(", ")[2].partition("%")[0]) / 100.0
    assert told == pytest.approx(share, abs=2e-3)
    assert axes.get_ylabel() == "dynamic force [kN/rtHz]"
    assert axes.get_title() == "class A at 36 km/h, point contact; RMS to 80 Hz"
    grey = axes.patches[0].get_x(), axes.patches[0].get_x() + axes.patches[0].get_width()
    assert grey == (pytest.approx(28.3), pytest.approx(80.0))
    assert "class A extrapolated" in words(axes)


def test_a_tyres_patch_smooths_short_waves():
    """At 10 m/s a patch of 0.5 m covers one wave of 20 Hz: there the force is nought."""
    described = replace(VAN, contact_patch=0.5)
    axes = vehicle_sheet(described, described.build(), 10.0).axes[-1]
    bare = vehicle_sheet(VAN, VAN.build(), 10.0).axes[-1]
    f, smooth = axes.lines[0].get_data()
    _, rough = bare.lines[0].get_data()
    np.testing.assert_allclose(
        smooth / rough, np.abs(np.sin(np.pi * 0.05 * f) / (np.pi * 0.05 * f)), atol=1e-9
    )
    assert "patch 0.5 m" in axes.get_title()


def test_forces_stand_below_the_speeds_that_they_are_at():
    """12.5 km/h is not 12 km/h."""
    study = replace(study_of(), force_speeds=(12.5 * KMH,))
    found = {one.name: one for one in figures.drawings(result_of(study))}
    titles = [axes.get_title().partition(",")[0] for axes in found["axle_forces"].draw().axes]
    assert titles == ["12.5 km/h", "15 km/h"]
