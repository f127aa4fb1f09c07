"""Settings from the command line, the environment and a file: which one counts, and that a misspelt one is an error."""

import os
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fullpose_server.cli import build
from fullpose_server.cli._configuration import ConfigurationError, configured, to_serve
from fullpose_server.errors import FileError
from fullpose_server.settings import Settings


@pytest.fixture(autouse=True)
def _nothing_set(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in list(os.environ):
        if name.upper().startswith("FULLPOSE_"):
            monkeypatch.delenv(name)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    made = tmp_path / "fullpose.toml"
    made.write_text('port = 7001\nrig_rate_hz = 500.0\nlive_udp_ports = {bench = 7460}\ndata_dir = "/tmp/there"\n')
    return made


def test_the_command_line_comes_before_the_environment_and_that_before_the_file(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = configured(config=file)
    assert (found.settings.port, found.settings.rig_rate_hz) == (7001, 500.0)
    assert found.settings.live_udp_ports == {"bench": 7460}
    assert found.origins["port"] == f"port in {file}"
    monkeypatch.setenv("FULLPOSE_PORT", "7002")
    found = configured(config=file)
    assert (found.settings.port, found.origins["port"]) == (7002, "FULLPOSE_PORT")
    assert found.settings.rig_rate_hz == 500.0
    found = configured(port=7003, config=file)
    assert (found.settings.port, found.origins["port"]) == (7003, "--port")
    monkeypatch.setenv("FULLPOSE_CONFIG", str(file))
    assert configured().settings.rig_rate_hz == 500.0


def test_a_misspelt_setting_is_an_error_that_says_what_was_meant(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FULLPOSE_MAX_BODY_BYTE", "1000")
    with pytest.raises(ConfigurationError, match=r"FULLPOSE_MAX_BODY_BYTE: .*did you mean FULLPOSE_MAX_BODY_BYTES"):
        configured()
    monkeypatch.delenv("FULLPOSE_MAX_BODY_BYTE")
    file = tmp_path / "settings.toml"
    file.write_text("prot = 7000\n")
    with pytest.raises(ConfigurationError, match=r"prot in .*settings\.toml: .*did you mean port"):
        configured(config=file)
    file.write_text("[server]\nport = 7000\n")
    with pytest.raises(ConfigurationError, match="server in"):
        configured(config=file)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("port = 99999\n", "port in .* = 99999: expected less than"),
        ('rig_rate_hz = "fast"\n', "rig_rate_hz in .* = 'fast': expected a valid number"),
        ("live_udp_ports = {bench = 0}\n", r"live_udp_ports in .*\.bench = 0: expected"),
        ('host = "0.0.0.0"\n', "host in .* = 0.0.0.0: no users are configured"),
    ],
)
def test_what_cannot_be_is_named_where_it_was_set(tmp_path: Path, text: str, word: str) -> None:
    file = tmp_path / "settings.toml"
    file.write_text(text)
    with pytest.raises(ConfigurationError, match=word):
        to_serve(configured(config=file, data_dir=tmp_path))


def test_a_file_that_is_none_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="No such file"):
        configured(config=tmp_path / "missing.toml")
    (tmp_path / "broken.toml").write_text("port = \n")
    with pytest.raises(FileError, match=r"broken\.toml: expected TOML .*line 1"):
        configured(config=tmp_path / "broken.toml")


def test_config_check_prints_a_file_that_gives_the_same_settings(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FULLPOSE_ALLOWED_HOSTS", '["fly.example.org"]')
    ran = CliRunner().invoke(build(), ["config", "check", "--config", str(file)])
    assert ran.exit_code == 0, ran.output
    read = tomllib.loads(ran.stdout)
    monkeypatch.delenv("FULLPOSE_ALLOWED_HOSTS")
    assert Settings(**read) == configured(config=file).settings.model_copy(
        update={"allowed_hosts": ("fly.example.org",)}
    )
    (origin,) = [line for line in ran.stdout.splitlines() if line.startswith("allowed_hosts")]
    assert origin.endswith("# FULLPOSE_ALLOWED_HOSTS")
    (unset,) = [line for line in ran.stdout.splitlines() if "keep_runs_days" in line]
    assert unset.startswith("# keep_runs_days is unset")
