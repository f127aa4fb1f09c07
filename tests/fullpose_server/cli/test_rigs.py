"""`fullpose rigs`: a table, a built-in rig as a rig file, a file checked with its drive."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from fullpose.rig import builtin_rigs
from fullpose_server.cli import build
from fullpose_server.errors import FileError, NotFoundError


def run(*arguments: str | Path) -> tuple[int, str, BaseException | None]:
    result = CliRunner().invoke(build(), ["rigs", *map(str, arguments)])
    return result.exit_code, result.output, result.exception


def test_without_a_name_every_built_in_rig_is_listed() -> None:
    code, output, _ = run()
    assert code == 0
    assert [line.split(":")[0] for line in output.splitlines() if ":" in line] == list(builtin_rigs())


@pytest.mark.parametrize("name", builtin_rigs())
def test_a_built_in_rig_is_printed_as_a_file_that_is_read_again(name: str, tmp_path: Path) -> None:
    code, output, _ = run(name)
    assert code == 0
    path = tmp_path / "mine.toml"
    path.write_text(output.replace(f'name = "{name}"', 'name = "mine"') + "\n[drive]\nname = 'udp'\nport = 7451\n")
    code, output, _ = run(path)
    assert code == 0, output
    assert output.startswith(f"mine: {builtin_rigs()[name].geometry} ")
    assert "  drive   udp\n" in output


@pytest.mark.parametrize(
    ("drive", "told"),
    [
        ("name = 'acme'", "no drive 'acme': there are simulated, udp"),
        ("name = 'udp'\nprot = 7450", "no option prot"),
        ("name = 'udp'\nport = 0", "port 0: expected 1 to 65535"),
        ("name = 'udp'\nport = 'x'", "Expected `int`"),
    ],
)
def test_a_drive_that_is_not_there_or_does_not_take_its_options_is_said(drive: str, told: str, tmp_path: Path) -> None:
    path = tmp_path / "bench.toml"
    path.write_text(f'name = "bench"\ngeometry = "vertical-4"\n[drive]\n{drive}\n')
    _, _, error = run(path)
    assert isinstance(error, FileError)
    assert (error.file, error.column) == (str(path), "drive")
    assert told in str(error)


def test_neither_a_rig_nor_a_file() -> None:
    assert isinstance(run("nowhere")[2], NotFoundError)
