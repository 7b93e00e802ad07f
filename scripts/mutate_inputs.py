"""Spoil records, models and studies in seeded ways, and see that each is refused by name or read.

Usage: python scripts/mutate_inputs.py [--records N] [--studies N] [--run-every N] [--seed N]

300 records and models of each format and 700 studies unless told otherwise. Every tenth study that
the check accepts is run too. Nothing may end in a traceback or a warning of Python's, execute
anything, take more than 60 s or 4 GB. Exit code 0 if all is well, 1 if not.
"""

from __future__ import annotations

import argparse
import io
import os
import pickle
import random
import re
import resource
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from scipy.io import wavfile

from trundle.criteria import VC
from trundle.errors import StudyError, TrundleError
from trundle.imports import read_model
from trundle.records import RecordOptions, read_record
from trundle.records.assess import assess_record
from trundle.run.whole_study import run_study
from trundle.structure import self_weight_deflection
from trundle.study_file.build import load_study

ROOT = Path(__file__).resolve().parent.parent
SECONDS, BYTES = 60, 4_000_000_000
FS, N = 400.0, 4000
NUMBERS = (
    "0", "-1", "1e400", "nan", "inf", "-0.0", "1e-300", "9**9**9", "1e22", "0x10", "''", "true",
    "[]", "{}", "[1, 2]", '"9**9**9 m"', '"1 parsec"', '"-5 km/h"', '"1e30 m"', '"é"',
    '"\\u001b[31m"',
)  # fmt: skip


class Payload:
    """What runs a command when it is unpickled."""

    def __init__(self, trace: Path) -> None:
        self.trace = trace

    def __reduce__(self) -> tuple[Callable[[str], int], tuple[str]]:
        return os.system, (f"touch {self.trace}",)


def motion() -> np.ndarray:
    """Return ten seconds of a burst [m/s2]."""
    t = np.arange(N) / FS
    return 1e-3 * np.sin(2 * np.pi * 10 * t) * np.exp(-(((t - 5.0) / 1.5) ** 2))


