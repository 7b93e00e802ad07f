"""Whatever is wrong with a value, the message is this program's own."""

import random

import pytest

from studies import GOOD
from trundle.errors import InputError
from trundle.study_file.build import load_study

WRONG = [
    ("runs = 2", "runs = 2.5", "must be a whole number"),
    ("runs = 2", 'runs = "two"', "must be a whole number"),
    ("runs = 2", "runs = true", "must be a whole number"),
    ("runs = 2", "runs = 0", r"must be (1 or more|greater than 0)"),
    ("seed = 1", "seed = -3", "must be 0 or more"),
    ('class = "B"', "class = 2", "must be"),
    ('name = "tool"', "name = 7", "must be text, in quotes"),
    ('at = ["3 m", "3 m"]', 'at = ["3 m"]', "this is required"),
    ('at = ["3 m", "3 m"]', 'at = "3 m"', "must"),
    ('damping = { ratio = "3 %" }', "damping = 3", "must be a table of keys"),
    ('curves = ["VC-A"]', 'curves = "VC-A"', "must be a list"),
    ("[floor]", "[[floor]]", "must"),
]
STRANGE = (
    "true",
    "[]",
    "{}",
    "[1]",
    '"x"',
    "1.5",
    "-1",
    "1e400",
    "2020-01-01",
    "{ a = 1 }",
    "[[]]",
)
FOREIGN = (
    "Input should",
    "validation error",
    "pydantic",
    "valid string",
    "valid integer",
    "Field required",
)


@pytest.mark.parametrize(("old", "new", "told"), WRONG)
def test_the_rule_is_said_in_words(tmp_path, old, new, told):
    assert old in GOOD
    (tmp_path / "s.toml").write_text(GOOD.replace(old, new))
    with pytest.raises(InputError, match=told):
        load_study(tmp_path / "s.toml")


def refusal(path):
    try:
        load_study(path)
    except InputError as error:
        return str(error)
    return ""


def test_no_words_of_a_validation_library_come_through(tmp_path):
    """300 keys given a value of another kind, seeded."""
    rng, lines = random.Random(3), GOOD.splitlines()
    keys = [i for i, line in enumerate(lines) if " = " in line]
    for _ in range(300):
        spoiled, i = list(lines), rng.choice(keys)
        spoiled[i] = f"{lines[i].partition(' = ')[0]} = {rng.choice(STRANGE)}"
        (tmp_path / "s.toml").write_text("\n".join(spoiled))
        told = refusal(tmp_path / "s.toml")
        assert not [word for word in FOREIGN if word in told], told
