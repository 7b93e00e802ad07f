"""[[method]]: steps, damping, contact and entry, and what does not go together."""

import numpy as np
import pytest

from studies import BUILDING, GOOD
from trundle.dynamics import ByMaterial, ModalRatio, Rayleigh
from trundle.errors import StudyError
from trundle.route import DriveIn
from trundle.simulate import Coupled, Decoupled, Modal, Newmark
from trundle.structure import Hat, Hermite
from trundle.study_file import study_from_text

METHOD = {
    "name": '"coupled"',
    "interaction": '"coupled"',
    "f_max": '"30 Hz"',
    "dt": '"5 ms"',
    "damping": '{ ratio = "3 %" }',
}
NEWMARK = {
    "integration": '"newmark"',
    "f_max": None,
    "damping": '{ rayleigh_alpha = "0.8587 1/s", rayleigh_beta = "1 ms" }',
}


def text_of(*methods, more="", study=GOOD):
    """Return a study of methods that are changed by keys; None takes a key out."""
    tables = ""
    for changes in methods:
        keys = {k: v for k, v in {**METHOD, **changes}.items() if v is not None}
        tables += "[[method]]\n" + "".join(f"{k} = {v}\n" for k, v in keys.items())
    start, end = study.index("[[method]]"), study.find("[criteria]")
    return study[:start] + tables + (study[end:] if end > 0 else "") + more


def method(**changes):
    (made,) = study_from_text(text_of(changes)).methods
    return made


def told(*methods, **kwargs):
    with pytest.raises(StudyError) as caught:
        study_from_text(text_of(*methods, **kwargs))
    return {p.place: p for p in caught.value.problems}


def test_a_method_is_modal_smooth_and_drives_in_unless_told_otherwise():
    """As the template says of each key; nothing is single, hat or abrupt by itself."""
    made = method()
    assert isinstance(made.interaction, Coupled)
    assert isinstance(made.interaction.integration, Modal)
    assert isinstance(made.interaction.contact, Hermite)
    assert isinstance(made.entry, DriveIn)
    assert made.band is None
    integration = made.interaction.integration
    assert (integration.f_max, integration.dt, integration.single) == (30.0, 0.005, False)
    assert isinstance(made.interaction.damping, ModalRatio)
    assert made.interaction.damping.ratio == 0.03


def test_every_word_of_a_method_gives_its_own_kind():
    """Two interactions and two contacts are not taken for one another."""
    assert isinstance(method(interaction='"decoupled"').interaction, Decoupled)
    assert isinstance(method(contact='"hat"').interaction.contact, Hat)
    assert method(precision='"single"').interaction.integration.single


@pytest.mark.parametrize(
    ("f_max", "dt"),
    [('"30 Hz"', '"5 ms"'), ('"0.03 kHz"', '"0.005 s"'), ('"1800 rpm"', '"5000 us"')],
)
def test_one_method_in_other_units_is_one_method(f_max, dt):
    """1800 turns a minute are 30 Hz; 5000 us are 5 ms."""
    integration = method(f_max=f_max, dt=dt).interaction.integration
    assert (integration.f_max, integration.dt) == (pytest.approx(30.0), pytest.approx(0.005))


def test_rayleighs_coefficients_are_taken_as_they_are():
    """2 zeta = alpha / omega + beta omega: 3 % at 3.75 Hz and 5.8 Hz, as the remedy promises."""
    made = method(**NEWMARK)
    assert isinstance(made.interaction.integration, Newmark)
    damping = made.interaction.damping
    assert isinstance(damping, Rayleigh)
    omega = 2 * np.pi * np.array([3.75, 5.8])
    np.testing.assert_allclose(
        0.5 * (damping.alpha / omega + damping.beta * omega), 0.03, rtol=2e-2
    )
    assert (damping.alpha, damping.beta) == (0.8587, 0.001)


@pytest.mark.parametrize(
    ("damping", "named"),
    [
        ("{}", "nothing"),
        ('{ rayleigh_alpha = "0.8 1/s" }', "rayleigh_alpha"),
        ('{ rayleigh_beta = "1 ms" }', "rayleigh_beta"),
        ('{ ratio = "3 %", rayleigh_beta = "1 ms" }', "ratio, rayleigh_beta"),
        ("{ by_material = true }", "nothing"),
    ],
)
def test_half_a_damping_is_none(damping, named):
    """One coefficient of two leaves modes nearly undamped: the keys that stand there are told."""
    assert told({"damping": damping})["method[1].damping"].value == named


def test_damping_by_material_takes_the_ratio_of_what_has_none():
    """Concrete is given 2 %, and what has no ratio the 5 % of the method."""
    building = BUILDING.replace(
        'density = "2500 kg/m3"', 'density = "2500 kg/m3"\ndamping_ratio = "2 %"'
    )
    damping = '{ by_material = true, ratio = "5 %" }'
    keys = {"damping": damping, "f_max": '"60 Hz"'}
    made = study_from_text(text_of(keys, study=building)).methods[0].interaction.damping
    assert isinstance(made, ByMaterial)
    assert made.other == 0.05
    found = told(keys, study=BUILDING)
    assert "no material has a damping_ratio" in found["method[1].damping.by_material"].rule
    assert "method[1].damping.by_material" in told({"damping": damping})  # of a [floor]


