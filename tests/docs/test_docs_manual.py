"""The built manual holds all that there is: keys, commands, names, criteria, vehicles, cases.

What must be in it is taken from the code itself, on another way than the pages are made.
"""

import importlib
import pkgutil
import re
from pathlib import Path
from urllib.parse import unquote

import example_runs
import pytest
import typer.main
from pydantic import BaseModel

import trundle
from trundle.cli.app import app
from trundle.criteria import all_criteria
from trundle.study_file.sections import KINDS
from trundle.study_file.sections.general import GeneralSection
from trundle.vehicle import VEHICLES

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.slow
bs4 = pytest.importorskip("bs4")


@pytest.fixture(scope="module")
def page(manual):
    """Read a page by its name, each once."""
    kept = {}

    def read(name):
        if name not in kept:
            text = (manual / f"{name}.html").read_text("utf-8")
            kept[name] = bs4.BeautifulSoup(text, "html.parser").find("article")
        return kept[name]

    return read


def first_cells(article, kind=""):
    """Return the code in the first cell of every row of the page's tables."""
    rows = article.select(f"table{kind} tbody tr")
    return [code.get_text() for row in rows if (code := row.find("td").find("code"))]


def models_in(annotation):
    """Give every table that an annotation holds, however deep."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
        for info in annotation.model_fields.values():
            yield from models_in(info.annotation)
        return
    for inner in getattr(annotation, "__args__", ()):
        yield from models_in(inner)


def keys_of(annotation):
    return {
        info.alias or name
        for model in set(models_in(annotation))
        for name, info in model.model_fields.items()
    }


def test_it_is_built_without_a_warning(manual):
    assert (manual / "index.html").exists()


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_every_key_of_study_files_is_in_it(page, kind):
    article = page(f"generated/keys/{kind.name}")
    shown = first_cells(article, ".keys")
    assert keys_of(kind.schema) <= set(shown)
    assert not set(shown) - keys_of(kind.schema)
    cells = [row.find_all("td") for row in article.select("table.keys tbody tr")]
    assert all(cell[1].get_text().strip() and cell[3].get_text().strip() for cell in cells)
    assert article.find("div", class_="highlight-toml")


def test_the_keys_above_the_first_table_are_in_it(page):
    assert set(first_cells(page("generated/keys/general"), ".keys")) == {
        *GeneralSection.model_fields
    }


def test_every_command_and_option_is_in_it(page):
    root = typer.main.get_command(app)
    groups = {f"{name} {inner}": one for name, group in root.commands.items()
              for inner, one in getattr(group, "commands", {}).items()}  # fmt: skip
    commands = root.commands | groups
    listed = [link.get_text() for link in page("command_line").select("table a")]
    assert {f"trundle {name}" for name in commands} == set(listed)
    for name, command in commands.items():
        article = page(f"generated/commands/{name.replace(' ', '_')}")
        shown = " ".join(code.get_text() for code in article.select("table td:first-child code"))
        wanted = [word for one in command.params for word in one.opts if word.startswith("-")]
        assert set(wanted) <= set(shown.split()), name
        assert article.find(id="examples"), f"trundle {name} has no example"


def test_every_public_name_is_in_it(manual, page):
    names = {
        f"{module.name}.{public}"
        for module in pkgutil.walk_packages(trundle.__path__, "trundle.")
        if not module.name.startswith(("trundle.cli", "trundle.study_file.sections"))
        and module.ispkg
        and not any(part.startswith("_") for part in module.name.split("."))
        for public in getattr(importlib.import_module(module.name), "__all__", ())
        if not hasattr(getattr(importlib.import_module(module.name), public), "__path__")
    }
    assert len(names) > 450
    missing = [
        name
        for name in sorted(names)
        if name.rpartition(".")[2]
        not in first_cells(page(f"generated/api/{name.rpartition('.')[0]}"))
    ]
    assert not missing
    # each is described somewhere, where the search finds it
    text = "".join(
        path.read_text("utf-8") for path in (manual / "generated" / "api").glob("*.html")
    )
    ids = set(re.findall(r'id="(trundle[\w.]*)"', text))
    described = {one.rpartition(".")[2] for one in ids}
    assert not [name for name in names if name.rpartition(".")[2] not in described]


def test_every_criterion_is_in_it(page):
    assert {one.name for one in all_criteria()} <= set(first_cells(page("generated/criteria")))


def test_every_vehicle_is_in_it_with_its_mass_and_source(page):
    article = page("generated/vehicles")
    rows = {
        row.find("code").get_text(): row.get_text(" ")
        for row in article.select("table.wide tbody tr")
    }
    assert set(rows) == set(VEHICLES)
    sources = [item.get_text() for item in article.select("ol li")]
    for name, build in VEHICLES.items():
        made = build()
        assert f"{made.total_mass / 1e3:.2f}" in rows[name]
        number = int(re.search(r"\((\d+)\)\s*$", rows[name].strip())[1])
        assert sources[number - 1].split()[:3] == made.source.replace("*", "").split()[:3]


def test_every_example_is_in_the_gallery(page, manual):
    text = page("generated/gallery").get_text()
    for folder in (ROOT / "examples").iterdir():
        assert f"examples/{folder.name}" in text
    pictures = page("generated/gallery").select("img")
    studies = list((ROOT / "examples").glob("*/study.toml"))
    assert len(pictures) == len(studies) + len(example_runs.QUICK)
    assert text.count("Run by this build") == len(example_runs.QUICK)
    for one in pictures:
        assert (manual / "generated" / one["src"]).resolve().stat().st_size > 5000


def test_links_and_pictures_lead_somewhere(manual):
    pages = {path: path.read_text("utf-8") for path in manual.rglob("*.html")}
    ids = {path: set(re.findall(r'\bid="([^"]+)"', text)) for path, text in pages.items()}
    assert len(pages) > 80
    lost = []
    for path, text in pages.items():
        for link in re.findall(r'(?:href|src)="([^"]+)"', text):
            if re.match(r"[a-z]+:", link):
                continue
            file, _, anchor = unquote(link).partition("#")
            target = (path.parent / file.partition("?")[0]).resolve() if file else path
            if not target.exists() or (anchor and target in ids and anchor not in ids[target]):
                lost.append(f"{path.relative_to(manual)}: {link}")
    assert not lost


def test_nothing_comes_from_another_host(manual):
    """Scripts, styles, fonts and pictures lie beside the pages: they open without a network."""
    fetched = re.compile(
        r"<(?:script|img|iframe|source|object)\b[^>]*\b(?:src|data)=[\"'](?:https?:)?//"
        r"|<link\b[^>]*\bhref=[\"'](?:https?:)?//|url\(\s*[\"']?(?:https?:)?//|@import[^;]*//",
    )
    files = [path for end in ("html", "css", "svg") for path in manual.rglob(f"*.{end}")]
    assert len(files) > 90
    for path in files:
        found = fetched.search(path.read_text("utf-8"))
        assert not found, f"{path.relative_to(manual)}: {found[0]}"
    assert fetched.search('<script src="https://example.org/a.js">')
    assert fetched.search("@font-face { src: url(//example.org/a.woff) }")


def test_the_search_finds_words_of_pages_and_names(manual):
    index = (manual / "searchindex.js").read_text("utf-8")
    for word in ("recept", "tractrix", "slab_thick", "exact_statistics"):  # stems of words
        assert re.search(rf'[,{{"]{word}', index), word
