"""Offer trundle on the command line; every command is a few lines over study and report."""

from __future__ import annotations

import io
import sys
from pathlib import Path
from typing import Annotated

import typer

from trundle import __version__
from trundle.cli import options
from trundle.cli.interrupts import listen
from trundle.cli.models import models
from trundle.cli.reports import reports
from trundle.cli.saying import say
from trundle.cli.vehicles import vehicles
from trundle.cli.walking import walking
from trundle.errors import ComputationError, InputError

__all__ = ["app", "main"]

BAD_INPUT, FAILED, NOT_MET, INTERRUPTED = 2, 1, 3, 130
"""Exit codes: input that breaks a rule, mathematics that failed, --fail-on, Ctrl-C."""

app = typer.Typer(
    name="trundle",
    help="From a vehicle on a rough road to a vibration class on the floor plan.\n\n"
    "Start with 'trundle new unit.toml', look it over with 'trundle check unit.toml', and run "
    "it with 'trundle run unit.toml': tables on the screen, and a results folder with "
    "report.html, results.zarr, summary.csv and figures.",
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

StudyPath = Annotated[Path, typer.Argument(help="Study file (TOML).", metavar="STUDY")]


def _show_version(wanted: bool) -> None:
    if wanted:
        say(f"trundle {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show version.")
    ] = False,
) -> None:
    del version


@app.command()
def run(
    study: StudyPath,
    *,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Results folder. \\[default: STUDY's name + '-results']"),
    ] = None,
    workers: options.Workers = None,
    scheduler: options.Scheduler = None,
    fresh: options.Fresh = False,
    yes: options.Yes = False,
    as_json: options.Json = False,
    quiet: options.Quiet = False,
    fail_on: options.FailOn = None,
) -> None:
    """Run a study: progress bars, tables on the screen, a results folder with report.html.

    The folder appears only when everything is done. A run that is stopped, by Ctrl-C or a power
    cut, keeps what it finished beside it; the same command goes on from there and ends with the
    same numbers, to the last bit.
    """
    from trundle.cli import run_command
    from trundle.cli.show import show_of

    place = out or Path(f"{study.stem}-results")
    unmet = run_command.run(
        study,
        place,
        workers=workers,
        scheduler=scheduler,
        fresh=fresh,
        yes=yes,
        show=show_of(as_json=as_json, quiet=quiet),
        fail_on=fail_on or (),
    )
    if unmet:
        raise typer.Exit(NOT_MET)


@app.command()
def assess(
    files: options.Records,
    *,
    unit: options.Unit = "",
    rate: options.Rate = "",
    sensitivity: options.Sensitivity = "",
    full_scale: options.FullScale = "",
    channel: options.Channel = "",
    start: options.Start = "",
    criteria: options.Criteria = "",
    shape: options.Shape = "rising",
    averaging: options.Averaging = "max_1s",
    high_pass: options.HighPass = "0.5 Hz",  # noqa: S107 - a filter, not a password
    events: options.Events = 1.0,
    simulation: options.Simulation = None,
    point: options.Point = None,
    velocity: options.VelocityShown = "um/s",
    acceleration: options.AccelerationShown = "gal",
    out: options.RecordOut = None,
    as_json: options.Json = False,
    quiet: options.Quiet = False,
    fail_on: options.FailOn = None,
) -> None:
    r"""Assess measured records against the same criteria, with the same levels and figures.

    A CSV heading such as 'time \[s], z \[mm/s2]' says all; else --unit and --rate do. A record
    that cannot be right (gaps, numbers missing, two rates) is refused; one that is clipped, short,
    slow or cut off in motion is assessed with a warning.
    """
    from trundle.cli import assess_command
    from trundle.cli.show import show_of
    from trundle.records import RecordOptions

    said = RecordOptions(
        unit=unit,
        rate=rate,
        sensitivity=sensitivity,
        full_scale=full_scale,
        channel=channel,
        start=start,
    )
    unmet = assess_command.assess(
        files,
        said,
        criteria=criteria,
        shape=shape,
        averaging=averaging,
        high_pass=high_pass,
        events=events,
        simulation=simulation,
        point=point,
        velocity=velocity,
        acceleration=acceleration,
        out=out,
        show=show_of(as_json=as_json, quiet=quiet),
        fail_on=fail_on or (),
    )
    if unmet:
        raise typer.Exit(NOT_MET)


