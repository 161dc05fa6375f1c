"""Studies hold the files that they name: a study does not change when they do."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest

import quell

LAW = "slip_velocity_m_per_s,coefficient\n" + "".join(f"{0.02 * i},{0.3 + 0.1 * 2.0 ** -i:.6f}\n" for i in range(30))


@pytest.fixture
def drive(tmp_path: Path) -> quell.Study:
    """A system in millimetres whose law is measured in metres per second."""
    (tmp_path / "law.csv").write_text(LAW)
    (tmp_path / "drive.toml").write_text(
        "[system]\nunits = 'mm-t-s'\ncoordinates = ['x']\nmass = [0.001]\nstiffness = [400]\n[[contact]]\nname = 'pad'\n"
        "tangent = { x = 1 }\nnormal_load = 100\nbelt_velocity = 50\n[contact.friction]\nlaw = 'samples'\nfile = 'law.csv'\n"
    )
    return quell.Study.from_toml(tmp_path / "drive.toml")


@pytest.mark.parametrize("lost", [False, True])
def test_changed_replaced_and_pickled_studies_keep_their_files(drive: quell.Study, tmp_path: Path, lost: bool) -> None:
    assert isinstance(drive, quell.System)
    changed = drive.set({"contact.pad.normal_load": 120.0})
    replaced = drive.replace(title="renamed")
    law = tmp_path / "law.csv"
    if lost:
        law.unlink()
    else:
        law.write_text(LAW.replace("0.3", "0.2"))
    assert drive.set({"contact.pad.normal_load": 120.0}) == changed
    assert drive.replace(title="renamed") == replaced
    again = pickle.loads(pickle.dumps(drive))
    assert again == drive and again.set({"contact.pad.normal_load": 120.0}) == changed
    assert again.friction([100.0]).facts == drive.friction([100.0]).facts
    assert again.replace(title="renamed").friction([100.0]).facts == replaced.friction([100.0]).facts
