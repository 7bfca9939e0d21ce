"""Surface files dropped into the page: what is kept, who reads them, what never leaks."""

from __future__ import annotations

import contextlib
import gzip
import io
import json
import os
import stat
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient

from asperity.config import load_file
from asperity.config.case_file import builtin_text, tables
from asperity.errors import InputError
from asperity.results import record_layout
from asperity.results.read_record import read
from asperity.results.record_layout import json_object
from asperity.solver import explore
from asperity.surfaces.generation.generate import self_affine
from asperity.web import surface_uploads as dropped
from asperity.web.requests import Asked
from asperity.web.surface_uploads import MOST_FILES, Surfaces
from commands import call
from web_client import client_of, page_of, refusal


@pytest.fixture
def kept() -> Iterator[Surfaces]:
    made = Surfaces()
    yield made
    made.close()


def folder_of(client: TestClient) -> str:
    """The folder of uploads, which nobody may hear of."""
    return str(page_of(client).surfaces._folder.name)


def case_of(*files: str, **roughness: Any) -> dict[str, Any]:
    """Tables of a case whose surface is measured."""
    found = tables(builtin_text("published-exact"), None)
    return {
        **found,
        "counterface": {**found["counterface"], "deformation": "rigid"},
        "roughness": {"files": list(files), **roughness},
        "numerics": {"max_impacts": 5},
    }


@pytest.fixture(scope="module")
def surface() -> bytes:
    """A self-affine surface as text, with its size and unit in a header."""
    heights = self_affine((48, 48), (20e-9, 20e-9), hurst=0.8, rms_height=5e-9, seed=3).heights
    text = io.StringIO()
    np.savetxt(text, heights * 1e9, fmt="%.17g", delimiter=",")
    return f"# size[um] 0.96 0.96\n# unit nm\n{text.getvalue()}".encode()


def upload(client: TestClient, name: str, content: bytes) -> str:
    answer = client.post(f"/api/surfaces/{name}", content=content)
    assert answer.status_code == 200, answer.text
    found = answer.json()
    assert (found["name"], found["bytes"]) == (name, len(content))
    return str(found["token"])


def explored(client: TestClient, case: dict[str, Any], **surfaces: str) -> Any:
    question = {"case": case, "name": "drop", "surfaces": surfaces}
    answer = client.post("/api/explore", json=question)
    assert answer.status_code == 200, answer.text
    assert folder_of(client) not in answer.text
    return json.loads(answer.text.splitlines()[-1])


def refused(client: TestClient, case: dict[str, Any], **surfaces: str) -> str:
    """Message of a refusal beside the field of the files."""
    error = explored(client, case, **surfaces)["error"]
    assert (error["kind"], error["key"]) == ("input", "roughness.files"), error
    assert "\n" not in error["message"]
    return str(error["message"])


# Names


NAMES = {
    404: ("a%2Fb.csv", "..%2F..%2Fb.csv", "%2Fetc%2Fpasswd", ".."),
    422: (
        "...", ".hidden.csv", "a%5Cb.csv", "a%00.csv", "a%0A.csv", "-rf.csv", "na%C3%AFve.csv",
        "%FF.csv", "a" * 81, "%20.csv", "a.csv;b",
    ),
}  # fmt: skip


def test_a_name_is_no_path_and_an_empty_file_no_surface(client):
    before = sorted(Path(folder_of(client)).rglob("*"))
    for status, names in NAMES.items():
        for name in names:
            refusal(client, f"/api/surfaces/{name}", status, content=b"1 2\n2 1\n")
    assert refusal(client, "/api/surfaces/a.csv", content=b"")["kind"] == "input"
    assert sorted(Path(folder_of(client)).rglob("*")) == before


@contextlib.contextmanager
def opened() -> Iterator[list[str]]:
    """Paths that this process opens meanwhile, and programs that it starts."""
    found: list[str] = []
    listening = True

    def hear(event: str, given: tuple[Any, ...]) -> None:
        if listening and event in ("open", "subprocess.Popen"):
            found.append(str(given[0]))

    sys.addaudithook(hear)  # which nothing removes
    try:
        yield found
    finally:
        listening = False


def test_a_path_in_a_case_is_not_opened(client, tmp_path):
    """Nor one of another upload, by whatever token; a pipe would hold its reader for ever."""
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    real = tmp_path / "real.csv"
    real.write_text("1 2\n2 1\n")
    explored(client, case_of("warm.csv"))
    for name in ("/etc/passwd", "../x.csv", "/dev/zero", str(pipe), str(real), "\0", ""):
        case = case_of(name)
        for token in ({}, {name: ""}, {name: "../../etc"}, {name: str(real)}, {name: "a" * 32}):
            with opened() as found:
                message = refused(client, case, **token)
            assert "dropped into this page" in message
            assert not found, found
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_case_of_paths_is_not_what_a_page_begins_with(tmp_path):
    text = builtin_text("published-exact")
    begin, end = text.index("asperity_density"), text.index("[adhesion]")
    path = tmp_path / "measured.toml"
    path.write_text(text[:begin] + 'files = ["/etc/passwd"]\n' + text[end:])
    ran = call("web", str(path), "--port", "0")
    assert ran.exit_code == 2
    assert "dropped into" in ran.stderr