@app.command()
def mitigate(
    study: StudyPath,
    *,
    speeds: Annotated[
        str, typer.Option("--speeds", help="Speeds of every vehicle, between commas.")
    ] = "5 km/h, 10 km/h, 15 km/h, 20 km/h, 30 km/h, 40 km/h",
    roads: Annotated[str, typer.Option("--roads", help="Road classes.")] = "A,B,C,D",
    vehicle: Annotated[
        str, typer.Option("--vehicle", help="Other vehicles; 'trundle vehicles' lists them.")
    ] = "",
    slab: Annotated[str, typer.Option("--slab", help="Other slabs: '0.25 m, 300 mm'.")] = "",
    damping: Annotated[str, typer.Option("--damping", help="Other damping: '2 %, 5 %'.")] = "",
    isolator: Annotated[
        str, typer.Option("--isolator", help="Under every point: '2 Hz / 10 %, 1 Hz / 5 %'.")
    ] = "",
    combine: Annotated[
        bool, typer.Option("--combine", help="Combine the changes with each other too.")
    ] = False,
    runs: Annotated[int, typer.Option("--runs", min=1, max=10_000, help="Runs of each.")] = 60,
    workers: options.Workers = None,
    scheduler: options.Scheduler = None,
    fresh: options.Fresh = False,
    yes: options.Yes = False,
    as_json: options.Json = False,
    quiet: options.Quiet = False,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Results folder. \\[default: STUDY-mitigation-results]"),
    ] = None,
) -> None:
    """Try what would help: speed, road class, vehicle, slab, damping, isolator.

    Every speed is combined with every road class, for the study as it is and for each change by
    itself, or for changes of all kinds in every combination (--combine): a matrix of the criteria
    met, curves of level against speed, and summary.csv.
    """
    from trundle.cli import mitigate_command
    from trundle.cli.show import show_of

    mitigate_command.mitigate(
        study,
        speeds=speeds,
        roads=roads,
        vehicles=vehicle,
        slabs=slab,
        dampings=damping,
        isolators=isolator,
        combine=combine,
        runs=runs,
        workers=workers,
        scheduler=scheduler,
        fresh=fresh,
        yes=yes,
        show=show_of(as_json=as_json, quiet=quiet),
        out=out or Path(f"{study.stem}-mitigation-results"),
    )


@app.command()
def check(
    study: StudyPath,
    *,
    meshes: Annotated[
        bool,
        typer.Option(
            "--mesh",
            "--meshes",
            help="Compute a few runs on half the mesh size too, and show the change.",
        ),
    ] = False,
    as_json: options.Json = False,
    yes: options.Yes = False,
) -> None:
    """Check a study: every mistake at once with its remedy, or a summary and a plan sketch."""
    from trundle.cli import commands

    if meshes and as_json:
        raise InputError("--meshes prints tables and --json none: give one of them")
    commands.check(study, as_json=as_json)
    if meshes:
        from trundle.cli import meshes_command

        meshes_command.compare(study, yes=yes)


@app.command()
def new(
    path: Annotated[Path, typer.Argument(help="Study file to make.", metavar="STUDY")],
) -> None:
    """Make a commented study file to start from."""
    from trundle.cli import commands

    commands.new(path)


app.add_typer(reports)
app.add_typer(models)
app.add_typer(walking)
app.add_typer(vehicles, name="vehicles")


@app.command()
def modes(
    study: StudyPath,
    *,
    f_max: Annotated[
        str, typer.Option("--f-max", help="Show the modes below this frequency.")
    ] = "10 Hz",
    as_json: options.Json = False,
) -> None:
    """List the natural frequencies of a study's floor, their count proved by inertia."""
    from trundle.cli import commands

    commands.modes(study, f_max, as_json=as_json)


@app.command()
def criteria(*, as_json: options.Json = False) -> None:
    """List the vibration criteria with their limits, range, source and confidence."""
    from trundle.cli import commands

    commands.criteria(as_json=as_json)


def main() -> None:
    """Run the command line; turn errors into messages and exit codes."""
    listen()
    if isinstance(sys.stdout, io.TextIOWrapper):  # a terminal of another alphabet shows a ?
        sys.stdout.reconfigure(errors="replace")
    try:
        app()
    except SystemExit as stop:
        # typer turns an interrupt into its exit code, and says nothing
        if stop.code == INTERRUPTED:
            _say_interrupted()
        raise
    except InputError as error:
        _say_error(error, f"error: {error}")
        sys.exit(BAD_INPUT)
    except ComputationError as error:
        _say_error(error, f"error: the computation failed: {error}")
        sys.exit(FAILED)
    except KeyboardInterrupt:
        _say_interrupted()
        sys.exit(INTERRUPTED)
    except BrokenPipeError:
        sys.exit(FAILED)
    except OSError as error:  # of a file that is named: too long a name, no right to read it
        if error.filename is None:
            raise
        _say_error(error, f"error: {error.filename}: {error.strerror}")
        sys.exit(BAD_INPUT)


def _say_error(error: Exception, words: str) -> None:
    """Print an error in words, and as JSON where that was asked for."""
    if "--json" in sys.argv[1:]:
        from trundle.cli.show import error_as_json

        say(error_as_json(error))
    say(words, error=True)


def _say_interrupted() -> None:
    say(
        "interrupted: no results were written, and earlier ones still stand; the same command goes "
        "on with what was finished",
        error=True,
    )
