"""The store of a study: the same bytes whoever fills it, in whatever order, however often."""

from __future__ import annotations

import json
import os
import shutil
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import zarr

from asperity.errors import ENDS, InputError, OutputError
from asperity.sweeps.compute.runner import Tally, fill
from asperity.sweeps.store.array import metadata
from asperity.sweeps.store.counting import first_failure, outcomes
from asperity.sweeps.store.manifest import manifest_of
from asperity.sweeps.store.merge import Shard, join, shard, whole
from asperity.sweeps.store.repair import mend, remove
from asperity.sweeps.store.store import Store
from asperity.sweeps.store.variables import attributes, axis_column, drawn
from asperity.sweeps.study.axes import Axis
from fake_study import FakeStudy, backwards, compute, expected, in_order
from store_files import contents, flip

STUDY = FakeStudy()
TASKS = range(STUDY.tasks)


def filled(path: Path, study: FakeStudy = STUDY, **options: Any) -> Path:
    fill(study, Store.create(path, study), in_order, **options)
    return path


@pytest.fixture(name="path")
def _path(tmp_path: Path) -> Path:
    return filled(tmp_path / "study.zarr")


@pytest.fixture(name="undisturbed", scope="module")
def _undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    return contents(filled(tmp_path_factory.mktemp("undisturbed") / "study.zarr"))


def test_zarr_and_a_store_give_back_what_was_written(path: Path):
    group, store = zarr.open_group(path, mode="r"), Store.open(path, STUDY)
    for name, values in expected(STUDY, range(STUDY.size)).items():
        np.testing.assert_array_equal(group[name][:], values)
        np.testing.assert_array_equal(store.column(name), values)


def test_a_chunk_has_the_bytes_that_zarr_writes(path: Path, tmp_path: Path):
    for name, content in metadata(STUDY).items():
        file = tmp_path / "zarr" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)
    group = zarr.open_group(tmp_path / "zarr", mode="r+")
    for name, values in expected(STUDY, range(STUDY.size)).items():
        group[name].with_config({"write_empty_chunks": True})[:] = values
    for file in (tmp_path / "zarr").rglob("c.*"):
        assert file.read_bytes() == (path / file.relative_to(tmp_path / "zarr")).read_bytes()


def test_a_store_describes_itself(path: Path):
    group = zarr.open_group(path, mode="r")
    assert group.attrs["schema"] == 3
    assert group.attrs["study"] == STUDY.canonical
    assert group.attrs["fingerprint"] == STUDY.fingerprint
    assert group["restitution"].metadata.dimension_names == ("case", "impact")
    assert group["time_to_rest"].attrs["units"] == "s"
    told = group["outcome"].attrs
    meanings = dict(zip(told["flag_meanings"].split(), told["flag_values"], strict=True))
    assert [meanings[outcome.value] for outcome in ENDS] == list(range(len(ENDS)))


def test_order_of_tasks_name_and_folder_leave_no_trace(
    tmp_path: Path, undisturbed: dict[str, bytes]
):
    path = tmp_path / "deeper" / "other.zarr"
    fill(STUDY, Store.create(path, STUDY), backwards)
    assert contents(path) == undisturbed


def test_a_run_that_was_stopped_goes_on(tmp_path: Path, undisturbed: dict[str, bytes]):
    path, stop = tmp_path / "study.zarr", threading.Event()

    def halt(task: int, effort: Any, tally: Tally) -> None:
        if tally.tasks == 3:
            stop.set()

    fill(STUDY, Store.create(path, STUDY), backwards, progress=halt, stop=stop)
    assert sorted(Store.open(path, STUDY).done) == list(TASKS)[-3:]
    assert complete(path) == STUDY.tasks - 3
    assert contents(path) == undisturbed


def test_what_is_not_finished_is_filled_up(tmp_path: Path):
    store = Store.open(filled(tmp_path / "study.zarr", tasks=[1]))
    restitution = store.column("restitution")
    cases = STUDY.task(1)
    np.testing.assert_array_equal(
        restitution[cases.start : cases.stop], expected(STUDY, cases)["restitution"]
    )
    assert np.isnan(np.delete(restitution, list(cases), axis=0)).all()
    assert store.cases_done == len(cases)


def complete(path: Path) -> int:
    """Fill up what is not done; how many tasks that were."""
    return fill(STUDY, Store.open(path, STUDY, writable=True), in_order).tasks


class Killed(BaseException):
    """The process ends here."""


