"""The table of figures of a comparison, as HTML."""

import html
import math
from typing import Any

from fullpose_server.formats.reason_text import UNITS
from fullpose_server.formats.report import exact_text

HEADINGS = (
    ("Method", "the source is shown over the name"),
    ("Exact", "share of the samples within the bound above"),
    ("Largest error", "geodesic, deg"),
    ("RMS error", "geodesic, deg"),
    ("Matrix error", "largest entry of F - C"),
    ("Beyond limits", "samples beyond a limit; the frames and limits are shown over the number"),
    ("Limited", "samples that the method itself marked as kept from the attitude by a limit"),
    ("Peak rate", "of any frame, deg/s"),
    ("Peak acceleration", "of any frame, deg/s²"),
    ("Total way", "total variation of all frames, deg"),
    ("Iterations", "median / most"),
    ("Step", "median / 99th percentile, µs"),
    ("Missed because of", "what most of the samples that are not exact have in common"),
)


def metrics_table(report: dict[str, Any], keys: dict[str, tuple[str, str]]) -> str:
    """A table with one row a method; `keys`: colour and dash of each label."""
    head = "".join(f'<th scope="col" title="{html.escape(tip)}">{html.escape(name)}</th>' for name, tip in HEADINGS)
    rows = "".join(_row(method, keys) for method in report["methods"])
    reasons = "".join(
        f"<dt>{html.escape(method['label'])}</dt><dd>{html.escape(_sentence(method))}</dd>"
        for method in report["methods"]
        if method.get("why")
    )
    listed = f'<dl class="reasons">{reasons}</dl>' if reasons else ""
    return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>{listed}"


def _sentence(method: dict[str, Any]) -> str:
    """What happens first and what then; of an infeasible plan how sure that is, too."""
    told = f"{method['why'][0].upper()}{method['why'][1:]}."
    return f"{told} {method['how_sure']}" if method["how_sure"] and not method["feasible"] else told


def _row(method: dict[str, Any], keys: dict[str, tuple[str, str]]) -> str:
    name, source = html.escape(method["label"]), html.escape(method["source"])
    if method["refusal"] is not None:
        refusal = html.escape(method["refusal"])
        return f'<tr><th scope="row" title="{source}">{name}</th><td class="text" colspan="12">{refusal}</td></tr>'
    colour, dash = keys[method["label"]]
    line = (
        f'<svg width="26" height="10" aria-hidden="true"><path d="M0 5H26" stroke="{colour}" stroke-width="2.5" '
        f'stroke-dasharray="{dash}"/></svg>'
    )
    claim = ' <small title="claims to keep every limit">keeps limits</small>' if method["claims_limits"] else ""
    peaks = method["peak"].values()
    counts = method["limit_violation_counts"]
    beyond = [f"{frame} {limit} {n}" for frame, kinds in counts.items() for limit, n in kinds.items() if n]
    total = method["limit_violation_samples"]
    step = method["step_us"]
    failures = method["failures"]
    cells = [
        _cell(html.escape(exact_text(method)), bad=method["exact_share"] < 1.0),
        _cell(_number(method["max_error_deg"])),
        _cell(_number(method["rms_error_deg"])),
        _cell(_number(method["max_matrix_error"])),
        _cell(str(total), tip="; ".join(beyond) or "inside every limit", bad=total > 0),
        _cell(str(method["limited_samples"]), bad=method["limited_samples"] > 0),
        _cell(_number(max(peak["rate_deg_s"] for peak in peaks)), tip=_peaks(method, "rate_deg_s", UNITS["rate"])),
        _cell(
            _number(max(peak["acceleration_deg_s2"] for peak in peaks)),
            tip=_peaks(method, "acceleration_deg_s2", UNITS["acceleration"]),
        ),
        _cell(_number(sum(method["total_variation_deg"].values()))),
        _cell(f"{method['iterations']['median']:g} / {method['iterations']['max']}"),
        _cell("–" if step is None else f"{step['median']:.2f} / {step['p99']:.2f}"),
        _cell(
            failures[0]["reason"] if failures else "",
            tip="; ".join(f"{f['reason']}: {f['samples']} samples from {f['first_s']:.3f} s" for f in failures),
            text=True,
        ),
    ]
    return f'<tr><th scope="row" title="{source}">{line} {name}{claim}</th>{"".join(cells)}</tr>'


def _peaks(method: dict[str, Any], key: str, unit: str) -> str:
    return ", ".join(f"{frame} {peak[key]:.4g}" for frame, peak in method["peak"].items()) + f" {unit}"


def _cell(value: str, tip: str = "", bad: bool = False, text: bool = False) -> str:
    kinds = " ".join(kind for kind, on in (("bad", bad), ("text", text)) if on)
    label = f' class="{kinds}"' if kinds else ""
    return f'<td{label} title="{html.escape(tip)}">{html.escape(value)}</td>' if tip else f"<td{label}>{value}</td>"


def _number(value: float | None) -> str:
    """Three digits; powers of ten written as a paper writes them."""
    if value is None or not math.isfinite(value):
        return "–"
    if value == 0.0 or 1e-2 <= abs(value) < 1e5:
        return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa}·10{str(int(exponent)).translate(_SUPERSCRIPT)}"


_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
