"""The web server as a program: where it listens, how it ends, whom it answers, what it offers."""

from __future__ import annotations

import contextlib
import http.client
import json
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from asperity.config import FIRST
from asperity.config.case_file import builtin_text, tables
from commands import assert_one_line, call, program
from web_client import client_of

HERE = Path(__file__).parents[1]
LOOPBACK = "0100007F"
PROGRAM = f"""
import sys
sys.path.insert(0, {str(HERE)!r})
from asperity.web import serving
from fake_solve import solver
serving.SILENCE = 2.0
sys.modules["asperity.solver"] = solver()
from asperity.cli import main
main()
"""
"""`asperity` with a solver that answers at once, and a server of little patience."""


@contextlib.contextmanager
def served(*options: str) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """The server in a process of its own, and its port."""
    command = [sys.executable, "-c", PROGRAM, "web", "--port", "0", "--json", *options]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as running:
        try:
            assert running.stdout is not None
            told = json.loads(running.stdout.readline())
            assert told["address"].startswith("http://127.0.0.1:")
            assert told["case"] == FIRST
            yield running, int(told["address"].rstrip("/").rpartition(":")[2])
        finally:
            running.kill()


# A process


def listening(pid: int) -> set[str]:
    """Addresses at which a process's network listens, as the kernel writes them."""
    found = set()
    for table in ("tcp", "tcp6"):
        for line in Path(f"/proc/{pid}/net/{table}").read_text().splitlines()[1:]:
            _, local, _, state = line.split()[:4]
            if state == "0A":
                found.add(local)
    return found


@contextlib.contextmanager
def connected(port: int) -> Iterator[http.client.HTTPConnection]:
    asking = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    try:
        yield asking
    finally:
        asking.close()


def answered(port: int, path: str = "/api/form") -> int:
    with connected(port) as asking:
        asking.request("GET", path)
        answer = asking.getresponse()
        answer.read()
        return answer.status


def interrupted(running: subprocess.Popen[str]) -> str:
    """What a server says that Ctrl-C ends, at once."""
    begun = time.monotonic()
    running.send_signal(signal.SIGINT)
    _, err = running.communicate(timeout=20)
    assert time.monotonic() - begun < 2.0
    assert running.returncode == 130
    return err


def test_it_listens_on_the_loopback_alone_and_ctrl_c_ends_it():
    with served() as (running, port):
        here = {address for address in listening(running.pid) if address.endswith(f":{port:04X}")}
        assert here == {f"{LOOPBACK}:{port:04X}"}
        assert answered(port) == 200
        assert_one_line(interrupted(running), "the page is closed")


