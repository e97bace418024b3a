"""The examples run, and bring what they promise."""

import sys

import pytest
from command_line import FIXTURES, ROOT

sys.path.insert(0, str(ROOT / "trainer/python/examples"))


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_a_gymnasium_joint_keeps_the_manners_of_an_environment_and_its_friction_can_be_compensated():
    pytest.importorskip("gymnasium")
    import gymnasium_joint
    from gymnasium.utils.env_checker import check_env

    joint = gymnasium_joint.Joint(FIXTURES / "elbow.frk")
    check_env(joint, skip_render_check=True)
    without, compensated = (gymnasium_joint.left_after(joint, compensates) for compensates in (False, True))
    # Two newton metres of Coulomb friction hold what 20 N m/rad pull at.
    assert without == pytest.approx(0.1, abs=0.01) and compensated < 0.01


def test_what_a_mujoco_model_leaves_out_is_named():
    pytest.importorskip("mujoco")
    import mujoco_difference

    found = mujoco_difference.compared(FIXTURES / "elbow.toml")
    assert {finding["effect"] for finding in found.findings} == {"stribeck", "presliding"}
