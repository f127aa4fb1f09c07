"""Tests in real containers: `make test-containers` builds the image and runs them; an ordinary run leaves them out."""

import os
from collections.abc import Iterator

import pytest

from tests.containers.engine import Box, Engine

collect_ignore_glob = [] if "IMAGE" in os.environ else ["test_*.py"]


@pytest.fixture(scope="module")
def engine() -> Iterator[Engine]:
    """The engine, with a network of this module's own; what was started in it is gone afterwards."""
    with Engine(os.environ["IMAGE"]) as made:
        yield made


@pytest.fixture
def box(engine: Engine) -> Iterator[Box]:
    """A server as compose.yaml has it, healthy."""
    with engine.server() as made:
        made.wait_healthy()
        yield made
