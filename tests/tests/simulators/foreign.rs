//! Pairs of `tests/simulators/foreign_pairs.py`, on which the diagnosis is measured.

use std::fs;
use std::path::Path;

use crate::programs::{json, python, script};

/// What a healthy joint, one of another Coulomb level and one with a Stribeck effect leave behind the refit, over the friction.
const LEFT: &str = "
import json
import numpy as np
from foreign.pair import Bench, Case, refit, rms
from foreign.effects import EFFECTS
from foreign.joint import Plant
from foreign.motion import random_motion
left = {}
for name in ('none', 'coulomb_level', 'stribeck'):
    rng = np.random.default_rng(3)
    bench = Bench(Case((3, 0, 0), 'simulation', name, 1.0, 'white', 'mujoco', 'multisine', 250, 'free'), rng)
    _, motion = random_motion('multisine', rng, 8.0)
    log = bench.recorded(motion, Plant() if name == 'none' else EFFECTS[name].plant(bench.joint, motion, rng)(1.0))
    left[name] = [part / rms(log.friction) for part in (rms(log.effect), rms(refit(log, bench.joint, True)[1]))]
print(json.dumps(left))
";

/// The largest difference of the torque that MuJoCo's actuator puts out from that of its constants, over the largest torque.
const LAW: &str = "
import json
import numpy as np
from foreign import in_mujoco, servo
from foreign.joint import Plant, random_joint
from foreign.motion import random_motion
apart = {}
for kind in servo.KINDS:
    rng = np.random.default_rng(3)
    joint = random_joint(rng, True)
    driven = servo.random_servo(kind, joint, rng)
    _, motion = random_motion('multisine', rng, 2.0)
    control = servo.Control(driven, joint, Plant(), motion)
    mechanism = in_mujoco.Mechanism(joint, Plant(), True, driven)
    mechanism.place(motion[0][0], motion[1][0])
    known, made = [], []
    for step in range(1000):
        control.begin(step, *mechanism.state())
        told, torque = control.act(*mechanism.state())
        mechanism.advance(told, 0.0)
        known.append(torque)
        made.append(float(mechanism.data.actuator_force[0]))
    apart[kind] = float(np.abs(np.subtract(known, made)).max() / np.abs(made).max())
print(json.dumps(apart))
";

/// The files of a pair.
fn files(folder: &Path) -> Vec<Vec<u8>> {
    ["real.csv", "simulation.csv", "joint.toml", "truth.json"].map(|name| fs::read(folder.join(name)).unwrap()).into()
}

#[test]
fn a_pair_is_made_from_its_seed_and_number_alone() {
    let Some(python) = python("mujoco, pydrake") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let first = |name: &str, pairs: &str| {
        let folder = scratch.path().join(name);
        script(
            &python,
            &["foreign_pairs.py", "--write", folder.to_str().unwrap(), "--simulation", pairs, "--seed", "111"],
        );
        files(&folder.join("simulation-000"))
    };
    let one = first("one", "1");
    assert_eq!(one, first("two", "2"), "its files depend on how many pairs are asked for");
    assert_eq!(json(&String::from_utf8_lossy(&one[3]))["healthy"], true);
}

#[test]
fn a_refit_takes_a_level_away_and_leaves_an_effect() {
    let Some(python) = python("mujoco, pydrake") else { return };
    let left = json(&script(&python, &["-c", LEFT]));
    let of = |name: &str| [0_usize, 1].map(|at| left[name][at].as_f64().unwrap());
    assert!(of("none")[0] < 1e-3 && of("none")[1] < 1e-3, "a healthy joint departs from itself: {left}");
    let [before, behind] = of("coulomb_level");
    assert!(before > 0.05 && behind < 0.1 * before, "another level is left: {left}");
    let [before, behind] = of("stribeck");
    assert!(behind < before && behind > 0.2 * before, "Stribeck's effect does not show: {left}");
}

#[test]
fn a_servo_reports_positions_and_commands_and_no_torque() {
    let Some(python) = python("mujoco, pydrake") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().to_str().unwrap();
    script(&python, &["foreign_pairs.py", "--write", folder, "--simulation", "0", "--servo", "2", "--seed", "111"]);
    for pair in ["servo-000", "servo-001"] {
        let read = |name: &str| fs::read_to_string(scratch.path().join(pair).join(name)).unwrap();
        let [real, simulated] =
            ["real.csv", "simulation.csv"].map(|name| read(name).lines().next().unwrap_or_default().to_owned());
        assert_eq!(real, simulated, "{pair}");
        assert!(real.starts_with("time_s,position_rad,") && real.contains("reference_position_rad"), "{real}");
        assert!(!real.contains("torque"), "{real}");
        assert!(read("joint.toml").contains("[actuator]"), "{pair}");
    }
}

#[test]
fn a_servo_puts_out_the_torque_of_its_constants() {
    let Some(python) = python("mujoco, pydrake") else { return };
    let apart = json(&script(&python, &["-c", LAW]));
    for kind in ["pd", "position_servo"] {
        assert!(apart[kind].as_f64().unwrap() < 1e-9, "{apart}");
    }
}
