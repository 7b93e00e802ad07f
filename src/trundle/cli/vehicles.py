"""Offer the commands that list ready vehicles and show one of them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from trundle.cli import options

__all__ = ["vehicles"]

vehicles = typer.Typer(
    invoke_without_command=True, help="List the ready vehicles, or show one of them."
)


@vehicles.callback()
def listed(context: typer.Context, *, as_json: options.Json = False) -> None:
    """List the ready vehicles with loads, frequencies, source and confidence; or show one.

    A name with _worn has worn dampers, one with _laden its payload.
    """
    context.obj = as_json  # for what follows, where it may stand too
    if context.invoked_subcommand is None:
        from trundle.cli import vehicles_command

        vehicles_command.list_all(as_json=as_json)


@vehicles.command()
def show(
    context: typer.Context,
    name: Annotated[str, typer.Argument(help="Its name, as 'trundle vehicles' lists it.")],
    *,
    speed: Annotated[
        str, typer.Option("--speed", help="At which its forces on a class A road are drawn.")
    ] = "15 km/h",
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Picture (.png, .svg). \\[default: NAME.png]")
    ] = None,
    as_json: options.Json = False,
) -> None:
    """Show a vehicle: a drawing to scale with loads, its modes, its forces on a class A road.

    Prints its numbers and where they come from, and writes a picture.
    """
    from trundle.cli import vehicles_command

    vehicles_command.show(
        name, speed=speed, out=out or Path(f"{name}.png"), as_json=as_json or bool(context.obj)
    )