def dying(steps: int) -> Any:
    """`os.fsync` that ends the process at one of its calls."""
    left = iter(range(steps))

    def fsync(descriptor: int) -> None:
        if next(left, None) is None:
            raise Killed

    return fsync


def test_a_death_at_any_step_costs_the_task_in_flight_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    study = FakeStudy(size=12)
    whole = contents(filled(tmp_path / "whole" / "study.zarr", study))
    steps = 0
    while True:
        path, kept = tmp_path / str(steps) / "study.zarr", 0
        store = None
        with monkeypatch.context() as patch:
            patch.setattr(os, "fsync", dying(steps))
            try:
                store = Store.create(path, study)
                for task in range(study.tasks):
                    store.write(task, compute(study, task)[0])
                    kept += 1
                store.finish()
                break
            except Killed:
                steps += 1
            finally:
                if store is not None:
                    store.manifest.end()
        if path.exists():
            store = Store.open(path, study, writable=True)
            assert len(store.done) in (kept, kept + 1)
            assert store.check() == []
        else:
            store = Store.create(path, study)
        fill(study, store, in_order)
        assert contents(path) == whole
    assert steps > 40


@pytest.mark.parametrize("kept", [0, 1, 10, 300, -1])
def test_a_torn_line_does_not_count(path: Path, undisturbed: dict[str, bytes], kept: int):
    file = manifest_of(path)
    *lines, last = file.read_bytes().splitlines(keepends=True)
    file.write_bytes(b"".join(lines) + last[:kept])
    assert sorted(Store.open(path, STUDY).done) == list(TASKS)[:-1]
    assert complete(path) == 1
    assert contents(path) == undisturbed


def test_files_without_a_line_do_not_count(path: Path, undisturbed: dict[str, bytes]):
    manifest_of(path).unlink()
    assert complete(path) == STUDY.tasks
    assert contents(path) == undisturbed


def test_corrupt_and_missing_chunks_are_named_and_computed_again(
    path: Path, undisturbed: dict[str, bytes]
):
    store = Store.open(path, STUDY, writable=True)
    assert store.check() == []
    flip(store.chunk_file(2, "restitution"))
    store.chunk_file(4, "captured").unlink()
    assert store.check() == [(2, "restitution"), (4, "captured")]
    with pytest.raises(InputError, match=r"restitution.c\.2\.0.*task 2.*--repair"):
        store.column("restitution")
    store.forget([2, 4])
    assert fill(STUDY, store, in_order).tasks == 2
    assert contents(path) == undisturbed


def test_another_schema_is_refused(path: Path):
    header, *rest = manifest_of(path).read_text().splitlines(keepends=True)
    newer = json.dumps(json.loads(header) | {"schema": 4})
    manifest_of(path).write_text("".join([f"{newer}\n", *rest]))
    with pytest.raises(InputError, match="`schema` must be 3; got 4 - a newer asperity"):
        Store.open(path)
    about = json.loads((path / "zarr.json").read_text())
    about["attributes"]["schema"] = 2
    (path / "zarr.json").write_text(json.dumps(about))
    with pytest.raises(InputError, match="`schema` must be 3; got 2 - an earlier asperity"):
        Store.open(path)


def test_the_manifest_of_another_store_is_refused(path: Path, tmp_path: Path):
    other = filled(tmp_path / "other.zarr", FakeStudy(salt=1))
    shutil.copy(manifest_of(other), manifest_of(path))
    with pytest.raises(InputError, match="must be the manifest of"):
        Store.open(path)


@pytest.mark.parametrize("content", [b"", b"{", b"[1]", b'{"shape": []}', b"\xff\xfe", None])
def test_metadata_that_cannot_be_read_are_named_and_written_again(
    path: Path, undisturbed: dict[str, bytes], content: bytes | None
):
    file = path / "energy_balance_error" / "zarr.json"
    if content is None:
        file.unlink()
    else:
        file.write_bytes(content)
    with pytest.raises(InputError, match=r"error.zarr\.json: cannot be read: .*--repair"):
        Store.open(path)
    assert mend(path, STUDY) == [str(file)]
    assert contents(path) == undisturbed


def test_a_group_that_cannot_be_read_is_written_again(path: Path, undisturbed: dict[str, bytes]):
    (path / "zarr.json").write_bytes(b"\0" * 100)
    with pytest.raises(InputError, match=r"zarr\.json: cannot be read"):
        Store.open(path, STUDY)
    with pytest.raises(InputError, match="must be the store of this study"):
        mend(path, FakeStudy(salt=1))
    assert mend(path, STUDY) == [str(path / "zarr.json")]
    assert contents(path) == undisturbed


