"""Words of pages and of study keys are words, or stand in a list of those that we use besides."""

import re
from pathlib import Path

import pytest

from trundle.study_file.sections import KINDS

spellchecker = pytest.importorskip("spellchecker")

ROOT = Path(__file__).parents[2]
OURS = set(Path(__file__).with_name("words.txt").read_text("utf-8").split())
PAGES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md")]
PAGES += [
    page
    for page in sorted((ROOT / "docs").glob("**/*.md"))
    if "generated" not in page.parts and page.name != "validation.md"  # names of files and tests
]


@pytest.fixture(scope="module")
def known():
    return spellchecker.SpellChecker()


def words_of(text):
    """Return the words of a page without code, formulas and addresses; names are left out."""
    plain = re.sub(
        r"```.*?```|`[^`]*`|\$\$.*?\$\$|\$[^$]*\$|\]\([^)]*\)|https?:\S+",
        " ",
        text,
        flags=re.DOTALL,
    )
    return set(re.findall(r"(?<![\w.-])[a-z]{4,}(?![\w-])", plain))


def meanings():
    """Return what all keys of study files mean."""
    waiting = [kind.schema for kind in KINDS]
    while waiting:
        one = waiting.pop()
        for info in getattr(one, "model_fields", {}).values():
            yield info.description or ""
            waiting.append(info.annotation)
        waiting += getattr(one, "__args__", ())


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_words_of_a_page_are_words(page, known):
    assert not known.unknown(words_of(page.read_text("utf-8"))) - OURS


def test_words_of_study_keys_are_words(known):
    assert not known.unknown(words_of(" ".join(meanings()))) - OURS


def test_a_slip_would_be_seen(known):
    assert known.unknown(words_of("the vehicel and `itss` roadd")) == {"vehicel", "roadd"}
