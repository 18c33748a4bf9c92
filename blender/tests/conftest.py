# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender as a module, with the extension registered from its sources and an empty scene for each test."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import bpy  # noqa: E402


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    session.config.stash["status"] = exitstatus


def pytest_unconfigure(config: pytest.Config) -> None:
    # Blender as a module may hang when Python takes it down.
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(int(config.stash.get("status", 1)))


@pytest.fixture(autouse=True)
def scene() -> Iterator[bpy.types.Scene]:
    """An empty scene."""
    import seamstress

    bpy.ops.wm.read_factory_settings(use_empty=True)
    seamstress.register()
    yield bpy.context.scene
    seamstress.unregister()