def test_ctrl_c_does_not_wait_for_a_page_that_stays_open():
    """A browser keeps its connections; one that is in the middle of a request too."""
    with served("--quiet") as (running, port), contextlib.ExitStack() as held:
        idle, half = (
            held.enter_context(socket.create_connection(("127.0.0.1", port))) for _ in range(2)
        )
        idle.sendall(b"GET /api/form HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        assert idle.recv(1 << 16).startswith(b"HTTP/1.1 200")
        half.sendall(b"POST /api/read HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 9\r\n\r\na")
        time.sleep(0.2)
        interrupted(running)


def test_a_taken_port_is_one_line_and_exit_4():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        ran = program("web", "--port", str(port))
    assert (ran.returncode, ran.stdout) == (4, "")
    assert_one_line(ran.stderr, f"127.0.0.1:{port}", "--port")


@pytest.mark.parametrize(
    ("arguments", "parts"),
    [
        (("--port", "65536"), ("--port", "[0, 65535]", "65536")),
        (("--port", "-1"), ("--port", "[0, 65535]", "-1")),
        (("--host", "localhost:80"), ("--host", "localhost:80")),
        (("publishd",), ("published",)),
    ],
)
def test_an_address_or_a_case_that_cannot_be_is_one_line_and_exit_2(arguments, parts):
    ran = call("web", *arguments)
    assert (ran.exit_code, ran.stdout) == (2, "")
    assert_one_line(ran.stderr, *parts)


QUESTION = json.dumps(
    {"case": {"body": {"radius": "1 um", "material": "silica"}, "counterface": {}, "impact": {}}}
)
HOSTILE: tuple[tuple[str, str, str | None, dict[str, str], int], ...] = (
    ("GET", "/api/cases/published", None, {}, 200),
    ("GET", "/static/../../../../etc/passwd", None, {}, 404),
    ("GET", "/api/cases/published", None, {"Host": "evil.example"}, 421),
    ("POST", "/api/toml", QUESTION, {}, 422),
    ("POST", "/api/explore", '{"case": {"body": {}}}', {}, 422),
    ("POST", "/api/explore", "[" * 2000, {}, 422),
    ("POST", "/api/surfaces/a.csv", "", {}, 422),
    ("POST", "/api/read", "a = [", {}, 422),
    ("DELETE", "/api/form", None, {}, 405),
    ("POST", "/api/read", "schema = 1", {"Origin": "https://evil.example"}, 403),
    *(("GET", "/", None, {"Host": "evil.example"}, 421),) * 6,
    *(("GET", "/nothing", None, {}, 404),) * 4,
)


def memory(pid: int) -> int:
    """Resident memory of a process [bytes]."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return 1024 * next(int(line.split()[1]) for line in lines if line.startswith("VmRSS:"))


def flood(port: int, times: int, within: float) -> None:
    """Ask for everything in turn, good and bad, within a time [s]; each answer is the right one."""
    until = time.monotonic() + within
    with connected(port) as asking:
        for number in range(times):
            method, path, body, headers, status = HOSTILE[number % len(HOSTILE)]
            asking.request(method, path, body, headers)
            answer = asking.getresponse()
            answer.read()
            assert answer.status == status, (path, answer.status)
            assert time.monotonic() < until, f"only {number} requests in {within} s"


def test_an_open_connection_is_answered_without_delay():
    """TCP would hold an answer's second packet back for 40 ms, were it not told otherwise."""
    with served("--quiet") as (_, port), connected(port) as asking:
        waits = []
        for _ in range(20):
            begun = time.monotonic()
            asking.request("GET", "/api/form")
            asking.getresponse().read()
            waits.append(time.monotonic() - begun)
    assert min(waits[5:]) < 0.03


def test_silent_connections_do_not_keep_others_out():
    """More than there are places for; they are closed where no request comes."""
    with served("--quiet") as (_, port), contextlib.ExitStack() as held:
        for _ in range(70):
            silent = held.enter_context(socket.create_connection(("127.0.0.1", port), timeout=30))
            silent.sendall(b"GET / HT")
        until, status = time.monotonic() + 40.0, 503
        while status != 200 and time.monotonic() < until:
            time.sleep(0.25)
            status = answered(port)
        assert status == 200


@pytest.mark.long
def test_ten_thousand_requests_leave_it_answering_in_bounded_memory():
    with served("--quiet") as (running, port):
        flood(port, 1000, within=20.0)
        before = memory(running.pid)
        flood(port, 9000, within=120.0)
        assert answered(port) == 200
        assert memory(running.pid) - before < 32 << 20
        assert interrupted(running) == ""


def test_hundreds_of_cases_leave_it_answering_in_bounded_memory():
    """Each by an asker of its own and each complete, so that nothing of them may be kept."""

    def ask(times: int) -> None:
        for _ in range(times):
            with connected(port) as asking:  # each from another port
                asking.request("POST", "/api/explore", question)
                assert asking.getresponse().read().splitlines()[-1].startswith(b'{"answer"')

    with served("--quiet") as (running, port):
        case = tables(builtin_text("published-exact"), None)
        question = json.dumps({"case": case})
        ask(50)
        before = memory(running.pid)
        ask(150)
        assert memory(running.pid) - before < 32 << 20
        assert answered(port) == 200


# Whom it answers


@pytest.mark.parametrize(
    ("host", "status"),
    [
        ("127.0.0.1:8737", 200),
        ("localhost:8737", 200),
        ("LOCALHOST", 200),
        ("[::1]:8737", 200),
        ("evil.example", 421),
        ("evil.example:8737", 421),
        ("127.0.0.1.evil.example", 421),
        ("user@127.0.0.1", 421),
        ("127.0.0.1:port", 421),
        ("127.0.0.1/path", 421),
        ("[::1", 421),
        ("", 421),
    ],
)
def test_it_answers_by_its_own_names_alone(client, host, status):
    """A foreign name that leads to this machine is how a foreign page would ask."""
    answer = client.get("/api/form", headers={"host": host})
    assert answer.status_code == status
    if status != 200:
        assert answer.json()["error"]["kind"] == "request"


def test_other_names_can_be_told():
    with client_of(names=["lab.example"], base="http://lab.example") as client:
        assert client.get("/api/form").status_code == 200
        assert client.get("/api/form", headers={"host": "127.0.0.1"}).status_code == 421


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({}, 200),
        ({"origin": "http://127.0.0.1:8737"}, 200),
        ({"origin": "http://127.0.0.1:9999"}, 403),
        ({"origin": "http://localhost:8737"}, 403),
        ({"origin": "https://evil.example"}, 403),
        ({"origin": "null"}, 403),
        ({"origin": "http://["}, 403),
        ({"origin": ""}, 403),
        ({"sec-fetch-site": "same-origin"}, 200),
        ({"sec-fetch-site": "cross-site"}, 403),
        ({"sec-fetch-site": "same-site"}, 403),
    ],
)
def test_it_answers_its_own_page_alone(client, headers, status):
    assert client.get("/api/form", headers=headers).status_code == status


@pytest.mark.parametrize("length", ["-1", "many", "1, 2", "²"])
def test_a_length_that_is_no_number_is_refused(client, length):
    headers = {"content-length": length.encode("latin-1")}
    answer = client.post("/api/read", content=b"schema = 1", headers=headers)
    assert (answer.status_code, answer.json()["error"]["kind"]) == (400, "request")


def test_every_answer_binds_the_browser(client):
    for path in ("/", "/api/form", "/nothing", "/static/main.js"):
        headers = client.get(path).headers
        assert "default-src 'self'" in headers["content-security-policy"]
        assert "frame-ancestors 'none'" in headers["content-security-policy"]
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["cross-origin-resource-policy"] == "same-origin"
        assert "access-control-allow-origin" not in headers
    assert client.get("/api/form", headers={"host": "evil"}).headers["x-content-type-options"]


@pytest.mark.parametrize(
    "path",
    [
        "/static/..%2f..%2fapp.py",
        "/static/%2e%2e/app.py",
        "/static//etc/passwd",
        "/static/%00",
        "/static/" + "a" * 5000,
        "/static/vendor",
        "/api/cases/..%2f..%2fapp.py",
        "/api/cases/%2fetc%2fpasswd",
        "/api/cases/%00",
        "/etc/passwd",
    ],
)
def test_no_path_leads_out_of_the_page(client, path):
    answer = client.get(path)
    assert answer.status_code == 404
    assert answer.json()["error"]["kind"] == "request"


def test_all_that_the_page_loads_is_its_own(client):
    page = client.get("/")
    assert page.headers["content-type"] == "text/html; charset=utf-8"
    assert "http://" not in page.text
    assert "https://" not in page.text
    for name in ("main.js", "form.js", "page.css", "vendor/uPlot.iife.min.js"):
        assert client.get(f"/static/{name}").status_code == 200
