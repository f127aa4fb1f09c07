"""The image as it is delivered: its size, its user, its read-only root, its health, and what doctor says in it."""

import json

import pytest

from tests.containers.engine import PYTHON, Box, Engine, podman
from tests.support.waiting import until

LARGEST_MB = 600


def test_it_is_smaller_than_600_mb(engine: Engine) -> None:
    size = int(podman("image", "inspect", "--format", "{{.Size}}", engine.image)) / 1e6
    print(f"image: {size:.0f} MB")
    assert size < LARGEST_MB


def test_nothing_of_the_build_is_in_it(engine: Engine, box: Box) -> None:
    environment = json.loads(podman("image", "inspect", "--format", "{{json .Config.Env}}", engine.image))
    assert {pair.split("=")[0] for pair in environment} == {
        *("PATH", "PYTHONUNBUFFERED", "PYTHONDONTWRITEBYTECODE", "NUMBA_CACHE_DIR"),
        *("FULLPOSE_HOST", "FULLPOSE_PORT", "FULLPOSE_DATA_DIR"),
    }
    for path in ("/etc/pip.conf", "/root/.npmrc", "/run/secrets/ca.pem", "/src", "/wheels", "/opt/pip"):
        assert box.run("test", "!", "-e", path).returncode == 0, path


def test_it_runs_as_a_user_without_rights_on_a_root_that_cannot_be_written(box: Box) -> None:
    assert box.run("id", "-u").stdout.strip() == "10001"
    for path in ("/x", "/opt/fullpose/x", "/home/fullpose/x", "/etc/x"):
        assert box.run("touch", path).returncode != 0, path
    for path in ("/data/x", "/var/cache/fullpose/x", "/tmp/x"):
        done = box.run("touch", path)
        assert done.returncode == 0, done.stderr
    assert "NoNewPrivs:\t1" in box.run("cat", "/proc/1/status").stdout


def test_its_kernels_are_compiled(box: Box) -> None:
    """A new volume has them from the image: nothing is compiled, so nothing is added."""
    count = "import pathlib; print(len(list(pathlib.Path('/var/cache/fullpose').rglob('*.nbc'))))"
    before = int(box.run(PYTHON, "-c", count).stdout)
    assert before > 20
    done = box.run("fullpose", "doctor")
    assert "ok    solver" in done.stdout, done.stdout + done.stderr
    assert int(box.run(PYTHON, "-c", count).stdout) == before


def test_doctor_knows_the_settings_of_the_container(box: Box) -> None:
    done = box.run("fullpose", "doctor")
    told = {line[6:18].strip(): line for line in done.stdout.splitlines()}
    assert done.returncode == 0, done.stdout + done.stderr
    assert "/data: " in told["data"]
    assert told["console"].startswith("ok")
    assert "a server runs there already" in told["port"]
    assert told["real time"].startswith(("ok", "note"))


def test_doctor_tells_a_missing_share_from_a_missing_capability(engine: Engine, box: Box) -> None:
    """podman makes the capability one that is in effect; a new group of cgroup v1 has no share of real time."""
    share = box.run("cat", "/sys/fs/cgroup/cpu/cpu.rt_runtime_us")
    if share.returncode != 0 or share.stdout.strip() != "0":
        pytest.skip("this kernel shares no real time out by control groups of version 1")
    with_it = box.run("fullpose", "doctor").stdout
    assert "CAP_SYS_NICE is there, but its control group has no share" in with_it
    with engine.server(capabilities=False) as without:
        without.wait_healthy()
        said = without.run("fullpose", "doctor").stdout
    assert "there is neither CAP_SYS_NICE nor RLIMIT_RTPRIO" in said
    assert "no share of real time" in said


def test_the_health_check_is_the_image_s(engine: Engine, box: Box) -> None:
    assert box.check() == (0, "ok")
    check = json.loads(podman("image", "inspect", "--format", "{{json .HealthCheck}}", engine.image))
    assert check["Test"] == ["CMD", "python", "/opt/fullpose/health.py"]
    podman("healthcheck", "run", box.name)
    until(lambda: box.inspect("{{.State.Health.Status}}") == "healthy")