def test_every_mistake_of_one_method_is_told():
    """Newmark with modes, single precision and an abrupt entry with a length: each has a remedy."""
    found = told({
        "integration": '"newmark"', "f_max": None, "precision": '"single"', "entry": '"abrupt"',
        "entry_length": '"1 m"',
    })  # fmt: skip
    assert set(found) >= {"method[1].precision", "method[1].damping", "method[1].entry_length"}


def test_the_remedy_of_a_ratio_with_newmark_is_accepted():
    """What the message offers to write is read out of it, and makes a method."""
    keys = {"integration": '"newmark"', "f_max": None}
    remedy = told(keys)["method[1].damping"].remedy
    offered = remedy[remedy.index("{") : remedy.index("}") + 1]
    assert isinstance(method(**{**keys, "damping": offered}).interaction.damping, Rayleigh)


@pytest.mark.parametrize(
    ("keys", "length"),
    [
        ({"entry": '"ramp"'}, 1.5),
        ({"entry": '"ramp"', "entry_length": '"80 cm"'}, 0.8),
        ({"entry": '"drive_in"', "entry_length": '"2500 mm"'}, 2.5),
    ],
)
def test_an_entry_is_as_long_as_it_says_and_a_ramp_one_element_else(keys, length):
    """The mesh of the study is 1.5 m; the paper's ramp is one element."""
    assert method(**keys).entry.length == pytest.approx(length)


def test_an_entry_of_half_the_route_fits_and_a_longer_one_does_not():
    """On 12 m entry and exit have 6 m each."""
    assert method(entry_length='"6 m"').entry.length == 6.0
    (problem,) = told({"entry_length": '"6.01 m"'}).values()
    assert "6.01 m" in problem.value
    assert problem.remedy == "use at most 6 m"


def test_waves_of_a_methods_own_replace_those_of_the_study_alone_where_they_are_named():
    """n_min and the patch stay the study's 0.05 1/m and 0.2 m."""
    more = '[roughness]\nn_min = "0.05 1/m"\nn_max = "5 1/m"\ncontact_patch = "0.2 m"\n'
    study = study_from_text(
        text_of({"n_max": '"8 1/m"'}, {"name": '"b"', "contact_patch": '"0 m"'}, more=more)
    )
    one, other = (m.band for m in study.methods)
    assert (one.n_min, one.n_max, one.contact_patch) == (0.05, 8.0, 0.2)
    assert (other.n_min, other.n_max, other.contact_patch) == (0.05, 5.0, 0.0)


def test_waves_that_end_below_their_beginning_are_told_of_the_method():
    """The study's begin at 0.011 1/m."""
    assert "above n_min" in told({"n_max": '"0.01 1/m"'})["method[1].n_max"].rule


def test_methods_keep_the_order_of_the_file_and_their_numbers_in_messages():
    """The second method's slip is told of method[2], whatever the first is called."""
    study = study_from_text(text_of({"name": '"z"'}, {"name": '"coupled"'}))
    assert [m.name for m in study.methods] == ["z", "coupled"]
    found = told({"name": '"z"'}, {"f_max": None})
    assert list(found) == ["method[2].f_max"]


def test_methods_of_one_name_are_refused():
    """The second would be found in place of the first."""
    assert told({}, {"interaction": '"decoupled"'})["method[2].name"].value == "'coupled' 2 times"


@pytest.mark.parametrize(
    ("dt", "duration", "fine"),
    [("5 ms", "50 ms", True), ("5 ms", "49 ms", False), ("1 ms", "10 ms", True)],
)
def test_a_record_has_at_least_ten_steps(dt, duration, fine):
    """Ten steps of 5 ms are 50 ms."""
    study = GOOD.replace('duration = "4 s"', f'duration = "{duration}"')
    if fine:
        assert study_from_text(text_of({"dt": f'"{dt}"'}, study=study)).duration
    else:
        assert "at least 10 steps" in told({"dt": f'"{dt}"'}, study=study)["method[1].dt"].rule


@pytest.mark.parametrize(("n_min", "fine"), [("23.9 1/m", True), ("24.1 1/m", False)])
def test_a_road_whose_first_wave_no_step_can_follow_is_refused(n_min, fine):
    """At 15 km/h steps of 5 ms follow 0.5 / (4.1667 x 0.005) = 24 cycles a metre at most."""
    more = f'[roughness]\nn_min = "{n_min}"\nn_max = "30 1/m"\n'
    if fine:
        assert study_from_text(text_of({}, more=more)).band.n_min == 23.9
    else:
        (problem,) = told({}, more=more).values()
        assert "this step follows waves to 24 1/m only" in problem.rule
        assert "begin at 24.1 1/m" in problem.rule
