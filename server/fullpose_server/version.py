"""The version of this package: that of the library, with which it is built and installed."""

import fullpose

VERSION = fullpose.__version__
