"""The version of this package."""

from importlib.metadata import PackageNotFoundError, version

try:
    VERSION = version("fullpose")
except PackageNotFoundError:  # run from a source tree that is not installed
    VERSION = "0.0.0+source"
