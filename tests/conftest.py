"""For every test: properties are checked on the same examples each time, and at any machine's pace."""

from hypothesis import HealthCheck, settings

settings.register_profile(
    "fullpose", deadline=None, derandomize=True, max_examples=50, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("fullpose")
