"""What the server answers, in OpenAPI's terms."""

from __future__ import annotations

from typing import Any

from asperity.config import BUILTINS
from asperity.config.case_file import builtin_text, tables
from asperity.web.exploring import FILES

_TEXT = {"type": "string", "maxLength": 100}

_ASKED: dict[str, Any] = {
    "type": "object",
    "required": ["case"],
    "additionalProperties": False,
    "properties": {
        "case": {"type": "object", "description": "The tables of a case, as in its file."},
        "name": _TEXT,
        "asker": {**_TEXT, "description": "Of one asker only the newest request is answered."},
        "surfaces": {"type": "object", "additionalProperties": _TEXT},
    },
}

_SURFACE = "# size[um] 1 1\n# unit nm\n1 2\n2 1\n"
_TOML = builtin_text(BUILTINS[0])
_CASES = {name: tables(builtin_text(name), None) for name in BUILTINS}
_EXAMPLES = {name: {"value": {"case": case}} for name, case in _CASES.items()}
_CHANGES = {name: {"value": {"case": case, "before": case}} for name, case in _CASES.items()}

_REFUSAL: dict[str, Any] = {
    "type": "object",
    "required": ["error"],
    "properties": {
        "error": {
            "type": "object",
            "required": ["kind", "key", "message"],
            "properties": {
                "kind": {"enum": ["input", "numerics", "output", "busy", "request", "program"]},
                "key": {"type": ["string", "null"]},
                "message": {"type": "string"},
                "problems": {
                    "type": "array",
                    "description": "All that is wrong, the first of them first.",
                    "items": {
                        "type": "object",
                        "required": ["key", "message"],
                        "properties": {
                            "key": {"type": ["string", "null"]},
                            "message": {"type": "string"},
                        },
                    },
                },
            },
        }
    },
}

_CHANGED: dict[str, Any] = {
    "type": "object",
    "required": ["case", "before"],
    "additionalProperties": False,
    "properties": {
        "case": {"type": "object", "description": "The tables of a case after a choice."},
        "before": {"type": "object", "description": "The same before it."},
    },
}


def _json(schema: dict[str, Any], description: str) -> dict[str, Any]:
    return {"description": description, "content": {"application/json": {"schema": schema}}}


_REFUSALS = {
    str(status): _json(_REFUSAL, words)
    for status, words in (
        (400, "No request of HTTP."),
        (403, "From a page of somebody else's."),
        (404, "There is no such thing."),
        (405, "Not to be asked in this way."),
        (408, "It came too slowly."),
        (409, "A newer request of the same asker came."),
        (413, "Too long."),
        (421, "By a name that is not this server's."),
        (422, "The case, or the request, is refused."),
        (503, "Too much is being asked."),
        (507, "The disk is full."),
    )
}


def _posting(
    summary: str, body: dict[str, Any], answer: dict[str, Any], *parameters: dict[str, Any]
) -> dict[str, Any]:
    return {
        "post": {
            "summary": summary,
            "parameters": list(parameters),
            "requestBody": {"required": True, **body},
            "responses": {"200": answer, **_REFUSALS},
        }
    }


def _asking(summary: str, answer: dict[str, Any], *parameters: dict[str, Any]) -> dict[str, Any]:
    return _posting(summary, _in_json(_ASKED, _EXAMPLES), answer, *parameters)


def _in_json(schema: dict[str, Any], examples: dict[str, Any]) -> dict[str, Any]:
    return {"content": {"application/json": {"schema": schema, "examples": examples}}}


def _getting(summary: str, *more: dict[str, Any]) -> dict[str, Any]:
    answer = _json({"type": "object"}, summary)
    responses = {"200": answer, **_REFUSALS}
    return {"get": {"summary": summary, "parameters": list(more), "responses": responses}}


def _in_path(schema: dict[str, Any], example: str) -> dict[str, Any]:
    return {"name": "name", "in": "path", "required": True, "schema": schema, "example": example}


def _any(kind: str, **more: str) -> dict[str, Any]:
    return {"content": {kind: {"schema": {"type": "string"}, **more}}}


DESCRIPTION: dict[str, Any] = {
    "openapi": "3.1.0",
    "info": {"title": "asperity", "version": "1", "license": {"name": "MIT"}},
    "paths": {
        "/api/form": _getting("The case schema as a form."),
        "/api/map": _getting("The lines of the adhesion map."),
        "/api/cases/{name}": _getting(
            "The tables of a case.", _in_path({"type": "string"}, BUILTINS[0])
        ),
        "/api/toml": _asking("The case as text.", _json({"type": "object"}, "The text.")),
        "/api/complete": _posting(
            "A case with the keys that a choice of its user asks for.",
            _in_json(_CHANGED, _CHANGES),
            _json({"type": "object"}, "Its tables, and what would mend what is left."),
        ),
        "/api/explore": _asking(
            "Compute a case.",
            {
                "description": "Progress and the answer, a line each.",
                **_any("application/x-ndjson"),
            },
        ),
        "/api/critical": _asking(
            "The critical velocity of a case.",
            _json({"type": "object"}, "It, all edges of capture, and a note."),
        ),
        "/api/files/{name}": _asking(
            "A file of a case's results.",
            {"description": "The file.", "content": {kind: {} for kind in {*FILES.values()}}},
            _in_path({"enum": list(FILES)}, "motion.csv"),
        ),
        "/api/read": _posting(
            "The tables of a case file.",
            _any("text/plain", example=_TOML),
            _json({"type": "object"}, "The tables."),
        ),
        "/api/surfaces/{name}": _posting(
            "Keep a surface file.",
            _any("application/octet-stream", example=_SURFACE),
            _json({"type": "object"}, "What it is kept as."),
            _in_path({"type": "string"}, "surface.csv"),
        ),
    },
}
