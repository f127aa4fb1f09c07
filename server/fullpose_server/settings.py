"""Settings of one server: a class, built by whoever starts it and passed in. Environment: FULLPOSE_HOST and so on."""

import ipaddress
import os
from pathlib import Path
from typing import Annotated

from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict


def default_data_dir() -> Path:
    """Where data goes unless told otherwise: $XDG_DATA_HOME/fullpose, by default ~/.local/share/fullpose."""
    root = os.environ.get("XDG_DATA_HOME")
    return (Path(root) if root else Path.home() / ".local" / "share") / "fullpose"


Port = Annotated[int, Field(ge=1, le=65535)]


class Settings(BaseSettings):
    """What a server is told at its start."""

    model_config = SettingsConfigDict(env_prefix="FULLPOSE_", frozen=True, extra="forbid")

    host: str = "127.0.0.1"
    port: int = Field(default=8642, ge=0, le=65535)
    data_dir: Path = Field(default_factory=default_data_dir)
    allow_unauthenticated_network: bool = False  # listen beyond loopback though no users are configured
    allowed_hosts: tuple[str, ...] = ()  # names, beside localhost and addresses, that browsers may reach this server by
    allowed_origins: tuple[str, ...] = ()  # pages of other origins that may use the API
    max_upload_bytes: int = Field(default=512 * 1024 * 1024, gt=0)
    max_solve_samples: int = Field(default=1_000_000, gt=0)
    max_connections: int = Field(default=2000, gt=0)  # served at once; fewer where the system allows fewer files
    rig_rate_hz: float = Field(default=1000.0, ge=100.0, le=4000.0)  # as `RigConfig` has it
    live_udp_ports: dict[str, Port] = {}  # rig name to the port where its live source is heard, on loopback
    live_delay_ms: float = Field(
        default=5.0, ge=0.0, le=1000.0
    )  # flown that much late: jitter up to it is interpolated
    live_extrapolate_ms: float = Field(default=50.0, gt=0.0, le=2000.0)  # bridged; then the source is lost
    stop_rigs_on_exit: bool = True  # at an orderly end; a server that is killed leaves its rigs to be adopted again

    @property
    def loopback(self) -> bool:
        """Whether the server listens on this machine only."""
        return is_loopback(self.host)


def is_loopback(host: str) -> bool:
    """Whether a host name or address is this machine's own."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False
