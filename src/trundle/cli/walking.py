"""Offer the command about people who walk on a floor."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from trundle.cli import options

__all__ = ["walking"]

walking = typer.Typer()


@walking.command()
def footfall(
    study: Annotated[Path, typer.Argument(help="Study file (TOML).", metavar="STUDY")],
    *,
    guide: Annotated[
        str, typer.Option("--guide", help="p354, ccip-016, dg11 or iso-10137.")
    ] = "p354",
    pace: Annotated[
        tuple[float, float] | None,
        typer.Option(
            "--pace",
            metavar="LOW HIGH",
            help="Lowest and highest pace, steps a second. \\[default: the guide's]",
        ),
    ] = None,
    spacing: Annotated[
        str, typer.Option("--spacing", help="Of places: '1 m'. \\[default: 300 places a storey]")
    ] = "",
    method: Annotated[
        str, typer.Option("--method", help="Method of the study that gives modes and damping.")
    ] = "",
    excitation: Annotated[
        str,
        typer.Option(
            "--excitation", help="full: the worst walker anywhere; self: where it is felt."
        ),
    ] = "full",
    length: Annotated[
        str, typer.Option("--length", help="Of the path that is walked. \\[default: no end]")
    ] = "",
    passages: Annotated[
        float | None, typer.Option("--passages", help="How many a vibration dose is for.")
    ] = None,
    duration: Annotated[str, typer.Option("--duration", help="Of one of them: '10 s'.")] = "",
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Results folder. \\[default: STUDY's name + '-footfall']"),
    ] = None,
    as_json: options.Json = False,
    quiet: options.Quiet = False,
) -> None:
    """Walk on a study's floor, by a guide: response factors or peak accelerations everywhere.

    From the floor's modes, at every pace that could put a harmonic on one of them: footfall.csv
    with the worst pace, walker and mode of every place, and a map of every storey.
    """
    from trundle.cli import footfall_command
    from trundle.cli.show import show_of

    footfall_command.footfall(
        study,
        out or Path(f"{study.stem}-footfall"),
        options=footfall_command.FootfallOptions(
            guide=guide,
            pace=pace,
            spacing=spacing,
            method=method,
            excitation=excitation,
            length=length,
            passages=passages,
            duration=duration,
        ),
        show=show_of(as_json=as_json, quiet=quiet),
    )