def test_a_store_cut_into_other_tasks_is_refused(path: Path, undisturbed: dict[str, bytes]):
    class Other(FakeStudy):
        fingerprint = STUDY.fingerprint

    (path / "zarr.json").write_bytes(b"")
    with pytest.raises(InputError, match="must be cut into tasks of 10 cases; got 8"):
        mend(path, Other(task_size=10))
    mend(path, STUDY)
    with pytest.raises(InputError, match="must be cut into tasks of 10 cases; got 8"):
        Store.open(path, Other(task_size=10))
    assert contents(path) == undisturbed


def test_what_is_no_store_is_refused(tmp_path: Path):
    with pytest.raises(InputError, match="it is not there"):
        Store.open(tmp_path / "nothing.zarr")
    (tmp_path / "file.zarr").touch()
    with pytest.raises(InputError, match="it is no folder"):
        Store.open(tmp_path / "file.zarr")
    with pytest.raises(InputError, match=r"it has no zarr\.json"):
        Store.open(tmp_path)
    zarr.create_group(tmp_path / "group.zarr", attributes={"schema": 1})
    with pytest.raises(InputError, match="it is another zarr group"):
        Store.open(tmp_path / "group.zarr")


def test_a_store_is_not_replaced_unasked_and_a_folder_that_is_none_not_removed(
    path: Path, undisturbed: dict[str, bytes]
):
    with pytest.raises(InputError, match="`--resume` goes on with it, `--force` replaces it"):
        Store.create(path, STUDY)
    assert contents(path) == undisturbed
    remove(path)
    assert list(path.parent.iterdir()) == []
    path.mkdir()
    (path / "precious").touch()
    with pytest.raises(InputError, match="must be the store of a sweep"):
        remove(path)
    assert (path / "precious").exists()


def test_one_process_at_a_time_writes_a_store(path: Path):
    store = Store.open(path, STUDY, writable=True)
    with pytest.raises(OutputError, match="another process computes this sweep"):
        Store.open(path, STUDY, writable=True)
    with pytest.raises(OutputError, match="another process computes this sweep"):
        remove(path)
    store.close()
    Store.open(path, STUDY, writable=True).close()


def test_columns_that_do_not_fit_are_refused(tmp_path: Path):
    store = Store.create(tmp_path / "study.zarr", STUDY)
    columns = compute(STUDY, 0)[0]
    times = columns["time_to_rest"]
    for wrong in (
        {"time_to_rest": times.astype(np.float32)},
        {"time_to_rest": times[:-1]},
        {"restitution": columns["restitution"][:, :1]},
    ):
        with pytest.raises(ValueError, match="must be"):
            store.write(0, columns | wrong)
    del columns["time_to_rest"]
    with pytest.raises(ValueError, match="must be"):
        store.write(0, columns)
    store.close()
    assert not store.done


def test_outcomes_are_counted_and_the_first_failure_told(path: Path, tmp_path: Path):
    store = Store.open(path)
    codes = expected(STUDY, range(STUDY.size))["outcome"]
    assert outcomes(store) == {
        outcome.value: int((codes == code).sum()) for code, outcome in enumerate(ENDS)
    }
    assert first_failure(store) == (3, "case 3 fails")
    assert first_failure(Store.open(filled(tmp_path / "empty.zarr", tasks=[]))) is None


def test_a_tally_adds_up():
    tally = Tally(0, 0, STUDY.size)
    for task in TASKS:
        tally = tally.plus(compute(FakeStudy(pause=0.001), task)[1], wall=1.0 + task)
    assert (tally.tasks, tally.cases) == (STUDY.tasks, STUDY.size)
    assert tally.batch_use == pytest.approx(0.5)
    assert tally.rate == pytest.approx(STUDY.size / STUDY.tasks)
    assert tally.left == 0.0
    assert tally.outside == pytest.approx(1.0 - 0.25e-3 * STUDY.tasks / STUDY.tasks)


