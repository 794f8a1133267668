"""Fixtures of the room."""
import pytest

import support
import sample_database


@pytest.fixture
def made(tmp_path):
    """Writes a sample database: made(NAME, *SQL, options of sample_database.make) gives its path."""
    def make(name="site", *sql, machine=None, seconds=20.0, boom=False, **options):
        path = tmp_path / f"{name}.sqlite"
        sample_database.make(path, machine, seconds=seconds, boom=boom, **options)
        if sql:
            support.execute(path, *sql)
        return path
    return make
