"""What `preview` cannot be told."""

import re

import pytest

from fullpose.errors import MethodError
from fullpose.preview.options import PreviewOptions


def test_options_out_of_range_are_named() -> None:
    for wrong in ({"preview_s": -1.0}, {"horizon_s": 0.0}, {"reserve": 1.0}, {"recovery": 0.0}, {"beam": 0}):
        with pytest.raises(MethodError, match=next(iter(wrong))):
            PreviewOptions(**wrong)
    for vast, most in (
        ({"beam": 10**9}, "4096]"),
        ({"slides": 10**6}, "64]"),
        ({"smoothing": 10**9}, "100]"),
        ({"horizon_s": 1e9}, "1000 stages at most"),
        ({"stage_s": 1e-9}, "1000 stages at most"),
    ):
        with pytest.raises(MethodError, match=f"{next(iter(vast))} = .*expected .*{re.escape(most)}"):
            PreviewOptions(**vast)