def test_warnings_that_differ_in_their_numbers_alone_are_told_once():
    tally = Tally(0, 0, 16)
    effort = compute(FakeStudy(), 0)[1]
    for warned in (
        ((7, "the index is 2.5e-1: too low"), (7, "flooded")),
        ((0, "the index is -3: too low"), (5, "the index is 1,000.5: too low")),
    ):
        tally = tally.plus(effort._replace(looked=4, warned=warned), wall=1.0)
    assert tally.warnings == [
        "3 of 8 cases looked at, such as case 0: the index is -3: too low",
        "1 of 8 cases looked at, such as case 7: flooded",
    ]


@pytest.mark.parametrize("parts", [1, 2, 3, 10])
def test_shards_merge_into_the_bytes_of_one_run(
    tmp_path: Path, undisturbed: dict[str, bytes], parts: int
):
    path = tmp_path / "study.zarr"
    shards = [Shard(number + 1, parts) for number in range(parts)]
    stores = [filled(s.store(path), tasks=s.tasks(STUDY.tasks)) for s in shards]
    assert sorted(task for s in shards for task in s.tasks(STUDY.tasks)) == list(TASKS)
    assert {whole(store) for store in stores} == {path}
    joined = join(path, stores[::-1])
    assert sorted(joined.done) == list(TASKS)
    for store in stores:
        remove(store)
    assert contents(path) == undisturbed


def test_a_merge_of_some_shards_is_completed_by_a_run(
    tmp_path: Path, undisturbed: dict[str, bytes]
):
    path = tmp_path / "whole" / "study.zarr"
    store = filled(Shard(2, 3).store(tmp_path / "study.zarr"), tasks=range(1, STUDY.tasks, 3))
    assert sorted(join(path, [store]).done) == list(range(1, STUDY.tasks, 3))
    complete(path)
    assert contents(path) == undisturbed


def test_stores_that_overlap_merge_where_they_agree(tmp_path: Path, undisturbed: dict[str, bytes]):
    one, other = filled(tmp_path / "1.zarr", tasks=TASKS[:5]), filled(tmp_path / "2.zarr")
    path = tmp_path / "whole" / "study.zarr"
    join(path, [one, other])
    assert contents(path) == undisturbed


def test_stores_that_disagree_are_refused(tmp_path: Path):
    one, other = filled(tmp_path / "1.zarr"), tmp_path / "2.zarr"
    store = Store.create(other, STUDY)
    columns = compute(STUDY, 3)[0]
    store.write(3, columns | {"energy_balance_error": columns["energy_balance_error"] + 1e-9})
    store.finish()
    with pytest.raises(InputError, match=r"2\.zarr.*error.c\.3: must be the same as .*1\.zarr"):
        join(tmp_path / "whole.zarr", [one, other])
    assert not (tmp_path / "whole.zarr").exists()


def test_corrupt_chunks_and_stores_of_two_studies_do_not_merge(tmp_path: Path, path: Path):
    earlier = filled(tmp_path / "earlier" / "study.zarr", FakeStudy(salt=1))
    before = contents(earlier)
    with pytest.raises(InputError, match="must be of the same study"):
        join(tmp_path / "whole.zarr", [path, earlier])
    flip(Store.open(path).chunk_file(1, "impacts"))
    with pytest.raises(InputError, match=r"impacts.c\.1: must be what was written.*--repair"):
        join(earlier, [path], replace=True)
    assert contents(earlier) == before
    assert {file.name for file in earlier.parent.iterdir()} == {"study.zarr", "study.zarr.manifest"}


def test_a_shard_is_named_i_of_n():
    assert shard("2/10") == Shard(2, 10)
    assert Shard(2, 10).store(Path("a/b.c.zarr")) == Path("a/b.c.2-of-10.zarr")
    for text in ("0/3", "4/3", "1", "1/0", "-1/2", "a/b", "1/2/3", ""):
        with pytest.raises(InputError, match="`--shard` must be i/N"):
            shard(text)
    with pytest.raises(InputError, match="`--output` must be given"):
        whole(Path("part.zarr"))


def test_words_of_a_sample_are_codes_however_many_they_are():
    words = tuple(f"word {number}" for number in range(300))
    axis = Axis("body.material", "", "material", False, words, 0.0, 0.0, 0, "linear")
    values = {"body.material": np.array(words, object)}
    sampled: Any = SimpleNamespace(sample=1, axes=(axis,), values=lambda *_: values)
    codes = drawn(sampled, range(300))["body.material"]
    assert codes.tolist() == list(range(300))
    meanings = attributes(axis_column(axis), (axis,))["flag_meanings"].split()
    assert [meanings[code] for code in codes] == [word.replace(" ", "_") for word in words]
