"""What all tests share: shapes checked at run time, Hypothesis profiles, and where the shared material is.

The import hook comes first: it checks the annotations of every module of the package that is imported after it.
"""

import os
import sys
from pathlib import Path

import pytest
from hypothesis import settings
from jaxtyping import install_import_hook

if "--benchmark-enable" not in sys.argv:  # shapes are checked while testing, not while timing
    install_import_hook("fixture_design", "beartype.beartype")

settings.register_profile("ci", max_examples=60, deadline=None)
settings.register_profile("thorough", max_examples=2000, deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci"))


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder `shared` next to the repository: material that a clean clone does not have."""
    folder = Path(__file__).resolve().parents[2] / "shared"
    if not folder.is_dir():
        pytest.skip("there is no folder `shared` next to the repository")
    return folder
