"""What the theory manual points at is there: pages, modules, tests, cases of validation."""

import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [*sorted((DOCS / "theory").glob("*.md")), *sorted((DOCS / "tutorials").glob("*.md"))]
LINK = re.compile(r"\[([^\]]*)\]\(([^)#]+)(?:#[^)]*)?\)")
NAMES = re.compile(r"`(trundle(?:\.\w+)+)`((?:[,:;]?(?:\s+and)?\s+`[\w.]+`)*)")
TESTS = re.compile(r"`(tests/[\w/.]+)`")


def is_there(name):
    """Return whether a dotted name is a module, or a name in one."""
    try:
        if importlib.util.find_spec(name) is not None:
            return True
        module, _, last = name.rpartition(".")
        return hasattr(importlib.import_module(module), last)
    except ImportError:
        return False


@pytest.mark.parametrize("page", PAGES, ids=lambda page: f"{page.parent.name}/{page.stem}")
def test_links_lead_to_pages(page):
    """Every relative link leads to a file of the documentation."""
    for words, target in LINK.findall(page.read_text("utf-8")):
        if "://" not in target:
            assert (page.parent / target).resolve().is_file(), f"[{words}]({target})"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: f"{page.parent.name}/{page.stem}")
def test_cases_of_validation_that_pages_name_are_in_it(page):
    """A link to the page of validation is named by one of its headings, or by nothing of them."""
    headings = re.findall(r"^## (.*)$", (DOCS / "validation.md").read_text("utf-8"), re.MULTILINE)
    for words, target in LINK.findall(page.read_text("utf-8")):
        name = " ".join(words.split())
        if target.endswith("validation.md") and name.lower() != "validation":
            assert name in headings, name


@pytest.mark.parametrize("page", PAGES, ids=lambda page: f"{page.parent.name}/{page.stem}")
def test_modules_and_tests_that_pages_name_are_there(page):
    """Names behind a module's are of that module or beside it: ``trundle.road``: ``iso8608``."""
    text = page.read_text("utf-8")
    for first, more in NAMES.findall(text):
        module = first
        for name in (first, *re.findall(r"`([\w.]+)`", more)):
            if name.startswith("trundle."):
                module = name
                assert is_there(name), name
            else:
                where = (module, module.rpartition(".")[0], "trundle")
                assert any(is_there(f"{under}.{name}") for under in where), f"{module}, {name}"
    for path in TESTS.findall(text):
        assert (ROOT / path).exists(), path
