"""What people look at: evidence in words, the sheet to sign.

Nothing here decides anything; it shows what a verdict holds.
"""

from fixture_design.viewing.report import refuse_inputs, write_report
from fixture_design.viewing.words import evidence_in_words

__all__ = ["evidence_in_words", "refuse_inputs", "write_report"]
