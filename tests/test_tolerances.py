"""Tolerances have one value each."""

import ast
from pathlib import Path

from fixture_design import tolerances


def test_no_name_is_given_twice() -> None:
    assert tolerances.__file__ is not None
    tree = ast.parse(Path(tolerances.__file__).read_text(encoding="utf-8"))
    names = [
        target.id
        for node in tree.body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    ]
    assert len(names) == len(set(names))
