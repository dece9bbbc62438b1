"""Which file confirms which question of `verification.use`."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from fixture_design.contacts import Contact
from fixture_design.layout import Finding
from fixture_design.verification.accuracy_proofs import accuracy_fault
from fixture_design.verification.force_checks import loads_fault, seated_fault
from fixture_design.verification.loading_proofs import loadable_fault

#: What is wrong with a finding about these contacts of its group; None if nothing is.
UseProof = Callable[[Finding, Sequence[Contact]], str | None]

USE_PROOFS: dict[str, UseProof] = {
    "loadable": loadable_fault,
    "accurate": accuracy_fault,
    "seated": seated_fault,
    "holds_loads": loads_fault,
}
