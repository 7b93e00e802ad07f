"""Give every validation test the `record` fixture."""

import pytest

from validation_record import Record


@pytest.fixture
def record(request: pytest.FixtureRequest) -> Record:
    return Record(request)
