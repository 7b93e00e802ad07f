"""The README's example runs and says what the README says."""

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
def test_the_readmes_example(capsys):
    """The share of the verdicts that a reader sees; snapshot of the README's text, by design."""
    path = ROOT / "examples" / "quick_start" / "quick_start.py"
    spec = importlib.util.spec_from_file_location("quick_start", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    verdicts = module.main()
    printed = capsys.readouterr().out
    readme = (ROOT / "README.md").read_text()
    for line in (printed.splitlines()[0], printed.splitlines()[2], *verdicts[:3]):
        assert line in readme
    # class B at 15 km/h: the rear road must fail VC-A by far, as the paper's 109 um/s does
    assert verdicts[4].startswith("tool vertical, VC-A: fail")
