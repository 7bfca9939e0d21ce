"""What tests of the page's server share."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest

from web_client import client_of

if TYPE_CHECKING:
    from starlette.testclient import TestClient


@pytest.fixture(scope="module")
def client() -> Iterator[TestClient]:
    with client_of() as made:
        yield made


@pytest.fixture(scope="module")
def tables(client: TestClient) -> dict[str, Any]:
    """A rough case on a rigid bulk, of a few impacts."""
    found = client.get("/api/cases/published-exact").json()["tables"]
    return {
        **found,
        "counterface": {**found["counterface"], "deformation": "rigid"},
        "numerics": {"max_impacts": 12},
    }