def sound_records(folder: Path) -> dict[str, bytes]:
    """Return a sound record of each format."""
    z, t = motion(), np.arange(N) / FS
    rows = "".join(f"{a:.4f},{b:.9g},{2 * b:.9g}\n" for a, b in zip(t, z, strict=True))
    file = io.BytesIO()
    wavfile.write(file, int(FS), z.astype(np.float32))
    found = {
        "csv": ("Sample rate: 400 Hz\ntime [s],x [m/s2],z [m/s2]\n" + rows).encode(),
        "wav": file.getvalue(),
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import obspy  # noqa: PLC0415 - of the development set-up
        import pyuff  # noqa: PLC0415

        file = io.BytesIO()
        header = {"station": "FLOOR", "channel": "HHZ", "sampling_rate": FS}
        obspy.Stream([obspy.Trace(data=z, header=header)]).write(file, format="MSEED")
        found["mseed"] = file.getvalue()
        none = dict.fromkeys(("id2", "id3", "id4", "id5"), "")
        none |= dict.fromkeys(("orddenom_axis_units_lab", "z_axis_axis_units_lab"), "NONE")
        data = pyuff.prepare_58(
            func_type=1, rsp_node=1, rsp_dir=3, ref_node=1, ref_dir=3, data=z, x=t, id1="z",
            ordinate_spec_data_type=12, abscissa_spec_data_type=17, orddenom_spec_data_type=0,
            z_axis_spec_data_type=0, z_axis_value=0.0, abscissa_spacing=1, abscissa_min=0.0,
            abscissa_inc=1 / FS, binary=0, ordinate_axis_units_lab="m/s2", ver_num=0,
            abscissa_axis_units_lab="s", load_case_id=0, rsp_ent_name="NONE", ref_ent_name="NONE",
            ord_data_type=4, **none,
        )  # fmt: skip
        pyuff.UFF(str(folder / "sound.uff")).write_sets(data, "overwrite")
        found["uff"] = (folder / "sound.uff").read_bytes()
    return found


def spoiled_record(data: bytes, rng: random.Random, trace: Path) -> bytes:
    """Spoil a record: flip, cut, double or insert bytes and lines, or put a pickle in."""
    n = len(data)
    head = min(n, 600)
    at = rng.randrange(head if rng.random() < 0.7 else n)
    noise = bytes(rng.randrange(256) for _ in range(rng.randrange(1, 9)))
    ways: tuple[Callable[[], bytes], ...] = (
        lambda: data[: rng.randrange(n)],
        lambda: data[:at] + noise + data[at:],
        lambda: _flipped(data, head, rng),
        lambda: data[:at] + data[at + rng.randrange(1, 4000) :],
        lambda: data[:at] + data[at : at + 3000] + data[at:],
        lambda: pickle.dumps(Payload(trace), protocol=rng.randrange(6)) + data,
        lambda: _other_lines(data, rng),
        lambda: re.sub(rb"\d+", lambda _: rng.choice([b"0", b"-1", b"999999999"]), data, count=3),
    )
    return rng.choice(ways)()


def _flipped(data: bytes, head: int, rng: random.Random) -> bytes:
    out = bytearray(data)
    for _ in range(rng.randrange(1, 40)):
        out[rng.randrange(head)] = rng.randrange(256)
    return bytes(out)


def _other_lines(data: bytes, rng: random.Random) -> bytes:
    lines = data.split(b"\n")
    if rng.random() < 0.2:
        rng.shuffle(lines)
    else:
        odd = rng.choice([b"nan,inf", b"-1", b"\x00", b"1e999,1e999,1e999"])
        lines.insert(rng.randrange(len(lines)), odd)
    return b"\n".join(lines)


def spoiled_study(text: str, rng: random.Random) -> str:
    """Spoil a study: another value, a lost or doubled line, a renamed key, a cut or odd bytes."""
    lines = text.splitlines()
    values = [i for i, line in enumerate(lines) if "=" in line and not line.startswith("#")]
    for _ in range(rng.choice([1, 1, 2, 3])):
        i, way = rng.choice(values), rng.choice([0, 1, 2, 3, 3, 3, 3, 4, 5])
        key, _, value = lines[i].partition("=")
        if way == 0:
            lines[i] = f"{key}= {rng.choice(NUMBERS)}"
        elif way == 1:
            lines[i] = ""
        elif way == 2:
            lines[i] = f"{rng.choice(['rode', 'kind', key.strip()[::-1] or 'x'])} ={value}"
        elif way == 3:
            scale = rng.choice(["1e9", "1e-9", "0", "-3", "1000", "0.1", "2", "0.5", "7"])
            lines[i] = f"{key}={re.sub(r'[0-9.]+', scale, value, count=1)}"
        elif way == 4:
            lines.insert(i, rng.choice(["[floor]", "[[route]]", "[x", "a = ", lines[i], "\x00"]))
        else:
            lines[i] = lines[i][: rng.randrange(len(lines[i]) + 1)]
    return "\n".join(lines)


class TooLongError(Exception):
    """A file took more than a minute."""


def _ring(*_: object) -> None:
    raise TooLongError


def attempt(work: Callable[[], object]) -> str:
    """Do something; return how it ended: ``right``, ``refused``, or the fault."""
    signal.alarm(SECONDS)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            work()
    except TrundleError as error:
        return "refused" if str(error).strip() else "refused without a word"
    except TooLongError:
        return f"more than {SECONDS} s"
    except MemoryError:
        return "out of memory"
    except BaseException as error:  # whatever it is, it is what is looked for
        return "".join(traceback.format_exception_only(error)).strip() + _place(error)
    finally:
        signal.alarm(0)
    return "right"


def _place(error: BaseException) -> str:
    last = traceback.extract_tb(error.__traceback__)[-1]
    return f" at {Path(last.filename).name}:{last.lineno}"


def records(folder: Path, n: int, seed: int) -> Iterator[tuple[str, str]]:
    """Give format and outcome of every spoiled record."""
    trace = folder / "trace"
    for kind, data in sound_records(folder).items():
        path = folder / f"record.{kind}"
        path.write_bytes(data)
        options = RecordOptions(unit="" if kind in {"csv", "uff"} else "m/s2")
        assert attempt(lambda p=path, o=options: assess_record(read_record(p, o), VC)) == "right"
        for number in range(n):
            rng = random.Random(f"{seed} {kind} {number}")
            path.write_bytes(spoiled_record(data, rng, trace))
            ended = attempt(lambda p=path, o=options: assess_record(read_record(p, o), VC))
            yield f"{kind} {number}", "executed" if trace.exists() else ended
            trace.unlink(missing_ok=True)


def models(folder: Path, n: int, seed: int) -> Iterator[tuple[str, str]]:
    """Give format and outcome of every spoiled model; one with problems is refused."""

    def use() -> None:
        """Read a model, and let it sink under its weight."""
        found = read_model(path)
        if found.problems:
            raise StudyError(path.name, list(found.problems))
        self_weight_deflection(found.structure)

    path, trace = folder / "model.bdf", folder / "trace"
    data = (ROOT / "scripts" / "small_model.bdf").read_bytes()
    path.write_bytes(data)
    assert attempt(use) == "right"
    for number in range(n):
        path.write_bytes(spoiled_record(data, random.Random(f"{seed} bdf {number}"), trace))
        ended = attempt(use)
        yield f"bdf {number}", "executed" if trace.exists() else ended
        trace.unlink(missing_ok=True)


def studies(folder: Path, n: int, seed: int, run_every: int) -> Iterator[tuple[str, str]]:
    """Give number and outcome of every spoiled study."""
    text = (ROOT / "scripts" / "small_study.toml").read_text("utf-8")
    path, accepted = folder / "study.toml", 0
    path.write_text(text, encoding="utf-8")
    assert attempt(lambda: load_study(path)) == "right"
    for number in range(n):
        rng = random.Random(f"{seed} study {number}")
        path.write_text(spoiled_study(text, rng), encoding="utf-8")
        ended = attempt(lambda: load_study(path))
        if ended == "right":
            accepted += 1
            if accepted % run_every == 0:
                ended = attempt(lambda: run_study(load_study(path)))
                ended = "run" if ended == "right" else ended
        yield f"study {number}", ended


def main() -> int:
    """Read the command line, spoil and try."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    for name, usual in (("records", 300), ("studies", 700), ("run-every", 10), ("seed", 1)):
        parser.add_argument(f"--{name}", type=int, default=usual)
    asked = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (2 * BYTES, 2 * BYTES))  # of addresses, not of memory
    signal.signal(signal.SIGALRM, _ring)
    os.environ["TRUNDLE_CACHE"] = ""
    start, counts, faults = time.monotonic(), Counter[str](), 0
    with tempfile.TemporaryDirectory(prefix="trundle-spoiled-") as name:
        folder = Path(name)
        both = (
            records(folder, asked.records, asked.seed),
            models(folder, asked.records, asked.seed),
            studies(folder, asked.studies, asked.seed, asked.run_every),
        )
        for what, ended in (one for part in both for one in part):
            counts[f"{what.partition(' ')[0]} {ended}" if ended in KNOWN else "faults"] += 1
            if ended not in KNOWN:
                faults += 1
                print(f"{what}: {ended}", flush=True)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(", ".join(f"{count} {name}" for name, count in sorted(counts.items())))
    print(f"{time.monotonic() - start:.0f} s, at most {peak / 1e9:.2g} GB")
    return 1 if faults or peak > BYTES else 0


KNOWN = {"right", "refused", "run"}

if __name__ == "__main__":
    sys.exit(main())
