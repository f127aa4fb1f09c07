"""Settings of one server: a class, built by whoever starts it and passed in. Environment: FULLPOSE_HOST and so on."""

import ipaddress
import os
from pathlib import Path
from typing import Annotated, Self
from urllib.parse import urlsplit

from pydantic import Field, SecretStr, field_validator, model_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

from fullpose_server.location import DATABASE, Location, PostgresqlUrl
from fullpose_server.logs import LogFormat, LogLevel, LogSettings
from fullpose_server.people.roles import Role


def default_data_dir() -> Path:
    """Where data goes unless told otherwise: $XDG_DATA_HOME/fullpose, by default ~/.local/share/fullpose."""
    root = os.environ.get("XDG_DATA_HOME")
    return (Path(root) if root else Path.home() / ".local" / "share") / "fullpose"


Port = Annotated[int, Field(ge=1, le=65535)]
Positive = Annotated[int, Field(gt=0)]
MIB = 1024 * 1024


class Settings(BaseSettings):
    """What a server is told at its start."""

    model_config = SettingsConfigDict(env_prefix="FULLPOSE_", frozen=True, extra="forbid")

    host: str = "127.0.0.1"
    port: int = Field(default=8642, ge=0, le=65535)
    data_dir: Path = Field(default_factory=default_data_dir)
    database_url: SecretStr | None = None  # of a PostgreSQL; None: SQLite, in the data folder
    session_hours: float = Field(default=12.0, gt=0.0, le=720.0)  # of a person who signed in with a browser
    oidc_issuer: str | None = Field(default=None, pattern=r"^https?://[^?#\s]+$")  # people sign in there as well
    oidc_client_id: str = ""
    oidc_client_secret: SecretStr | None = None
    oidc_name: str = "single sign-on"  # what the console calls it
    oidc_scope: str = "openid profile email"
    oidc_name_claim: str = "preferred_username"  # who they are here
    oidc_role_claim: str = "groups"  # what their role follows from: one word, or a list of them
    oidc_roles: dict[str, Role] = {}  # {"fms-operators": "operator"}: of several the highest
    oidc_default_role: Role | None = None  # of who has none of these; None: they are not let in
    trusted_proxies: tuple[str, ...] = ("127.0.0.1", "::1")  # who may say for whom they ask (X-Forwarded-For, -Proto)
    allowed_hosts: tuple[str, ...] = ()  # names, beside localhost and addresses, that browsers may reach this server by
    allowed_origins: tuple[str, ...] = ()  # pages of other origins that may use the API
    # What one request may cost, and all of them together. Beyond it the answer is 413, 422, 429 or 507, and says so.
    max_body_bytes: Positive = MIB  # of a request that is neither an upload nor a batch to solve
    max_upload_bytes: Positive = 512 * MIB
    max_upload_rows: Positive = 1_000_000  # a quarter of an hour at 1 kHz
    max_upload_columns: Positive = 256
    max_upload_memory_bytes: Positive = 320 * MIB  # of the process that reads an upload or solves a batch
    max_upload_s: float = Field(default=60.0, gt=0.0)  # that it may take for one
    max_json_bytes: Positive = 16 * MIB  # of a flight or a batch to solve, sent as JSON
    max_solve_samples: Positive = 100_000
    max_plan_samples: Positive = 7_200_000  # of a flight at the rig's rate: two hours at 1 kHz
    max_queued_jobs: Positive = 64  # plans, and as many comparisons
    max_queued_jobs_per_client: Positive = 16
    max_page_rows: Positive = 1000  # of a list, in one answer
    max_message_bytes: Positive = MIB  # of a WebSocket
    max_websockets: Positive = 600
    max_connections: Positive = 2000  # served at once; fewer where the system allows fewer files
    max_idle_s: float = Field(default=30.0, gt=0.0)  # of a client that owes the rest of its request
    disk_alarm_bytes: int = Field(default=2048 * MIB, ge=0)  # less left: health is degraded
    disk_reserve_bytes: int = Field(default=256 * MIB, ge=0)  # less left: uploads, plans and exports are refused
    keep_runs_days: float | None = Field(default=None, gt=0.0)  # older records go; None: they stay. Pinned ones stay
    keep_runs_bytes: Positive | None = None  # of all records together: beyond it the oldest go
    keep_alarms_days: float | None = Field(default=None, gt=0.0)  # older alarms leave the history; None: they stay
    keep_alarms: Positive | None = 100_000  # of all rigs together: beyond it the oldest go
    log_format: LogFormat = LogFormat.TEXT
    log_level: LogLevel = LogLevel.WARNING
    rig_rate_hz: float = Field(default=1000.0, ge=100.0, le=4000.0)  # as `RigConfig` has it
    live_udp_ports: dict[str, Port] = {}  # rig name to the port where its live source is heard, on loopback
    live_delay_ms: float = Field(
        default=5.0, ge=0.0, le=1000.0
    )  # flown that much late: jitter up to it is interpolated
    live_extrapolate_ms: float = Field(default=50.0, gt=0.0, le=2000.0)  # bridged; then the source is lost
    live_max_rate_deg_s: float | None = Field(
        default=None, gt=0.0
    )  # of a sample that is used; None: what the rig can do
    spare_rig_process: bool = True  # one in reserve: a rig whose process dies is back in a second, not in ten
    stop_rigs_on_exit: bool = True  # at an orderly end; a server that is killed leaves its rigs to be adopted again

    @model_validator(mode="after")
    def _provider(self) -> Self:
        if self.oidc_issuer is None:
            return self
        if not self.oidc_client_id:
            raise ValueError("oidc_issuer is set: expected oidc_client_id as well")
        where = urlsplit(self.oidc_issuer)
        if where.scheme != "https" and not is_loopback(where.hostname or ""):
            raise ValueError("oidc_issuer: expected https, or an address of this machine")
        return self

    @field_validator("database_url")
    @classmethod
    def _database_url(cls, url: SecretStr | None) -> SecretStr | None:
        if url is not None:
            PostgresqlUrl.of(url.get_secret_value())  # raises ValueError
        return url

    @property
    def database(self) -> Location:
        """Where the rows are."""
        if self.database_url is None:
            return self.data_dir / DATABASE
        return PostgresqlUrl.of(self.database_url.get_secret_value())

    @property
    def log(self) -> LogSettings:
        """How the server's processes log."""
        return LogSettings(self.log_format, self.log_level)

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
