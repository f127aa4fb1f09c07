"""Prometheus metrics, read off at every scrape; no counters are kept beside what the rooms count themselves."""

from collections.abc import Iterator

from prometheus_client import CollectorRegistry, generate_latest
from prometheus_client.core import GaugeMetricFamily, InfoMetricFamily, Metric
from prometheus_client.exposition import CONTENT_TYPE_LATEST
from prometheus_client.metrics_core import CounterMetricFamily
from prometheus_client.registry import Collector

from fullpose_server.api.deps import Services
from fullpose_server.api.request_log import RequestTimes
from fullpose_server.planning.runner import RunnerStatus
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.session.states import STATES
from fullpose_server.version import VERSION


def exposition(services: Services, requests: RequestTimes) -> tuple[bytes, str]:
    """The text and its media type."""
    registry = CollectorRegistry()
    registry.register(_Rooms(services))
    return generate_latest(registry) + generate_latest(requests.registry), CONTENT_TYPE_LATEST


class _Rooms(Collector):
    def __init__(self, services: Services) -> None:
        self._services = services

    def collect(self) -> Iterator[Metric]:
        services = self._services
        up = GaugeMetricFamily("fullpose_start_time_seconds", "When the server started")
        up.add_metric([], services.started)
        yield up
        built = InfoMetricFamily("fullpose_build", "What runs here")
        built.add_metric([], {"version": VERSION})
        yield built
        yield from _jobs(services)
        free = GaugeMetricFamily("fullpose_disk_free_bytes", "Free on the data folder's disk")
        free.add_metric([], float(services.disk.free_bytes()))
        yield free
        alarm = GaugeMetricFamily("fullpose_disk_alarm_bytes", "Less than that free: health is degraded")
        alarm.add_metric([], float(services.disk.alarm_bytes))
        yield alarm
        quarantined = GaugeMetricFamily("fullpose_quarantined", "Damaged things that nobody has looked at")
        quarantined.add_metric([], float(len(services.quarantine.findings())))
        yield quarantined
        yield from _rigs(services.hosts.all())


def _jobs(services: Services) -> Iterator[Metric]:
    runners = (
        ("plans", services.queue.status, services.queue.pending),
        ("comparisons", services.comparisons.status, services.comparisons.pending),
    )
    busy = GaugeMetricFamily("fullpose_jobs_busy", "Whether one is in work", labels=["kind"])
    stopped = GaugeMetricFamily("fullpose_jobs_stopped", "Whether none are made", labels=["kind"])
    pending = GaugeMetricFamily("fullpose_jobs_pending", "That wait or are in work", labels=["kind"])
    for kind, status, jobs in runners:
        busy.add_metric([kind], float(status is RunnerStatus.BUSY))
        stopped.add_metric([kind], float(status in (RunnerStatus.STOPPED, RunnerStatus.RESTARTING)))
        pending.add_metric([kind], float(jobs.total))
    yield from (busy, stopped, pending)


def _rigs(hosts: list[RigHost]) -> Iterator[Metric]:
    label = ["rig"]
    state = GaugeMetricFamily("fullpose_session_state", "1 for the state the session is in", labels=["rig", "state"])
    alive = GaugeMetricFamily("fullpose_rig_alive", "Whether the rig process answers", labels=label)
    ticks = CounterMetricFamily("fullpose_rig_ticks", "Ticks of the loop", labels=label)
    misses = CounterMetricFamily("fullpose_rig_deadline_misses", "Deadlines missed", labels=label)
    recording = GaugeMetricFamily("fullpose_recorder_alive", "Whether the recorder answers", labels=label)
    lost = CounterMetricFamily("fullpose_recorder_lost_samples", "Samples that never reached the record", labels=label)
    late = GaugeMetricFamily(
        "fullpose_rig_lateness_seconds", "Lateness of the loop over its life", labels=["rig", "quantile"]
    )
    alarms = GaugeMetricFamily("fullpose_alarms", "Standing alarms", labels=["rig", "severity"])
    error = GaugeMetricFamily("fullpose_tracking_error_degrees", "Newest geodesic tracking error", labels=label)
    for host in hosts:
        now = host.snapshot()
        for name in STATES:
            state.add_metric([host.name, name.value], float(name.value == now.state))
        alive.add_metric([host.name], float(now.health.rig_alive))
        ticks.add_metric([host.name], now.health.ticks)
        misses.add_metric([host.name], now.health.deadline_misses)
        recording.add_metric([host.name], float(now.health.recorder.alive))
        lost.add_metric([host.name], now.health.recorder.lost)
        for quantile, value in now.health.lateness_us.items():
            late.add_metric([host.name, quantile], value * 1e-6)
        for severity in ("warning", "fault", "emergency"):
            count = sum(alarm.severity == severity for alarm in now.alarms)
            alarms.add_metric([host.name, severity], count)
        newest = host.latest()
        if newest is not None:
            error.add_metric([host.name], float(newest["tracking_error_deg"][0]))
    yield from (state, alive, ticks, misses, recording, lost, late, alarms, error)
