"""Run a study from Python, read its results back, and see what a slower truck would change."""

from pathlib import Path

import trundle as tr


def main(folder: Path) -> list[str]:
    """Run the study beside this file into a folder, and return the verdicts in words."""
    study = tr.load_study(Path(__file__).with_name("study.toml"))
    print(study)
    tr.run_study(study, folder)  # results.zarr, report.html, summary.csv, as 'trundle run' does
    result = tr.read_results(folder)
    print(result)
    levels = result.to_xarray()["/band_velocity"].sel(point="tool", road="B")
    print(f"largest level at the tool: {1e6 * float(levels.max()):.0f} um/s")
    slower = tr.try_changes(study, [tr.mitigate.Change()], speeds=[10 / 3.6], roads=["B"], runs=20)
    verdicts = [*result.verdicts.values(), *(outcome.verdicts for outcome in slower.outcomes)]
    return [str(verdict) for found in verdicts for verdict in found]


if __name__ == "__main__":
    print("\n".join(main(Path("from-python-results"))))
