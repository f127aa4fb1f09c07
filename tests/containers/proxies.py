"""Caddy in front of a server's container, as compose.yaml has it, and a client that trusts it."""

import ssl
from dataclasses import dataclass

from fullpose_server.client import Client
from tests.containers.composed import arguments
from tests.containers.engine import PEERS, Box, Engine, podman
from tests.support.waiting import until

CADDY = {"distribution": "/usr/bin/caddy", "current": "/opt/current/bin/caddy"}
ROOT_CERTIFICATE = "/data/caddy/pki/authorities/local/root.crt"


@dataclass(frozen=True)
class Proxy:
    """Where it is, and its authority's root certificate (PEM)."""

    port: int
    root: str
    tokens: dict[str, str]

    @property
    def tls(self) -> ssl.SSLContext:
        """Trusts this proxy's authority, and no other."""
        return ssl.create_default_context(cadata=self.root)

    @property
    def url(self) -> str:
        """Of the site."""
        return f"https://localhost:{self.port}"

    def client(self, role: str | None = "admin") -> Client:
        """By TLS, with the token of a person of that role; None: a stranger."""
        token = None if role is None else self.tokens[role]
        return Client(self.url, timeout_s=120.0, token=token, tls=self.tls)


def proxied(engine: Engine, server: Box, which: str) -> Proxy:
    """The Caddy `which` before a server, once it has a certificate."""
    volumes = engine.volumes("caddy_data", "caddy_config")
    options = (
        *arguments("caddy", volumes),
        *("--add-host", f"fullpose:{server.address}", "--publish", "127.0.0.1::443"),
        *("--env", "XDG_DATA_HOME=/data", "--env", "XDG_CONFIG_HOME=/config"),  # as Caddy's own image has them
    )
    command = (CADDY[which], "run", "--config", "/etc/caddy/Caddyfile", "--adapter", "caddyfile")
    box = engine.start(PEERS, *options, command=command)
    root = until(lambda: box.run("cat", ROOT_CERTIFICATE).stdout, every_s=0.2)
    return Proxy(int(podman("port", box.name, "443").rsplit(":", 1)[1]), root, server.tokens)
