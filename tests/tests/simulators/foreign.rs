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
