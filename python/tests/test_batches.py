"""Batches of results: their names, and which cases share one."""

import shutil

from dustdetach import Impact, run
from dustdetach.batches import Batches, Build, in_batches, parameters_of, read_batch, write_batch
from dustdetach.places import find_deck


def test_there_and_back(tmp_path):
    results = [run(Impact(speed=speed)) for speed in (3.0, 4.0)]
    build = Build()
    name = write_batch(tmp_path / "new" / "folder", build, results)
    assert read_batch(tmp_path / "new" / "folder" / name) == results
    batches = Batches(tmp_path / "new" / "folder", build)
    assert list(batches.new()) == results
    assert list(batches.new()) == []


def test_a_case_and_its_result_have_the_same_parameters():
    case = Impact(speed=3, angle=45, seed=2, rotation=False, tangential="estimate")
    assert parameters_of(run(case)) == parameters_of(case)


def test_each_method_has_its_own_deck_in_the_name(monkeypatch, tmp_path, resolved_result):
    functions = run(Impact(speed=4.0))
    build = Build()
    assert build.identity["functions"] != build.identity["resolved"]
    for name in ("in.impact", "in.impact.resolved"):
        shutil.copy(find_deck(name), tmp_path)
    with open(tmp_path / "in.impact.resolved", "a") as stream:
        stream.write("# changed\n")
    monkeypatch.setattr("dustdetach.batches.find_deck", lambda name: tmp_path / name)
    # results of the other method stay good
    assert Build().name([functions]) == build.name([functions])
    assert Build().is_own(build.name([functions]))
    assert not Build().is_own(build.name([resolved_result]))


def test_cases_of_one_texture_follow_each_other():
    cases = [Impact(speed=v, seed=s, restitution=e) for v in (2, 4) for s in (3, 1) for e in (0.5, 0.7)]
    resolved = [Impact(speed=v, method="resolved") for v in (2, 4)]
    batches = list(in_batches([*resolved, *cases], 6))
    assert [len(batch) for batch in batches] == [6, 2, 1, 1]
    assert [case.seed for batch in batches[:2] for case in batch] == [1] * 4 + [3] * 4
    assert [case.method for batch in batches[2:] for case in batch] == ["resolved"] * 2
    assert list(in_batches([], 6)) == []
