"""The one pipeline from a layout to its verdict, and the checker that confirms a verdict without a solver."""

from fixture_design.verification.checker import check
from fixture_design.verification.verify import contacts_of, verify

__all__ = ["check", "contacts_of", "verify"]
