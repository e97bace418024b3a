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


def test_the_friction_of_a_joint_is_learned_from_a_lerobot_dataset(tmp_path):
    pytest.importorskip("pyarrow")
    import lerobot
    import lerobot_joint
    import numpy as np

    for version in (2, 3):
        lerobot.write(tmp_path / str(version), version)
    old, new = (lerobot_joint.episodes(tmp_path / str(version), "elbow_flex.pos") for version in (2, 3))
    assert len(old) == len(new) == 3
    assert all((one[name] == other[name]).all() for one, other in zip(old, new) for name in ("time_s", "state", "action"))
    seen, _ = lerobot.elbow(0.3)
    assert np.allclose(new[0]["state"], seen, atol=1e-4) and new[1]["time_s"][0] == 0

    fitted = lerobot_joint.fitted(tmp_path / "3", "elbow_flex.pos", lerobot.JOINT)
    assert fitted.parameters["coulomb_torque"]["value"] == pytest.approx(lerobot.COULOMB, rel=0.05)
    # Simulated under the actions of the episode that was not fitted, the elbow goes where it went.
    left_out = fitted.json["rollout"]["test"][0]
    assert left_out["position"]["mae"] < 1e-3
