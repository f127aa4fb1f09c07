"""The planner: the whole flight at once (mathematics, section 8)."""

from fullpose.plan.plan import Plan, plan
from fullpose.plan.verdict import Margins, Verdict
from fullpose.preview.flight import PreviewFlight
from fullpose.preview.options import PreviewOptions
from fullpose.preview.replan import Ahead, Replan
from fullpose.preview.stepper import PreviewStepper
from fullpose.trajectory.options import PlanOptions

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
