"""The server of the page without a network, asked as the page asks it."""

from __future__ import annotations

import json
import warnings
from typing import Any

from asperity.web.app import application

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # it would rather have another client
    from starlette.testclient import TestClient


def client_of(*given: Any, base: str = "http://127.0.0.1:8737", **more: Any) -> TestClient:
    """A client of an application."""
    return TestClient(application(*given, **more), base_url=base)


def page_of(client: TestClient) -> Any:
    """What the routes share."""
    app: Any = client.app
    return app.routes[0].endpoint.__self__


def strict(text: str | bytes) -> Any:
    """What JSON says that holds neither NaN nor infinity."""

    def refuse(constant: str) -> None:
        raise AssertionError(constant)

    return json.loads(text, parse_constant=refuse)


def told(client: TestClient, tables: dict[str, Any], **more: Any) -> list[dict[str, Any]]:
    """Lines of the answer to a case, the last of which ends it."""
    question = {"case": tables, "name": "drop", **more}
    answer = client.post("/api/explore", json=question)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"].startswith("application/x-ndjson")
    return [strict(line) for line in answer.text.splitlines()]


def refusal(client: TestClient, path: str, status: int = 422, **sent: Any) -> dict[str, Any]:
    """The error of a question that is refused in a line."""
    answer = client.post(path, **sent)
    assert answer.status_code == status, answer.text
    error: dict[str, Any] = strict(answer.content)["error"]
    assert "\n" not in error["message"]
    assert "Traceback" not in answer.text
    return error