# Reading


def test_an_upload_gives_what_the_file_itself_gives(client, surface, tmp_path):
    """The same asperities, motion and warnings as of a case beside the file."""
    token = upload(client, "scan.csv", surface)
    tables = case_of("scan.csv", source="gaussian", form_removal="mean")
    found = explored(client, tables, **{"scan.csv": token})["answer"]

    (tmp_path / "scan.csv").write_bytes(surface)
    toml = client.post("/api/toml", json={"case": tables}).json()["toml"]
    (tmp_path / "drop.toml").write_text(toml)
    result, _ = explore(load_file(tmp_path / "drop.toml"), name="drop")
    wanted = json.loads(json.dumps(json_object(result)).replace(f"{tmp_path}/", ""))
    assert found["surface"]["files"][0]["file"] == "scan.csv"
    assert found["surface"]["files"][0]["sha256"] == wanted["surface"]["files"][0]["sha256"]
    assert found["warnings"] == wanted["warnings"]
    flat = pytest.approx(numbers(wanted), rel=1e-9)
    assert numbers(found) == flat


def numbers(found: dict[str, Any]) -> list[float]:
    """Measures of a case and of its surface."""
    measures, surface = found["measures"], found["surface"]
    every = [measures["impact_speed"], *measures["rebound_height"], *measures["restitution"]]
    return [*every, *(value for value in leaves(surface) if isinstance(value, float))]


def leaves(value: Any) -> Iterator[Any]:
    if isinstance(value, dict | list):
        for each in value.values() if isinstance(value, dict) else value:
            yield from leaves(each)
    else:
        yield value


@pytest.mark.parametrize("name", ["record.nc", "curve.nc", "summary.txt"])
def test_what_is_downloaded_names_the_users_file_alone(client, surface, tmp_path, name):
    token = upload(client, "scan.csv", surface)
    question = {"case": case_of("scan.csv"), "surfaces": {"scan.csv": token}}
    answer = client.post(f"/api/files/{name}", json=question)
    assert answer.status_code == 200, answer.text
    assert b"asperity-" not in answer.content.replace(b"asperity-surface", b"")
    assert folder_of(client).encode() not in answer.content
    assert token.encode() not in answer.content
    if name.endswith(".nc"):
        (tmp_path / name).write_bytes(answer.content)
        found = read(str(tmp_path / name))
        assert found.case.roughness is not None
        assert found.case.roughness.files == ["scan.csv"]
        told = json.dumps([found.case.toml(), json_object(found), record_layout.attributes(found)])
        assert folder_of(client) not in told


def test_a_file_without_its_size_is_told_beside_the_field(client, surface):
    bare = surface.split(b"\n", 1)[1]
    token = upload(client, "bare.csv", bare)
    message = refused(client, case_of("bare.csv"), **{"bare.csv": token})
    assert message.startswith("bare.csv: ")
    assert "size" in message
    end = explored(client, case_of("bare.csv", size="0.96 um x 0.96 um"), **{"bare.csv": token})
    assert "answer" in end


