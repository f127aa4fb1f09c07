"""Curves of runs as the routes see them: there at once where they have been made, else made apart, one after another.

Whoever asks meanwhile is told how far it is. What has been looked at longest ago goes where all take too much room.
"""

import asyncio
import contextlib
import shutil
from dataclasses import dataclass
from pathlib import Path

from fullpose_server.api.offload.one_off import done_apart
from fullpose_server.api.problems import ApiError
from fullpose_server.errors import DamagedError
from fullpose_server.formats.plan_folder import PlanFolderError, read_plan
from fullpose_server.runtime.recording.against import Difference, fingerprint_of
from fullpose_server.runtime.recording.curves import Curves, StaleError
from fullpose_server.runtime.recording.record_names import RECORD

KIND, KIND_AGAINST = "curves", "curves against"
WAITING = 16  # runs whose curves are being made or wait for it
MOST_BYTES = 4 * 1024**3  # of all curves together: some forty hours at 1 kHz
_PROGRAM = "fullpose_server.api.offload.curves_worker"


@dataclass(frozen=True)
class Other:
    """What a run is compared with: another run, or a plan."""

    kind: str  # "run" or "plan"
    id: str


class CurvesMaker:
    """Use it from one event loop. Curves are kept in `folder`, beside the records in `runs` and plans in `plans`."""

    def __init__(self, folder: Path, runs: Path, plans: Path) -> None:
        self._folder, self._runs, self._plans = folder, runs, plans
        self._making: dict[str, asyncio.Task[None]] = {}
        self._progress: dict[str, float] = {}
        self._turn = asyncio.Lock()

    async def close(self) -> None:
        """Make no more."""
        for task in self._making.values():
            task.cancel()
        await asyncio.gather(*self._making.values(), return_exceptions=True)

    async def curves(self, run: str) -> Curves | float:
        """The curves of a run that is not being written; while they are being made, what part of that is done.

        Raises `ApiError`: 429 where too many are asked for, and what became of it where they could not be made.
        """
        found = await asyncio.to_thread(self._kept, run)
        if found is not None:
            return found
        asked = {"record": str(self._record(run)), "target": str(self._folder / run)}
        return await self._made(run, KIND, asked)

    async def made(self, run: str) -> Curves:
        """The same, once they are made. Raises `ApiError`."""
        while isinstance(found := await self.curves(run), float):
            if (making := self._making.get(run)) is not None:
                await asyncio.wait([making])
        return found

    async def difference(self, run: str, other: Other) -> Difference | float:
        """The same of a run against another one, or against a plan."""
        found = await asyncio.to_thread(self._kept_difference, run, other)
        if found is not None:
            return found
        name = _name(run, other)
        made_of = await asyncio.to_thread(self._made_of, run, other)
        reference = self._record(other.id) if other.kind == "run" else self._plans / other.id
        asked = {
            "record": str(self._record(run)),
            "target": str(self._folder / name),
            "kind": other.kind,
            "reference": str(reference),
            "made_of": made_of,
        }
        return await self._made(name, KIND_AGAINST, asked)

    def forget(self, run: str) -> None:
        """A run is gone; blocking."""
        for folder in [*self._folder.glob(f"{run}~*"), self._folder / run]:
            shutil.rmtree(folder, ignore_errors=True)

    def _record(self, run: str) -> Path:
        return self._runs / f"{run}{RECORD}"

    def _made_of(self, run: str, other: Other) -> str:
        if other.kind == "run":
            return fingerprint_of(self._record(run), self._record(other.id))
        try:
            plan_hash = read_plan(self._plans / other.id).info.plan_hash
        except PlanFolderError as error:
            raise DamagedError(f"plan {other.id} is damaged ({error.told}): make it again") from None
        return fingerprint_of(self._record(run), plan_hash)

    def _kept(self, run: str) -> Curves | None:
        with contextlib.suppress(StaleError):
            found = Curves(self._folder / run, self._record(run))
            self._looked_at(run)
            return found
        return None

    def _kept_difference(self, run: str, other: Other) -> Difference | None:
        name = _name(run, other)
        with contextlib.suppress(StaleError):
            found = Difference(self._folder / name, self._made_of(run, other))
            self._looked_at(name)
            return found
        return None

    def _looked_at(self, name: str) -> None:
        with contextlib.suppress(OSError):
            (self._folder / name / "about.json").touch()

    async def _made(self, name: str, kind: str, asked: dict[str, str]) -> float:
        task = self._making.get(name)
        if task is not None and task.done():
            del self._making[name]
            task.result()  # raises what became of it, once; who asks again has it tried again
            task = None
        if task is None:
            if len(self._making) >= WAITING:
                raise ApiError(429, "busy", f"curves of {len(self._making)} runs are being made: try again")
            self._progress[name] = 0.0
            task = self._making[name] = asyncio.create_task(self._make(name, kind, asked), name=f"{kind} {name}")
        # A short run's are there before somebody has to ask again.
        await asyncio.wait([task], timeout=0.3)
        return self._progress.get(name, 1.0)

    async def _make(self, name: str, kind: str, asked: dict[str, str]) -> None:
        def tell(part: float) -> None:
            self._progress[name] = part

        async with self._turn:
            await asyncio.to_thread(self._sweep)
            await done_apart(_PROGRAM, kind, asked, tell)
        self._making.pop(name, None)
        self._progress.pop(name, None)

    def _sweep(self) -> None:
        """Let go of curves whose run is gone, and of those looked at longest ago beyond the room for all."""
        self._folder.mkdir(parents=True, exist_ok=True)
        kept: list[tuple[float, int, Path]] = []
        for folder in self._folder.iterdir():
            if folder.name.startswith(".") or not self._record(folder.name.split("~")[0]).exists():
                shutil.rmtree(folder, ignore_errors=True)  # one that begins with a dot was cut off
                continue
            with contextlib.suppress(OSError):
                size = sum(file.stat().st_size for file in folder.iterdir())
                kept.append(((folder / "about.json").stat().st_mtime, size, folder))
        room = MOST_BYTES
        for _, size, folder in sorted(kept, reverse=True):
            room -= size
            if room < 0:
                shutil.rmtree(folder, ignore_errors=True)


def _name(run: str, other: Other) -> str:
    """Of the folder; no run and no plan has a ~ in its id."""
    return f"{run}~{other.kind}~{other.id}"
