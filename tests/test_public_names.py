"""The public surface: what each package offers is what it lists, and nothing leaks."""

import importlib
import inspect
import pkgutil

import pytest

import trundle

PACKAGES = (
    "criteria", "dynamics", "errors", "imports", "mitigate", "profiles", "records", "report", "response",
    "results",
    "road", "route", "run", "signals", "simulate", "structure", "study", "study_file", "units",
    "vehicle",
)  # fmt: skip
FUNCTIONS = (
    "assess_record", "list_criteria", "list_vehicles", "load_study", "read_record", "read_results",
    "run_study", "save", "study_from_text", "try_changes", "write_record_report", "write_report",
)  # fmt: skip


def test_the_root_lists_its_packages_and_functions():
    """What scripts may rely on: a name that goes or comes is a decision."""
    assert set(trundle.__all__) == {*PACKAGES, *FUNCTIONS, "__version__"}
    for name in PACKAGES:
        assert getattr(trundle, name).__name__ == f"trundle.{name}"
    for name in FUNCTIONS:
        assert inspect.isfunction(getattr(trundle, name))
        assert getattr(trundle, name).__doc__
    with pytest.raises(AttributeError):
        _ = trundle.nothing


def test_no_function_shadows_its_module():
    """``trundle.x.y`` means one thing, whatever was imported before."""
    modules = {module.name for module in pkgutil.walk_packages(trundle.__path__, "trundle.")}
    for name in ("trundle", *(f"trundle.{package}" for package in PACKAGES)):
        package = importlib.import_module(name)
        functions = [
            public
            for public in getattr(package, "__all__", ())
            if not inspect.ismodule(getattr(package, public))
        ]
        assert not [public for public in functions if f"{name}.{public}" in modules]


@pytest.mark.parametrize("name", PACKAGES)
def test_all_is_sorted_complete_and_documented(name):
    package = importlib.import_module(f"trundle.{name}")
    assert package.__doc__
    for public in package.__all__:
        value = getattr(package, public)
        if inspect.isclass(value) or inspect.isfunction(value):
            assert value.__doc__, f"{name}.{public} has no docstring"


def test_every_module_can_be_imported_by_itself():
    for module in pkgutil.walk_packages(trundle.__path__, "trundle."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
