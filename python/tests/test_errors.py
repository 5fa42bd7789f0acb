"""Errors are one line, whatever they have to show."""

import pickle

import pytest

from dustdetach import CasesFailed, DustError, Impact, InvalidInput, LammpsMissing
from dustdetach.errors import LONGEST_MESSAGE, LammpsBusy, MachineFault, shown


@pytest.mark.parametrize("kind", [InvalidInput, LammpsBusy, LammpsMissing, MachineFault])
def test_each_is_one_of_ours_and_survives_the_way_from_a_process(kind):
    error = kind("a\nb\x1b[31m\udcff")
    assert isinstance(error, DustError)
    assert str(error) == "a\\nb\\x1b[31m\\udcff"
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), again.status) == (kind, str(error), error.status)


def test_the_status_is_2_for_input_and_1_for_the_machine():
    assert {kind: kind.status for kind in (InvalidInput, LammpsBusy, LammpsMissing, MachineFault, CasesFailed)} == {
        InvalidInput: 2,
        LammpsBusy: 2,
        LammpsMissing: 1,
        MachineFault: 1,
        CasesFailed: 1,
    }


def test_failed_cases_survive_the_way_from_a_process():
    error = CasesFailed([(Impact(speed=2), "too much"), (Impact(speed=3), "too little")])
    again = pickle.loads(pickle.dumps(error))
    assert again.failures == error.failures
    assert str(again) == "2 cases failed; first: too much"


def test_a_long_message_loses_its_middle():
    message = str(InvalidInput("name: " + "x" * 10**6 + " is wrong"))
    assert len(message) <= LONGEST_MESSAGE
    assert message.startswith("name: ")
    assert message.endswith(" is wrong")


def test_values_that_cannot_be_shown():
    assert shown(10**5000) == "a value of type int that cannot be shown"
    assert shown([1, 2]) == "[1, 2]"
    assert len(shown("x" * 10**6)) <= 60
