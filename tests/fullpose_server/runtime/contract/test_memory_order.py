"""Release and acquire: real fences in the code that is made, and none where the processor keeps the order."""

import platform
import re
from collections.abc import Callable
from typing import Any

import llvmlite.binding as llvm
import numba
import numpy as np
import pytest

from fullpose_server.runtime.contract import fences, memory_order, shared_memory, telemetry

BOTH = [("release", fences.release), ("acquire", fences.acquire)]
# The instruction of each on ARMv8-A: loads and stores before loads and stores after; loads before both.
ARM = {"release": "dmb\tish\n", "acquire": "dmb\tishld\n"}


def ir_of(kernel: Any) -> str:
    """LLVM's code of a kernel, compiled anew: one from the cache has none."""
    fresh = numba.njit("void()")(kernel.py_func)
    (code,) = fresh.inspect_llvm().values()
    return str(code)


def assembly(ir: str, triple: str) -> str:
    """`ir` as instructions of another processor."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    body = "\n".join(line for line in ir.splitlines() if not line.startswith(("target triple", "target datalayout")))
    machine = llvm.Target.from_triple(triple).create_target_machine()
    return str(machine.emit_assembly(llvm.parse_assembly(body)))


@pytest.mark.parametrize(("name", "kernel"), BOTH)
def test_the_kernel_is_a_fence(name: str, kernel: Callable[[], None]) -> None:
    assert f"fence {name}" in ir_of(kernel)
    kernel()


@pytest.mark.parametrize(("name", "kernel"), BOTH)
def test_it_is_an_instruction_on_arm_and_none_on_x86(name: str, kernel: Callable[[], None]) -> None:
    ir = ir_of(kernel)
    assert ARM[name] in assembly(ir, "aarch64-unknown-linux-gnu")
    x86 = assembly(ir, "x86_64-unknown-linux-gnu")
    assert re.findall(r"\t(mfence|sfence|lfence|lock)\b", x86) == []


@pytest.mark.parametrize("machine", ["x86_64", "AMD64", "i686"])
def test_x86_keeps_the_order_itself(machine: str) -> None:
    assert memory_order.fences_of(machine) == (memory_order.in_order, memory_order.in_order)


@pytest.mark.parametrize("machine", ["aarch64", "arm64", "riscv64", "ppc64le", "", "x86_64h?"])
def test_every_other_processor_is_given_fences(machine: str) -> None:
    assert memory_order.fences_of(machine) == (fences.release, fences.acquire)


def test_this_machine_has_its_own() -> None:
    assert (memory_order.release, memory_order.acquire) == memory_order.fences_of(platform.machine())


class Watched:
    """Writes down fences, and what an array of one number is set to, in the order they come."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, module: Any) -> None:
        self.told: list[str] = []
        monkeypatch.setattr(module, "release", lambda: self.told.append("release"))
        monkeypatch.setattr(module, "acquire", lambda: self.told.append("acquire"))


class Spy:
    """An array that tells of what is read of it and written to it."""

    def __init__(self, name: str, array: Any, told: list[str]) -> None:
        self._name, self._array, self._told = name, array, told

    def __len__(self) -> int:
        return len(self._array)

    def __getitem__(self, key: Any) -> Any:
        if key == "seq":
            return Spy("seq", self._array["seq"], self._told)
        self._told.append(f"read {self._name}")
        return self._array[key]

    def __setitem__(self, key: Any, value: Any) -> None:
        self._told.append(f"write {self._name}")
        self._array[key] = value


def spied_ring(told: list[str]) -> telemetry.Ring:
    head: Any = Spy("head", np.zeros(1, "<u8"), told)
    slots: Any = Spy("slots", np.zeros(8, telemetry.SAMPLE), told)
    return telemetry.Ring(head, slots)


def test_the_ring_writes_and_reads_in_order(monkeypatch: pytest.MonkeyPatch) -> None:
    told = Watched(monkeypatch, telemetry).told
    ring = spied_ring(told)
    ring.append(np.zeros(1, telemetry.SAMPLE))
    written = [step for step in told if not step.startswith("read")]
    assert written == [
        *("write seq", "release", "write slots", "release", "write seq", "release", "write head"),
    ]
    told.clear()
    ring.since(0, 8)
    assert told == ["read head", "acquire", "read slots", "acquire", "read head", "acquire"]


def test_snapshot_and_events_are_between_fences(monkeypatch: pytest.MonkeyPatch, tmp_path: Any) -> None:
    told = Watched(monkeypatch, shared_memory).told
    shared = shared_memory.Shared(tmp_path / "memory", create=True)
    shared.publish(b"{}", 1)
    assert told == ["release"] * 3
    told.clear()
    assert shared.snapshot() == b"{}"
    assert told == ["acquire"] * 3
    told.clear()
    shared.add_event({"kind": "a"})
    assert told == ["release"] * 3
    told.clear()
    assert len(shared.events_since(0)[0]) == 1
    assert told == ["acquire"] * 2
