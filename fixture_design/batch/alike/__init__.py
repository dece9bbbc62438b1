"""Layouts that are alike, looked at together: thousands a second where `verify` takes milliseconds each.

A library or a sweep has layouts that differ in nothing but their numbers. What is alike is read, checked and planned
once (`structure`, `plan`); the numbers become one array, whose rows are decided in batches by the kernel (`decide`),
and records are filled into a text made once (`text`). Whatever is not plainly decided here, or is not of this simple
kind (contacts given outright, without questions of use), is left to `verify`, so that the answers are the same.
"""

from fixture_design.batch.alike.look import Alike

__all__ = ["Alike"]
