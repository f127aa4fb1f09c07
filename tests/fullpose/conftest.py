"""Hypothesis for numerics: no deadline (a kernel compiles on its first call), the same examples at every run."""

from hypothesis import settings

settings.register_profile("solver", deadline=None, derandomize=True, max_examples=50)
settings.load_profile("solver")
