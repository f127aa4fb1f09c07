"""Rows that follow: nobody waits for one, and none is lost for a database that is locked for a while."""

from fullpose_server.location import Location
from fullpose_server.store.audit import AuditLog
from fullpose_server.store.audit_entry import AuditEntry
from fullpose_server.store.audit_trail import AuditTrail
from fullpose_server.store.database import Database
from fullpose_server.store.write_behind import BATCH, MOST
from tests.support.locked import held
from tests.support.waiting import until


def entry(number: int) -> AuditEntry:
    return AuditEntry(float(number), "ann", "rig", "estop", {}, None, ("running", "estopped"), True, None)


def test_a_locked_database_holds_nobody_up_and_loses_no_row(location: Location) -> None:
    database = Database(location, busy_s=0.05)
    log = AuditLog(database)
    trail = AuditTrail(log)
    with held(location):
        for number in range(BATCH + 20):
            trail.follow(entry(number))
        told = until(trail.faults)
        assert f"{BATCH + 20} lines wait" in told[0]
        assert "held by another program" in told[0]
        assert not trail.written(0.0)
    assert trail.written(60.0)
    assert trail.faults() == []
    assert [row.at for row in reversed(log.all(None, None, 1000))] == [float(k) for k in range(BATCH + 20)]
    trail.close()
    database.close()


def test_what_cannot_be_kept_is_told(location: Location) -> None:
    database = Database(location, busy_s=0.05)
    trail = AuditTrail(AuditLog(database))
    with held(location):
        for number in range(MOST + 3):
            trail.follow(entry(number))
        assert any("3 lines of the audit were lost" in fault for fault in trail.faults())
        trail.close()  # ends, though nothing can be written
    database.close()
