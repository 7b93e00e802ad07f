"""The README's example runs and says what the README says."""

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def module_of(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_readmes_example_of_a_whole_study(tmp_path, capsys):
    """Every call of the README stands in the example, and says what the README says."""
    path = ROOT / "examples" / "from_python" / "from_python.py"
    verdicts = module_of(path).main(tmp_path / "results")
    readme = (ROOT / "README.md").read_text()
    for line in (*capsys.readouterr().out.splitlines(), *verdicts[:2]):
        assert line in readme
    for call in ("load_study", "run_study", "read_results", "to_xarray", "try_changes"):
        assert f".{call}(" in path.read_text()
        assert f".{call}(" in readme
    # a slower truck on the same road shakes less
    assert [float(v.split("margin ")[1].split()[0]) for v in verdicts[3:]] > [
        float(v.split("margin ")[1].split()[0]) for v in verdicts[:3]
    ]


@pytest.mark.slow
def test_the_readmes_example(capsys):
    """The share of the verdicts that a reader sees; snapshot of the README's text, by design."""
    path = ROOT / "examples" / "quick_start" / "quick_start.py"
    verdicts = module_of(path).main()
    printed = capsys.readouterr().out
    readme = (ROOT / "README.md").read_text()
    for line in (printed.splitlines()[0], printed.splitlines()[2], *verdicts[:3]):
        assert line in readme
    # class B at 15 km/h: the rear road must fail VC-A by far, as the paper's 109 um/s does
    assert verdicts[4].startswith("tool vertical, VC-A: fail")
