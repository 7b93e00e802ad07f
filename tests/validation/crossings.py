"""Drive over simple beams and plates with the project's own elements and solver."""

import numpy as np

from trundle.road import Profile
from trundle.route import Ramp, Route
from trundle.simulate import Crossing, Modal, ModalRatio, ensemble
from trundle.structure import FloorPlan, Material, ShellSection, build_floor

UNDAMPED = ModalRatio(ratio=0.0)
G = 9.81
V2_BEAM = {"length": 25.0, "rigidity": 3.5e10 * 1.3901, "line_mass": 18358.0}
V2_F1 = 25.7078 / (2 * np.pi)


def cross(
    floor, length, vehicle, method, *, duration, speed=None, law=None, road=None, y=0.0, point=None
):
    """Drive along x from rest at x = 0 and return the runs at midspan."""
    route = Route.straight((0, y), (length, y), speed=speed or 1.0)
    if law is not None:
        route = Route(points=route.points, law=law)
    # a ramp so short that it ends before the first step; at the support it does no work anyway
    crossing = Crossing(
        vehicle=vehicle, route=route, road=road or Profile.smooth(),
        entry=Ramp(length=1e-9 * length), run_in=0.0,
    )  # fmt: skip
    return ensemble(
        floor, crossing, method=method, points={"mid": point or (length / 2, y)}, n_runs=1, seed=0,
        duration=duration,
    )  # fmt: skip


def undamped(kind, *, f_max, dt, residual=True):
    return kind(integration=Modal(f_max=f_max, dt=dt, residual=residual), damping=UNDAMPED)


def kirchhoff_plate(
    *, length, width, thickness, mesh, modulus=30e9, nu=0.2, density=2500.0, thinner=20.0
):
    """A simply supported plate that is thin to the shell element as well.

    Bending stiffness and mass are those of the thickness given; the section is so many times
    thinner, with modulus and density to match, so that shear and rotary inertia vanish as
    Kirchhoff's theory has it.
    """  # fmt: skip
    material = Material(
        elastic_modulus=modulus * thinner**3, poisson_ratio=nu, density=density * thinner
    )
    edges = dict.fromkeys(("x_min", "x_max", "y_min", "y_max"), "pinned")
    plan = FloorPlan(
        x_lines=np.array([0.0, length]), y_lines=np.array([0.0, width]), x_extent=(0.0, length),
        y_extent=(0.0, width), material=material, edges=edges,
        slab=ShellSection(thickness=thickness / thinner, material=material),
    )  # fmt: skip
    return build_floor(plan, mesh_size=mesh)
