"""Offer the commands that sum up, hand on, look at and shake a model, whoever made it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from trundle.cli import options

__all__ = ["models"]

models = typer.Typer()

Source = Annotated[
    Path,
    typer.Argument(
        help="Study, model of another program, or results folder.", metavar="STUDY|MODEL|RESULTS"
    ),
]
FMax = Annotated[str, typer.Option("--f-max", help="Highest frequency of modes: '60 Hz'.")]
Case = Annotated[
    str, typer.Option("--case", help="Case that is played back. \\[default: the first]")
]
Road = Annotated[str, typer.Option("--road", help="On which road. \\[default: the first]")]
Method = Annotated[
    str, typer.Option("--method", help="By which method. \\[default: the one assessed]")
]
Units = Annotated[
    str, typer.Option("--units", help="Units of a model that names none: 'kN, m', 'kip, in'.")
]


@models.command()
def model(
    source: Source,
    *,
    kind: Annotated[
        str, typer.Option("--kind", help="nastran, sap2000 ...; else told by it.")
    ] = "",
    units: Units = "",
    ignore: Annotated[
        str, typer.Option("--ignore", help="Cards or tables that are nothing of it, by commas.")
    ] = "",
    as_json: options.Json = False,
) -> None:
    """Sum up a model: units, masses, centre, groups, what can be stood on, first frequencies.

    Nothing of a file is left out in silence: what is not read is told with its line, and nothing is
    computed; what was passed over stands in the summary.
    """
    from trundle.cli import model_command

    model_command.model(source, kind=kind, units=units, ignore=ignore, as_json=as_json)


@models.command()
def export(
    source: Source,
    out: Annotated[
        Path, typer.Argument(help="File to write; its ending says what.", metavar="FILE")
    ],
    *,
    kind: Annotated[
        str, typer.Option("--kind", help="vtu, pvd, gltf, nastran, uff, geojson; else by FILE.")
    ] = "",
    f_max: FMax = "",
    case: Case = "",
    road: Road = "",
    method: Method = "",
    frames: Annotated[int, typer.Option("--frames", min=2, max=5000, help="Of a crossing.")] = 120,
    units: Units = "",
    origin: Annotated[
        str, typer.Option("--origin", help="Longitude, latitude of x = y = 0, for maps.")
    ] = "",
    quiet: options.Quiet = False,
) -> None:
    """Write for other programs: mesh and modes, a crossing, the model, modes alone, maps.

    .vtu mesh with modes, .pvd a crossing in time (ParaView); .glb a scene with animated modes
    (glTF); .bdf the model as Nastran bulk data, to be checked by any other program; .uff modes
    (dataset 55); .geojson the maps of a results folder.
    """
    from trundle.cli import export_command

    wanted = export_command.Wanted(
        f_max=f_max, case=case, road=road, method=method, units=units, origin=origin, frames=frames
    )
    export_command.export_of(source, out, kind=kind, wanted=wanted, quiet=quiet)


@models.command()
def view(
    source: Source,
    *,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Page. \\[default: NAME-view.html]")
    ] = None,
    f_max: FMax = "",
    case: Case = "",
    road: Road = "",
    method: Method = "",
    frames: Annotated[int, typer.Option("--frames", min=2, max=2000, help="Of a crossing.")] = 240,
    no_crossing: Annotated[
        bool, typer.Option("--no-crossing", help="Without a crossing: mesh and modes alone.")
    ] = False,
    units: Units = "",
    quiet: options.Quiet = False,
) -> None:
    """Look at it: one page with the model in 3-D, its modes, and a crossing played back.

    Sections are to scale, storeys and parts can be switched; supports, routes and points are shown;
    the floor moves, larger than it does, while wheels and their forces pass. The page opens without
    a network.
    """
    from trundle.cli import view_command
    from trundle.cli.export_command import Wanted

    wanted = Wanted(f_max=f_max, case=case, road=road, method=method, units=units, frames=frames)
    view_command.view(source, out, wanted=wanted, crossing=not no_crossing, quiet=quiet)


@models.command()
def transfer(
    study: Annotated[Path, typer.Argument(help="Study file (TOML).", metavar="STUDY")],
    *,
    loads: Annotated[
        list[str],
        typer.Option(
            "--from",
            metavar="PLACE",
            help="Where a force acts: a point of the study by its name, or '3 m, 4.5 m' in plan, "
            "'3 m, 4.5 m @ deck' where there are several surfaces. May be given several times.",
        ),
    ],
    points: Annotated[
        list[str] | None,
        typer.Option(
            "--to",
            metavar="PLACE",
            help="Where motion is read, likewise. \\[default: all points of the study]",
        ),
    ] = None,
    method: Annotated[
        str, typer.Option("--method", help="By which method. \\[default: the one assessed]")
    ] = "",
    f_min: Annotated[str, typer.Option("--f-min", help="Lowest frequency.")] = "1 Hz",
    f_max: Annotated[
        str,
        typer.Option("--f-max", help="Highest. \\[default: 80 Hz, or as far as the method shows]"),
    ] = "",
    lines: Annotated[int, typer.Option("--lines", min=2, max=100_000, help="How many.")] = 800,
    quantity: Annotated[
        str, typer.Option("--quantity", help="receptance, mobility or accelerance.")
    ] = "mobility",
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Table to write: FILE.csv.")
    ] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", help="Picture to write: FILE.png, .svg or .pdf.")
    ] = None,
    as_json: options.Json = False,
    quiet: options.Quiet = False,
) -> None:
    """Say what a force at one place does at another: a machine here, a tool there.

    Displacement (receptance), velocity (mobility) or acceleration (accelerance) over force, by the
    modes and the damping of a method of the study. Force and motion are up, or along the axis of a
    point that is read level. The largest peaks of each pair are printed.
    """
    from trundle.cli import transfer_command
    from trundle.cli.show import show_of

    asked = transfer_command.Asked(
        loads=loads,
        points=points or (),
        method=method,
        f_min=f_min,
        f_max=f_max,
        lines=lines,
        quantity=quantity,
        out=out,
        figure=figure,
    )
    transfer_command.transfer(study, asked, show=show_of(as_json=as_json, quiet=quiet))
