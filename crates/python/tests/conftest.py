from __future__ import annotations

from pathlib import Path

import pytest

import seamstress_mesh as sm

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def samples() -> Path:
    return ROOT / "samples"


@pytest.fixture(scope="session")
def spot(samples: Path) -> sm.Surface:
    return sm.read(samples / "spot.obj")


@pytest.fixture(scope="session")
def spot_map(spot: sm.Surface) -> sm.SeamlessMap:
    return spot.parametrize()
