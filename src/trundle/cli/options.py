"""Describe the options that say how a measured record is read and held against criteria."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

__all__ = [
    "AccelerationShown",
    "Author",
    "Averaging",
    "Client",
    "Criteria",
    "Date",
    "Events",
    "FailOn",
    "FullScale",
    "HighPass",
    "Job",
    "Json",
    "Point",
    "Quiet",
    "Rate",
    "RecordOut",
    "Records",
    "Revision",
    "Sensitivity",
    "Shape",
    "Simulation",
    "Start",
    "Unit",
    "VelocityShown",
    "Yes",
]

Records = Annotated[
    list[Path], typer.Argument(help="Records: CSV, WAV, UFF 58 or miniSEED.", metavar="RECORD...")
]
Unit = Annotated[
    str, typer.Option("--unit", help="Unit of the samples, if no heading says it: mm/s2, V.")
]
Rate = Annotated[
    str, typer.Option("--rate", help="Sampling rate, if there is no time column: '500 Hz'.")
]
Sensitivity = Annotated[
    str, typer.Option("--sensitivity", help="Of the sensor: '10 V/(m/s2)', '1000 mV/g'.")
]
FullScale = Annotated[
    str, typer.Option("--full-scale", help="What a WAV file's largest number is: '20 m/s2'.")
]
FailOn = Annotated[
    list[str] | None,
    typer.Option(
        "--fail-on",
        metavar="CRITERION",
        help="End with exit code 3 where it is failed or not assessed; may be given several times.",
    ),
]
Client = Annotated[str | None, typer.Option("--client", help="Client, on the report's front.")]
Job = Annotated[str | None, typer.Option("--job", help="Job or its number.")]
Revision = Annotated[str | None, typer.Option("--revision", help="Revision.")]
Date = Annotated[str | None, typer.Option("--date", help="Date, as it is to stand there.")]
Author = Annotated[str | None, typer.Option("--author", help="Who wrote it.")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON instead of tables; mistakes too.")]
Quiet = Annotated[
    bool, typer.Option("--quiet", "-q", help="Print nothing but warnings and errors.")
]
Workers = Annotated[
    int | None,
    typer.Option(
        "--workers", "-w", min=1, help="Compute in so many processes, by dask on this machine."
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option("--scheduler", help="Compute on a running dask cluster: tcp://host:8786."),
]
Fresh = Annotated[
    bool, typer.Option("--fresh", help="Begin anew: leave aside what a stopped run finished.")
]
Yes = Annotated[
    bool,
    typer.Option("--yes", "-y", help="Compute it even if it takes hours, or all the memory."),
]
Channel = Annotated[
    str,
    typer.Option(
        "--channel",
        help="Channels to assess: names, numbers from 1, units or vertical, between commas.",
    ),
]
Start = Annotated[
    str,
    typer.Option("--start", help="Local time of the first sample: '22:30', '2024-05-03 22:30'."),
]
Criteria = Annotated[
    str,
    typer.Option(
        "--criteria",
        "-c",
        help="Names and files (TOML, CSV) between commas. \\[default: workshop to VC-E]",
    ),
]
Shape = Annotated[
    str, typer.Option("--shape", help="Generic curves below 8 Hz: rising, or flat to 1 Hz.")
]
Averaging = Annotated[str, typer.Option("--averaging", help="max_1s, slow, fast or event.")]
HighPass = Annotated[str, typer.Option("--high-pass", help="Motion below this frequency is drift.")]
Events = Annotated[
    float, typer.Option("--events", min=1.0, help="Passages that a vibration dose is for.")
]
Simulation = Annotated[
    Path | None,
    typer.Option("--simulation", help="Results folder of a study, to lay the record over."),
]
Point = Annotated[
    str | None, typer.Option("--point", help="Point of that study. \\[default: its first]")
]
VelocityShown = Annotated[
    str,
    typer.Option(
        "--velocity",
        help="Unit of page, figures and screen: um/s, mm/s, m/s, mil/s or in/s.",
    ),
]
AccelerationShown = Annotated[
    str,
    typer.Option(
        "--acceleration",
        help="Unit of the same: gal, m/s2, mm/s2, mg or in/s2.",
    ),
]
RecordOut = Annotated[
    Path | None,
    typer.Option("--out", "-o", help="Results folder. \\[default: RECORD's name + '-results']"),
]