def npy(shape: tuple[int, ...]) -> bytes:
    """The header of an array without its numbers."""
    content = io.BytesIO()
    header = {"descr": "<f8", "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(content, header)
    return content.getvalue()


UNREADABLE = {
    "text.csv": b"# size[um] 1 1\n# unit nm\n1 two\n3 4\n",
    "large.npy": npy((40_000, 40_000)),
    "deep.npy": npy((2,) * 30),
    "cut.csv.gz": gzip.compress(b"1 2\n" * 999)[:-9],
    "noise.nc": b"\x89HDF\r\n\x1a\n" + b"\xff" * 500,
    "scan.map.nc": b"CDF\x01" + b"\0" * 60,
}


@pytest.mark.parametrize("name", UNREADABLE)
def test_a_file_that_cannot_be_read_is_told_in_a_line(client, name):
    token = upload(client, name, UNREADABLE[name])
    assert name in refused(client, case_of(name), **{name: token})


def test_a_bomb_is_refused(client):
    """Four gigabytes and more of zeros in four megabytes, within the reader's memory and time."""
    bomb = gzip.compress(bytes(1 << 26), 9) * 65
    assert len(bomb) < 5 << 20
    token = upload(client, "bomb.csv.gz", bomb)
    message = refused(client, case_of("bomb.csv.gz"), **{"bomb.csv.gz": token})
    assert message.startswith("bomb.csv.gz: ")


# A reader in a process of its own


@pytest.fixture
def reader(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Replace the reader's program by a script; its process writes its number beside it."""

    def replace(script: str) -> Path:
        program, number = tmp_path / "reader", tmp_path / "number"
        program.write_text(f"#!/bin/sh\necho $$ > {number}\n{script}\n")
        program.chmod(0o700)
        monkeypatch.setattr(dropped, "sys", SimpleNamespace(executable=str(program)))
        return number

    return replace


def fresh(client: TestClient) -> dict[str, str]:
    """An upload that was not read before."""
    return {"new.csv": upload(client, "new.csv", b"%d 1\n1 2\n" % time.monotonic_ns())}


def test_a_reader_that_hangs_is_killed(client, reader, monkeypatch):
    number = reader("exec sleep 600")
    monkeypatch.setattr(dropped, "_PATIENCE", 1.0)
    begun = time.monotonic()
    message = refused(client, case_of("new.csv"), **fresh(client))
    assert time.monotonic() - begun < 20.0
    assert message == "new.csv: takes longer than 1 s to read"
    with pytest.raises(ProcessLookupError):
        os.kill(int(number.read_text()), 0)


@pytest.mark.parametrize(
    "script", ["kill -9 $$", "kill -11 $$", "exit 1", "echo Traceback >&2; exit 1", "echo [1,"]
)
def test_a_reader_that_dies_gives_a_line(client, reader, script):
    reader(script)
    message = refused(client, case_of("new.csv"), **fresh(client))
    assert message == "new.csv: cannot be read: its reader failed on it"


def test_a_reader_is_bounded_in_memory_and_time(tmp_path):
    """By the system, so that no library's own opinion of a file counts."""
    program = (
        "import resource as r; from asperity.web import upload_reader as m; m._bound(); "
        "print(r.getrlimit(r.RLIMIT_AS)[1], r.getrlimit(r.RLIMIT_CPU)[1]); bytes(m.MEMORY)"
    )
    command = [sys.executable, "-c", program]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    memory, seconds = map(int, ran.stdout.split())
    assert memory <= 4 << 30
    assert seconds <= 60
    assert "MemoryError" in ran.stderr


# What is kept


@pytest.fixture
def unread(monkeypatch: pytest.MonkeyPatch) -> None:
    """Uploads whose maps are made at once, of one length."""

    def read(source: Path, target: Path, options: str) -> dict[str, Any]:
        target.write_bytes(bytes(1000))
        return {"notes": [], "channel": "", "channels": []}

    monkeypatch.setattr(dropped, "_read", read)


def resolved(kept: Surfaces, name: str, token: str, **roughness: Any) -> Path:
    """The map that a case reads in the place of an upload."""
    case, _ = kept.resolved(Asked(case_of(name, **roughness)).case(), {name: token})
    assert case.roughness is not None
    assert case.roughness.files is not None
    return Path(case.roughness.files[0])


def test_the_one_longest_unused_goes_first(kept, unread):
    tokens = [kept.keep(f"{n}.csv", b"1") for n in range(MOST_FILES)]
    assert resolved(kept, "0.csv", tokens[0]).exists()
    kept.keep("more.csv", b"1")
    assert resolved(kept, "0.csv", tokens[0]).exists()
    with pytest.raises(InputError, match="dropped into this page"):
        resolved(kept, "1.csv", tokens[1])
    assert len(list(Path(kept._folder.name).iterdir())) == MOST_FILES


def test_a_file_dropped_in_again_after_it_went_is_read_again(kept, unread):
    token = kept.keep("scan.csv", b"1")
    assert resolved(kept, "scan.csv", token).exists()
    for n in range(MOST_FILES):
        kept.keep(f"{n}.csv", b"1")
    assert kept.keep("scan.csv", b"1") == token
    assert resolved(kept, "scan.csv", token).exists()


def bytes_of(kept: Surfaces) -> int:
    return sum(one.stat().st_size for one in Path(kept._folder.name).rglob("*") if one.is_file())


def test_uploads_are_bounded_together(kept, monkeypatch):
    monkeypatch.setattr(dropped, "MOST_BYTES", 1000)
    for n in range(8):
        kept.keep(f"{n}.csv", bytes(300))
    assert 0 < bytes_of(kept) <= 1000


def test_maps_of_many_sizes_of_one_file_do_not_fill_the_disk(kept, unread):
    """Each size makes a map anew; those of sizes before it go."""
    token = kept.keep("bare.csv", b"1")
    for n in range(40):
        assert resolved(kept, "bare.csv", token, size=f"{n + 1} um x 1 um").exists()
    assert bytes_of(kept) <= 10_000


def test_uploads_go_with_the_server(surface):
    with client_of() as client:
        upload(client, "scan.csv", surface)
        folder = Path(folder_of(client))
        assert folder.stat().st_mode & 0o077 == 0
    assert not folder.exists()
