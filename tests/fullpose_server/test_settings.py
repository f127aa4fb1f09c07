"""Settings of a server: what cannot be is refused at its start."""

import pytest
from pydantic import ValidationError

from fullpose_server.settings import Settings


@pytest.mark.parametrize("port", [-5, 0, 65536])
def test_a_live_source_has_a_port_that_there_is(port: int) -> None:
    assert Settings(live_udp_ports={"bench": 7460}).live_udp_ports == {"bench": 7460}
    with pytest.raises(ValidationError, match="live_udp_ports"):
        Settings(live_udp_ports={"bench": port})
