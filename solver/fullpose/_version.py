"""The version of what is installed; the metadata take longer to load than the rest of the library's face."""

from importlib.metadata import PackageNotFoundError, version

try:
    __version__ = version("fullpose")
except PackageNotFoundError:  # run from a source tree that is not installed
    __version__ = "0.0.0+source"
