"""The exceptions of the package."""

from __future__ import annotations

import json
from typing import Any

#: Calls and options that have another name here than in the library's messages.
_NAMES = {"`time_limit`": "`timeout`", "`inspect`": "`findings` of this error", "`integer`": "`integer_map`"}


class SeamstressError(Exception):
    """Why there is no result: what failed, where, and what may help."""

    #: A short name of the kind of failure that stays the same over versions, such as ``not-a-surface``.
    code: str
    #: What was being done, such as ``check`` or ``polish``.
    stage: str | None
    #: The ``vertices``, ``edges`` (by their ends) and ``faces`` that it is about, counted from 0 as in the input.
    elements: dict[str, list[Any]]
    #: What may help.
    hint: str | None
    #: Everything that is wrong, one by one, where a check failed.
    findings: list[dict[str, Any]]

    def __init__(
        self,
        message: str,
        code: str = "options",
        stage: str | None = None,
        elements: dict[str, list[Any]] | None = None,
        hint: str | None = None,
        findings: list[dict[str, Any]] | None = None,
    ) -> None:
        super().__init__(message)
        self.code = code
        self.stage = stage
        self.elements = elements or {"vertices": [], "edges": [], "faces": []}
        self.hint = hint
        self.findings = findings or []

    def __str__(self) -> str:
        message = super().__str__()
        return f"{message}\nhint: {self.hint}" if self.hint else message

    def __reduce__(self) -> tuple[Any, ...]:
        fields = (self.args[0], self.code, self.stage, self.elements, self.hint, self.findings)
        return type(self), fields


class InputError(SeamstressError, ValueError):
    """The input or an option has to change."""


class NoCertifiedMap(SeamstressError, RuntimeError):
    """The method has found no result that it can vouch for."""


class Stopped(SeamstressError, RuntimeError):
    """Stopped before the end, by a limit of time or memory, or by the function that is told of
    progress."""


def made(kind: str, message: str, fields: str) -> SeamstressError:
    """The exception of a kind, with its fields as JSON."""
    kinds = {one.__name__: one for one in (InputError, NoCertifiedMap, Stopped)}
    decoded: dict[str, Any] = json.loads(fields)
    for name, ours in _NAMES.items():
        message = message.replace(name, ours)
        decoded["hint"] = (decoded.get("hint") or "").replace(name, ours) or None
    return kinds[kind](message, **decoded)
