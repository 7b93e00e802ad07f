"""List the ready vehicles, and show one of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from trundle.cli.aside import check_file, written_aside
from trundle.cli.quantities import quantity_of
from trundle.cli.saying import say
from trundle.cli.screen import print_table
from trundle.cli.show import say_json
from trundle.errors import InputError
from trundle.vehicle import GRAVITY, VEHICLES, Description, Vehicle, describe

__all__ = ["list_all", "show"]

_SUFFIXES = {".png", ".svg", ".pdf"}
_FIRST = 3  # frequencies in the list


def list_all(*, as_json: bool = False) -> None:
    """Print the ready vehicles, a line each."""
    if as_json:
        say_json([_described(name, build()) for name, build in VEHICLES.items()])
        return
    made = {name: build() for name, build in VEHICLES.items()}
    print_table(
        "Ready vehicles",
        ("name", "what", "mass [t]", "axles [m behind the front]", "loads [t]", "f [Hz]", "trust"),
        (
            (
                name,
                vehicle.name,
                f"{vehicle.total_mass / 1e3:.2f}",
                ", ".join(f"{x:.4g}" for x in vehicle.setback),
                ", ".join(f"{f / GRAVITY / 1e3:.2f}" for f in vehicle.static_forces),
                ", ".join(f"{f:.2f}" for f in vehicle.natural_frequencies()[:_FIRST]),
                vehicle.confidence,
            )
            for name, vehicle in made.items()
        ),
        text_columns=2,
    )
    say(
        "trust: high: read in the source; medium: inferred or quoted in part; low: mostly assumed\n"
        "'trundle vehicles show NAME' tells sources and assumptions, and draws one\n"
    )
    for source in dict.fromkeys(vehicle.source for vehicle in made.values()):
        say(f"source: {source}")


def show(name: str, *, speed: str, out: Path, as_json: bool = False) -> None:
    """Print a vehicle's numbers and sources, and write a picture of it."""
    check_file("--out", out, _SUFFIXES)
    driven = quantity_of("--speed", speed, "speed")
    if not 0.1 <= driven <= 60.0:
        raise InputError(f"--speed {speed!r}: must be 0.36 to 216 km/h")
    described = describe(name)
    vehicle = described.build()
    _draw(described, vehicle, driven, out)
    if as_json:
        say_json(_described(name, vehicle))
        return
    _print(name, vehicle)
    say(f"picture: {out}")


def _draw(described: Description, vehicle: Vehicle, speed: float, out: Path) -> None:
    from matplotlib import rc_context

    from trundle.report.canvas import STYLE
    from trundle.report.figures.vehicle_sheet import vehicle_sheet

    with written_aside("--out", out) as aside, rc_context(STYLE):
        vehicle_sheet(described, vehicle, speed).savefig(aside, dpi=200)


def _print(name: str, vehicle: Vehicle) -> None:
    print_table(
        f"{name}: {vehicle.name}, {vehicle.total_mass / 1e3:.2f} t",
        ("contact", "behind front [m]", "static load [t]", "k [MN/m]", "c [kN s/m]"),
        (
            (
                contact,
                f"{vehicle.setback[i]:.2f}",
                f"{vehicle.static_forces[i] / GRAVITY / 1e3:.2f}",
                f"{vehicle.contact_stiffness[i] / 1e6:.4g}",
                f"{vehicle.contact_damping[i] / 1e3:.4g}",
            )
            for i, contact in enumerate(vehicle.contact_names)
        ),
    )
    frequencies = ", ".join(f"{f:.2f}" for f in vehicle.natural_frequencies())
    say(f"natural frequencies on rigid ground: {frequencies} Hz")
    say(f"source: {vehicle.source}")
    say(f"confidence: {vehicle.confidence}")
    if vehicle.assumption:
        say(f"assumed: {vehicle.assumption}")


def _described(name: str, vehicle: Vehicle) -> dict[str, Any]:
    """Return what is told of one vehicle, for programs."""
    return {
        "name": name,
        "title": vehicle.name,
        "mass_kg": vehicle.total_mass,
        "contacts": list(vehicle.contact_names),
        "setback_m": vehicle.setback.tolist(),
        "static_loads_n": vehicle.static_forces.tolist(),
        "contact_stiffness_n_m": vehicle.contact_stiffness.tolist(),
        "contact_damping_n_s_m": vehicle.contact_damping.tolist(),
        "contact_patch_m": vehicle.contact_patch,
        "natural_frequencies_hz": [float(f) for f in vehicle.natural_frequencies()],
        "source": vehicle.source,
        "confidence": vehicle.confidence,
        "assumption": vehicle.assumption,
    }
