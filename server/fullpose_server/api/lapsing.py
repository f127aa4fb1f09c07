"""Leases of those who may command no longer: who is shut out flies nothing on."""

from fullpose_server.api.commanding import audit
from fullpose_server.api.deps import Services
from fullpose_server.people.admitted import Admitted

SERVER = "(server)"  # in the audit; no name of a person has a bracket


async def lapse_leases(services: Services, admitted: Admitted) -> None:
    """Take the lease from every holder who is no operator any more, or disabled; it is in the audit.

    A rig process that does not answer loses nothing by it: the lease's own silence ends what is flown.
    """
    if admitted.commanders is None:
        return
    for host in services.hosts.all():
        holder = host.snapshot().lease.holder
        if holder is not None and holder not in admitted.commanders:
            reply = await host.lapse(holder)
            audit(services, host.name, SERVER, "lease lapse", {"of": holder}, None, reply, None)
