"""Where a server's rows are: in a file of its data folder, or in a PostgreSQL that a URL names."""

from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import parse_qsl, urlencode, urlsplit, urlunsplit

DATABASE = "fullpose.db"  # SQLite's, in a data folder
EVIDENCE_KEY = "evidence.key"  # in a data folder: what its server signs evidence with
SCHEMES = ("postgresql", "postgresql+psycopg", "postgres")
EXPECTED = "postgresql://USER:PASSWORD@HOST:PORT/DATABASE"


@dataclass(frozen=True)
class PostgresqlUrl:
    """`url` is as libpq takes it, with the password where it has one; as text it has none."""

    url: str = field(repr=False)

    @classmethod
    def of(cls, text: str) -> "PostgresqlUrl":
        """Read a URL as SQLAlchemy writes them. Raises ValueError, which does not repeat it: it may have a password."""
        parts = urlsplit(text.strip())
        if parts.scheme not in SCHEMES:
            raise ValueError(f"expected {EXPECTED}, not the scheme {parts.scheme[:20]!r}")
        if not parts.path.strip("/"):
            raise ValueError(f"expected {EXPECTED}, it names no database")
        _ = parts.port  # raises ValueError for one that cannot be
        # Built by hand: urlunsplit leaves an empty host out with its slashes, and libpq wants them.
        rest = urlunsplit(("", "", parts.path, parts.query, ""))
        return cls(f"postgresql://{parts.netloc}{rest}")

    def __str__(self) -> str:
        parts = urlsplit(self.url)
        user, _, host = parts.netloc.rpartition("@")
        shown = f"{user.partition(':')[0]}@{host}" if user else host
        said = urlencode([pair for pair in parse_qsl(parts.query) if "password" not in pair[0]], safe="/")
        return f"postgresql://{shown}{parts.path}{'?' if said else ''}{said}"


NO_DRIVER = "a PostgreSQL is set, and psycopg is not installed: pip install 'fullpose[postgresql]'"
Location = Path | PostgresqlUrl
