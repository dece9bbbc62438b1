"""Thousands of layouts, none lost: inputs lazily, worker processes, records in input order, appended and resumed."""

from fixture_design.batch.inputs import input_files
from fixture_design.batch.item import Item
from fixture_design.batch.items import items_of, total_share
from fixture_design.batch.job import Workers, detail_wanted, local_workers, run_batch, verify_batch
from fixture_design.batch.summary import Robustness, Summary

__all__ = [
    "Item",
    "Robustness",
    "Summary",
    "Workers",
    "detail_wanted",
    "input_files",
    "items_of",
    "local_workers",
    "run_batch",
    "total_share",
    "verify_batch",
]
