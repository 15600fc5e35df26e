import numpy as np
import pytest

from recalib import Row, arm_of_table, load_arm
from recalib.laboratory.command_line import main
from recalib.laboratory.urdf.dh_table import read_rows, urdf_of
from recalib.nominal import CONVENTIONS

TABLE = """joint,a [mm],alpha [deg],d [cm],theta [rad],kind
waist,10,-90,40,0.1,revolute
shoulder,0,90,15,0,revolute
boom,0,0,0,0,prismatic
"wrist & co",-25,30,5,-0.3,revolute
"""


@pytest.fixture
def path(tmp_path):
    (path := tmp_path / "links.csv").write_text(TABLE)
    return path


def test_a_table_is_read_in_its_units(path):
    rows = read_rows(path)
    assert rows[0] == Row("waist", 0.01, -np.pi / 2, 0.4, 0.1)
    assert [row.slides for row in rows] == [False, False, True, False]
    path.write_text("joint,a [mm],alpha [deg],d [cm],theta [rad]\nwaist,10,-90,40,0.1\n")
    assert read_rows(path) == rows[:1]


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_the_urdf_of_a_table_is_its_arm(convention, path, tmp_path, capsys):
    out = tmp_path / "arm.urdf"
    assert main(["urdf", str(path), "--convention", convention, "--out", str(out)]) == 0
    said = f"{out}: waist, shoulder, boom, wrist & co, from base to tool\n"
    assert capsys.readouterr().out == said
    arm, again = arm_of_table(read_rows(path), convention), load_arm(out)
    assert out.read_text() == urdf_of(arm)
    assert (again.joints, again.tool, again.base) == (arm.joints, arm.tool, arm.base)
    assert again.massless and np.isinf(again.model.upperPositionLimit).all()
    angles = np.random.default_rng(0).uniform(-2, 2, (10, 4))
    np.testing.assert_allclose(again.forward(angles), arm.forward(angles), rtol=0, atol=1e-12)
