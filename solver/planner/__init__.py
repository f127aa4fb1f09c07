"""The planner: the whole flight at once (METHODS, section 8)."""

from solver.planner.options import PlanOptions
from solver.planner.preview import PreviewStepper
from solver.planner.preview_flight import PreviewFlight
from solver.planner.verdict import Margins, Verdict
from solver.planner.way import Ahead, PreviewOptions, Replan
from solver.planner.whole import Plan, plan

__all__ = [
    "Ahead",
    "Margins",
    "Plan",
    "PlanOptions",
    "PreviewFlight",
    "PreviewOptions",
    "PreviewStepper",
    "Replan",
    "Verdict",
    "plan",
]
