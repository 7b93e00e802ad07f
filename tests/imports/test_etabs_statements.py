"""Statements of ETABS text: words, keys in pairs, and where they stand."""

import pytest

from trundle.errors import InputError
from trundle.imports.etabs_statements import HOLDS_NOTHING, number_of, statements_of


def statements(tmp_path, text):
    path = tmp_path / "b.e2k"
    path.write_text(text, encoding="utf-8")
    return statements_of(path)


def test_words_in_quotes_are_one_and_sections_are_titles(tmp_path):
    """A name with blanks and a dollar in it stays whole; the title above says where it is."""
    text = '$ STORIES - IN SEQUENCE FROM TOP\n  STORY "EG <Süd>"  HEIGHT 3.5\n\n$ Points\nPOINT "1" 0 0\n'
    story, point = statements(tmp_path, text)
    assert story.section == "STORIES - IN SEQUENCE FROM TOP"
    assert story.words == ("STORY", "EG <Süd>", "HEIGHT", "3.5")
    assert (point.section, point.place) == ("POINTS", "b.e2k, line 5")
    assert story.keys(2) == {"HEIGHT": "3.5"}


def test_an_empty_word_is_a_word(tmp_path):
    """``""`` is a value that says nothing: what follows does not slip into its place."""
    (one,) = statements(tmp_path, 'LINE "B1" BEAM "" "2" 0\n')
    assert one.words == ("LINE", "B1", "BEAM", "", "2", "0")
    assert one.word(4) == "2"
    with pytest.raises(InputError, match="line 1: LINE ends too early"):
        one.word(6)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('FRAMESECTION "C" D 0.4 B', "must be keys with values, each once"),
        ('FRAMESECTION "C" D 0.4 D 0.5', "must be keys with values, each once"),
        ('FRAMESECTION "C" D 0.4 d 0.5', "must be keys with values, each once"),
        ('FRAMESECTION "C" D 0.4 TAPER 2', "TAPER of a FRAMESECTION is not read"),
    ],
)
def test_keys_that_are_not_whole_or_not_known_are_told(tmp_path, line, said):
    """A value too few would shift all that follow; a key that nobody reads may change the model."""
    (one,) = statements(tmp_path, line)
    with pytest.raises(InputError, match=f"b.e2k, line 1: {said}"):
        one.keys(2, "D|B")


@pytest.mark.parametrize("text", ["inf", "nan", "1e999", "4,5", "", "x"])
def test_what_is_no_number_is_told(tmp_path, text):
    """With the line of its statement."""
    (one,) = statements(tmp_path, 'POINT "1" 0 0\n')
    with pytest.raises(InputError, match=r"b.e2k, line 1: must be a number"):
        number_of(one, text)
    assert number_of(one, "-4.5E-3") == -0.0045


def test_what_makes_the_structure_is_never_passed_over():
    """Statements of parts, sections, supports and masses are none of those that hold nothing."""
    for word in (
        "STORY", "DIAPHRAGM", "MATERIAL", "FRAMESECTION", "SHELLPROP", "POINT", "LINE", "AREA",
        "POINTASSIGN", "LINEASSIGN", "AREAASSIGN", "POINTSPRING", "MASSSOURCE", "UNITS", "CONTROLS",
    ):  # fmt: skip
        assert not HOLDS_NOTHING.match(word), word
    for word in ("LOADPATTERN", "COMBO", "POINTLOAD", "CONCRETEDESIGN", "ENDOFFILE"):
        assert HOLDS_NOTHING.match(word), word
