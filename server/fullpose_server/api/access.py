"""Which role a request needs: the one place. What is not named here needs an operator to change, a viewer to see."""

from starlette.types import Scope

from fullpose_server.api.origin import SAFE, is_stop
from fullpose_server.api.paths import API, of_rig
from fullpose_server.people.roles import Role

# What is answered to anybody: whether one must sign in, and how; that the server lives; the console's own files.
PUBLIC = frozenset(
    {
        ("GET", f"{API}/me"),
        ("GET", f"{API}/alive"),
        ("POST", f"{API}/login"),
        ("GET", f"{API}/login/provider"),
        ("GET", f"{API}/login/provider/answer"),
    }
)
_ADMIN = (f"{API}/users",)
# What changes nothing but the person's own: it needs a person, of whatever role.
_OWN = frozenset({f"{API}/logout", f"{API}/me/password", f"{API}/tokens", f"{API}/solve"})
_OWN_BELOW = (f"{API}/tokens/",)
# A command may be a stop, which anybody signed in may give: its route asks for the operator (`routes.sessions`).
_ASKED_LATER = "commands"


def needed(scope: Scope) -> Role | None:
    """The role that a request or WebSocket needs; None: none, not even a person."""
    # A route ends with `$` in Starlette, which a line feed may follow: /users%0A is /users.
    path = str(scope["path"]).removesuffix("\n")
    if scope["type"] == "websocket":
        return Role.OPERATOR if _is_live(path) else Role.VIEWER
    method = str(scope["method"])
    if (method, path) in PUBLIC or _is_console(method, path):
        return None
    if path in _ADMIN or path.startswith(tuple(f"{each}/" for each in _ADMIN)):
        return Role.ADMIN
    if method in SAFE or is_stop(scope) or path in _OWN or path.startswith(_OWN_BELOW):
        return Role.VIEWER
    target = of_rig(path)
    return Role.VIEWER if target is not None and target[1] == _ASKED_LATER else Role.OPERATOR


def _is_live(path: str) -> bool:
    target = of_rig(path)
    return target is not None and target[1] == "live"


def _is_console(method: str, path: str) -> bool:
    """A file of the console, which asks who is there before it shows anything; the API's page is none."""
    served = ("/api/", "/scene/", "/metrics")
    return method in SAFE and not path.startswith(served) and path not in ("/api", "/scene")
