"""The planner: the whole flight at once (METHODS, section 8)."""

from solver.planner.options import PlanOptions
from solver.planner.verdict import Margins, Verdict
from solver.planner.whole import Plan, plan

__all__ = ["Margins", "Plan", "PlanOptions", "Verdict", "plan"]
