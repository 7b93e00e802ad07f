"""The public surface: what each package offers is what it lists, and nothing leaks."""

import importlib
import inspect
import pkgutil

import pytest

import trundle

PACKAGES = (
    "criteria", "dynamics", "errors", "report", "response", "road", "route", "signals", "simulate",
    "structure", "study", "units", "vehicle",
)  # fmt: skip


def test_the_root_lists_its_packages():
    assert set(trundle.__all__) == {*PACKAGES, "__version__"}
    for name in PACKAGES:
        assert getattr(trundle, name).__name__ == f"trundle.{name}"
    with pytest.raises(AttributeError):
        _ = trundle.nothing


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
