"""The container's files against the repository: no engine is needed to see that what they name exists."""

import fnmatch
import json
import re
import runpy
import shlex
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

from fullpose.registry import method_names
from fullpose_server.settings import Settings, is_loopback
from tests.support.repository import ROOT

DOCKER = ROOT / "docker"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
FIELDS = {f"FULLPOSE_{name.upper()}" for name in Settings.model_fields}


def instructions() -> list[tuple[str, str]]:
    """(instruction, arguments) of the Dockerfile, lines joined."""
    text = re.sub(r"\\\n", " ", (DOCKER / "Dockerfile").read_text())
    lines = [line.strip() for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    return [(line.split(None, 1)[0], line.split(None, 1)[1]) for line in lines]


def arguments(name: str) -> list[str]:
    return [text for instruction, text in instructions() if instruction == name]


def compose() -> dict[str, Any]:
    loaded: dict[str, Any] = yaml.safe_load((DOCKER / "compose.yaml").read_text())
    return loaded


def default(text: str) -> str:
    """A compose value with nothing set in the environment."""
    return re.sub(r"\$\{\w+:-(.*?)\}", r"\1", text)


def environment() -> dict[str, str]:
    """What the Dockerfile sets."""
    return dict(pair.split("=", 1) for text in arguments("ENV") for pair in shlex.split(text))


def ignored(path: str) -> bool:
    """Whether .dockerignore keeps the path out of the build; the last pattern that fits decides."""
    out = False
    for line in (ROOT / ".dockerignore").read_text().split():
        pattern = line.removeprefix("!").rstrip("/")
        parents = [path, *(str(parent) for parent in Path(path).parents if str(parent) != ".")]
        if any(fnmatch.fnmatch(p, pattern) or fnmatch.fnmatch(f"/{p}", pattern.replace("**", "*")) for p in parents):
            out = not line.startswith("!")
    return out


def test_everything_copied_exists_and_reaches_the_build() -> None:
    copied = []
    for text in arguments("COPY"):
        words = [word for word in shlex.split(text) if not word.startswith("--")]
        if "--from=" not in text:
            copied += words[:-1]
    assert {"pyproject.toml", "server/", "solver/", "web/", "docker/warm.py", "docker/init.py"} <= set(copied)
    for path in copied:
        assert (ROOT / path).exists(), path
        assert not ignored(path.rstrip("/")), f"{path} is kept out by .dockerignore"


def test_the_wheels_own_files_are_copied() -> None:
    """What pyproject.toml points the build at is in the build stage."""
    copied = {word.rstrip("/") for text in arguments("COPY") for word in shlex.split(text)}
    build = PROJECT["tool"]["hatch"]["build"]
    for path in (
        PROJECT["project"]["readme"],
        *PROJECT["project"]["license-files"],
        *build["targets"]["wheel"]["packages"],
        build["hooks"]["custom"]["path"],
    ):
        assert copied & {path, *map(str, Path(path).parents)}, path


@pytest.mark.parametrize(
    ("path", "out"),
    [
        ("server/fullpose_server/app.py", False),
        ("server/fullpose_server/demo_flights/loop_and_roll.csv", False),
        ("web/src/main.ts", False),
        ("web/node_modules/vite/package.json", True),
        ("server/fullpose_server/console/index.html", True),
        ("server/__pycache__/app.cpython-311.pyc", True),
        (".git/config", True),
        (".venv/bin/python", True),
        ("tests/docker/test_docker.py", True),
    ],
)
def test_build_context(path: str, out: bool) -> None:
    assert ignored(path) is out


def test_base_image_is_an_argument_of_all_stages_but_the_last_which_begins_with_nothing() -> None:
    assert instructions()[0][0] == "ARG"
    assert instructions()[0][1].startswith("BASE_IMAGE=python:3.")
    assert [text.split()[0] for text in arguments("FROM")] == ["${BASE_IMAGE}", "${BASE_IMAGE}", "scratch"]
    minimum = tuple(map(int, PROJECT["project"]["requires-python"].removeprefix(">=").split(".")))
    image = re.search(r"python:(\d+)\.(\d+)", instructions()[0][1])
    assert image is not None
    assert (int(image[1]), int(image[2])) >= minimum


def test_runs_the_command_that_is_installed_as_a_user_without_rights() -> None:
    entry = json.loads(arguments("ENTRYPOINT")[0])
    assert entry[-1] in PROJECT["project"]["scripts"]
    copied = [text.split() for text in arguments("COPY")]
    assert ["docker/init.py", entry[1]] in copied  # the first process, which tests/docker/test_init.py runs
    assert compose()["services"]["fullpose"]["init"] is False
    assert json.loads(arguments("CMD")[-1]) == ["serve"]
    order = [name for name, _ in instructions()]
    assert order.index("USER") < order.index("ENTRYPOINT")
    assert arguments("USER") == ["fullpose"]
    assert "useradd --system --uid 10001" in " ".join(arguments("RUN"))


def test_environment_is_what_the_settings_read(monkeypatch: pytest.MonkeyPatch) -> None:
    said = compose()["services"]["fullpose"]["environment"]
    service = {key: default(value) for key, value in said.items() if value is not None}
    both = environment() | service
    ours = {key for key in both if key.startswith("FULLPOSE_")}
    assert ours <= FIELDS
    for key in ours:
        monkeypatch.setenv(key, both[key])
    settings = Settings()
    assert not settings.loopback
    assert settings.allowed_hosts == ("fullpose",)
    assert str(settings.data_dir) in arguments("VOLUME")
    assert str(settings.port) in arguments("EXPOSE")


def test_health_check_is_the_file_that_is_copied() -> None:
    check = arguments("HEALTHCHECK")[0]
    command = json.loads(check[check.index("[") :])
    assert ["docker/health.py", command[1]] in [text.split() for text in arguments("COPY")]


def test_compose_publishes_to_this_machine_only_and_gives_no_rights() -> None:
    services = compose()["services"]
    for name, service in services.items():
        assert service["read_only"] is True, name
        assert service["cap_drop"] == ["ALL"], name
        for port in service.get("ports", []):
            address = default(port).split(":")[0]
            assert is_loopback(address), f"{name} publishes {port}"
    published = default(services["fullpose"]["ports"][0]).split(":")
    assert published[2] == environment()["FULLPOSE_PORT"]


def test_compose_builds_the_dockerfile_and_keeps_the_data() -> None:
    loaded = compose()
    service = loaded["services"]["fullpose"]
    context = DOCKER / service["build"]["context"]
    assert (context / service["build"]["dockerfile"]).resolve() == DOCKER / "Dockerfile"
    mounts = dict(volume.split(":") for volume in service["volumes"])
    assert set(mounts) <= set(loaded["volumes"])
    assert sorted(mounts.values()) == sorted(arguments("VOLUME"))
    assert environment()["NUMBA_CACHE_DIR"] in mounts.values()
    assert service["cap_add"] == ["SYS_NICE"]
    assert service["ulimits"]["rtprio"] > 0
    assert service["ulimits"]["memlock"] == -1


def test_a_postgresql_is_in_the_profile_and_nobody_else_waits_for_it() -> None:
    services = compose()["services"]
    assert services["postgresql"]["profiles"] == ["postgresql"]
    assert "ports" not in services["postgresql"]  # the server's alone
    assert services["fullpose"]["depends_on"]["postgresql"] == {"condition": "service_healthy", "required": False}
    assert services["fullpose"]["environment"]["FULLPOSE_DATABASE_URL"] is None
    assert "database_url" in Settings.model_fields
    volume, where = services["postgresql"]["volumes"][0].split(":")
    assert volume in compose()["volumes"]
    assert where.startswith("/var/lib/postgresql")
    assert "[postgresql]" in (DOCKER / "Dockerfile").read_text()


def test_caddy_reaches_the_service() -> None:
    caddyfile = (DOCKER / "Caddyfile").read_text()
    loaded = compose()["services"]
    upstream = re.search(r"reverse_proxy (\w+):(\d+)", caddyfile)
    assert upstream is not None
    assert upstream[1] in loaded
    assert upstream[2] == environment()["FULLPOSE_PORT"]
    assert set(re.findall(r"{\$(\w+)}", caddyfile)) <= set(loaded["caddy"]["environment"])
    assert loaded["caddy"]["profiles"] == ["network"]
    assert "./Caddyfile:/etc/caddy/Caddyfile:ro" in loaded["caddy"]["volumes"]


@pytest.mark.slow
def test_warming_runs_every_method(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["warm.py"])
    runpy.run_path(str(DOCKER / "warm.py"), run_name="__main__")
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(":")[0] for line in lines[:-2]] == list(method_names())
    assert lines[-2].startswith("loop and drive in ")
    assert lines[-1].startswith("diagnosis and tolerance in ")


def test_the_service_runs_what_is_installed_with_settings_that_there_are() -> None:
    text = (DOCKER / "fullpose.service").read_text()
    said = [line.split("=", 1) for line in text.splitlines() if "=" in line and not line.startswith("#")]
    of = {key: value for key, value in said if key != "Environment"}
    assert of["ExecStart"].split("/")[-1] == "fullpose serve"
    assert of["ExecStartPre"].split("/")[-1] == "fullpose config check"
    assert of["KillMode"] == "process"  # or systemd would end the rigs with a server that died
    variables = {value.split("=", 1)[0] for key, value in said if key == "Environment"}
    assert {name for name in variables if name.startswith("FULLPOSE_")} <= FIELDS | {"FULLPOSE_CONFIG"}
