"""Which kernel runs, and who says so."""

import os
import subprocess
import sys

import numpy as np
import pytest

from fixture_design.cones import kernel
from fixture_design.cones.kernel import choice
from fixture_design.errors import KernelError


def start(wanted: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", "from fixture_design.cones.kernel import NAME; print(NAME)"]
    return subprocess.run(
        command, env=os.environ | {choice.VARIABLE: wanted}, capture_output=True, text=True, check=False, timeout=60
    )


def test_the_variable_chooses():
    assert start("numpy").stdout.strip() == "numpy"
    assert start("").stdout.strip() == kernel.available()[-1]
    wrong = start("fortran")
    assert wrong.returncode
    assert "there are: numpy, rust" in wrong.stderr


def test_rust_is_used_where_it_was_built(implementation: str):
    assert (choice.compiled(6) is None) == (implementation == "numpy")
    assert choice.compiled(9) is None
    assert choice.compiled(6, 5000) is None


def test_one_that_is_not_there(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(choice, "_native", None)
    assert choice.available() == ("numpy",)
    with pytest.raises(KernelError, match="no kernel 'rust' here; there are: numpy"), choice.using("rust"):
        pass


@pytest.mark.skipif("rust" not in kernel.available(), reason="the compiled kernel was not built")
def test_both_give_the_same_cone():
    rows = np.random.default_rng(3).normal(size=(12, 6)) + 2 * np.eye(6)[0]
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    found = {}
    for name in ("numpy", "rust"):
        with kernel.using(name):
            cone = kernel.double_description(rows, np.zeros((0, 6)), 1e-9)
            order = np.lexsort(np.round(cone.rays, 9).T)
            found[name] = cone.rays[order], cone.incidence[order]
    assert np.allclose(found["numpy"][0], found["rust"][0], atol=1e-12)
    assert (found["numpy"][1] == found["rust"][1]).all()
