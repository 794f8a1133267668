"""Fixtures of the room: a folder with programs, and outcomes of bags that are merged."""
import pytest

import fleet_support


@pytest.fixture
def fleet(tmp_path):
    return fleet_support.Fleet(tmp_path)


@pytest.fixture
def merged(tmp_path):
    return fleet_support.Merged(tmp_path)
