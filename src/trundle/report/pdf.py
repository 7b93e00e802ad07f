"""Print a page as a PDF, by a browser that the machine has."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from trundle.errors import ComputationError, InputError

__all__ = ["find_browser", "print_pdf"]

_NAMES = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "microsoft-edge",
    "microsoft-edge-stable",
    "msedge",
    "brave-browser",
)
_PLACES = {
    "darwin": (
        "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
        "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
        "/Applications/Chromium.app/Contents/MacOS/Chromium",
    ),
    "win32": (
        r"Microsoft\Edge\Application\msedge.exe",
        r"Google\Chrome\Application\chrome.exe",
    ),
}
_LONGEST = 180.0  # s


def find_browser() -> str:
    """Return the program that prints: ``TRUNDLE_BROWSER``, Chromium, Chrome or Edge.

    Raises
    ------
    InputError
        There is none.
    """
    chosen = os.environ.get("TRUNDLE_BROWSER", "")
    if chosen:
        found = shutil.which(chosen)
        if found is None:
            raise InputError(f"TRUNDLE_BROWSER={chosen!r}: there is no such program")
        return found
    for name in (*_NAMES, *_places()):
        found = shutil.which(name)
        if found is not None:
            return found
    raise InputError(
        "--pdf needs a browser that prints: install Chromium, Chrome or Edge, or name one by "
        "TRUNDLE_BROWSER; or open the page in any browser, and print it from there"
    )


def _places() -> Iterator[str]:
    """Give where programs are that no path leads to."""
    roots = [os.environ.get(name, "") for name in ("PROGRAMFILES", "PROGRAMFILES(X86)")]
    for place in _PLACES.get(sys.platform, ()):
        if sys.platform == "win32":
            yield from (str(Path(root) / place) for root in roots if root)
        else:
            yield place


def print_pdf(page: Path, target: Path) -> Path:
    """Print a page, as its style says for paper; return the PDF.

    Parameters
    ----------
    page : Path
        An HTML page that holds all it needs: nothing is loaded from anywhere.
    target : Path
        The PDF, which appears when it is whole.

    Raises
    ------
    InputError
        No browser.
    ComputationError
        The browser fails, or takes three minutes.
    """
    browser = find_browser()
    with tempfile.TemporaryDirectory(prefix="trundle-print-", ignore_cleanup_errors=True) as folder:
        written = Path(folder) / "page.pdf"
        command = [browser, *_options(Path(folder)), f"--print-to-pdf={written}", page.as_uri()]
        try:
            done = subprocess.run(  # noqa: S603 - a program that the user has, no shell
                command, capture_output=True, timeout=_LONGEST, check=False
            )
        except (OSError, subprocess.TimeoutExpired) as error:
            raise ComputationError(f"{browser} does not print: {error}") from None
        if done.returncode != 0 or not _is_pdf(written):
            raise ComputationError(
                f"{browser} gave no PDF (exit code {done.returncode}); open {page} in a browser, "
                "and print it from there"
            )
        aside = target.with_name(f".{target.name}.part")
        shutil.copyfile(written, aside)
        aside.replace(target)
    return target


def _options(folder: Path) -> list[str]:
    """Return how a browser prints alone: its own profile, no network, no heading of its own."""
    alone = ["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []
    return [
        "--headless",
        "--disable-gpu",
        "--no-first-run",
        "--disable-extensions",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-sync",
        "--host-resolver-rules=MAP * ~NOTFOUND",
        "--no-pdf-header-footer",
        "--virtual-time-budget=10000",
        f"--user-data-dir={folder / 'profile'}",
        *alone,
    ]


def _is_pdf(file: Path) -> bool:
    try:
        with file.open("rb") as opened:
            return opened.read(5) == b"%PDF-"
    except OSError:
        return False
