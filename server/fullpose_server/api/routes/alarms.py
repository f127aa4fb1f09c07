"""The alarm history of all rigs, over restarts of server and rig processes."""

import asyncio
from dataclasses import replace
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request
from pydantic import AwareDatetime, TypeAdapter
from starlette.responses import Response

from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.paging import LINKED, PageDep
from fullpose_server.api.schemas.records import AlarmRecordOut
from fullpose_server.session.alarms import Severity
from fullpose_server.store.alarms import AlarmFilter, alarm_id
from fullpose_server.store.keyset import Key
from fullpose_server.store.tables import AlarmRow

router = APIRouter(prefix="/alarms", tags=["alarms"])
_LIST = TypeAdapter(list[AlarmRecordOut])
_FIELDS = tuple(name for name in AlarmRecordOut.model_fields if name != "standing")


async def _filter(
    rig: str | None = None,
    severity: Severity | None = None,
    code: str | None = None,
    since: Annotated[AwareDatetime | None, Query(alias="from", description="First raised then or later")] = None,
    until: Annotated[AwareDatetime | None, Query(alias="to", description="First raised before")] = None,
) -> AlarmFilter:
    return AlarmFilter(
        rig=rig,
        severity=severity,
        code=code,
        since_s=None if since is None else since.timestamp(),
        until_s=None if until is None else until.timestamp(),
    )


@router.get("", response_model=list[AlarmRecordOut], responses=LINKED)
async def list_alarms(
    request: Request,
    services: ServicesDep,
    page: PageDep,
    asked: Annotated[AlarmFilter, Depends(_filter)],
    standing: Annotated[bool | None, Query(description="Those that stand, or those that do not")] = None,
) -> Response:
    """Alarms of all rigs, newest first by their first occurrence, a page at a time; all of them outlive restarts."""
    services.alarm_watch.look()
    now = _standing(services)
    wanted = replace(asked, ids=now if standing else None, but=now if standing is False else ())

    def read() -> list[AlarmRow]:
        services.alarm_trail.written()
        return services.alarms.all(wanted, page.before, page.wanted)

    found = await asyncio.to_thread(read)
    rows = page.cut(found)
    last = Key(rows[-1].time_s, rows[-1].id) if rows else None
    return page.answer(request, _LIST.dump_json([_out(row, now) for row in rows]), len(found), last)


def _standing(services: Services) -> frozenset[str]:
    """The alarms that stand as of now."""
    shown = [host.snapshot() for host in services.hosts.all()]
    return frozenset(alarm_id(one.life, alarm.number) for one in shown for alarm in one.alarms)


def _out(row: AlarmRow, standing: frozenset[str]) -> AlarmRecordOut:
    values = {name: getattr(row, name) for name in _FIELDS}
    return AlarmRecordOut.model_validate({**values, "standing": row.id in standing})
