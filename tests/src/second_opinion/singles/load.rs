//! Friction that grows with the load.

use super::{Bench, RigidBody};
use crate::second_opinion::numeric::peak;
use crate::second_opinion::random::phase;
use std::f64::consts::TAU;

/// Where the load comes from.
#[derive(Clone, Copy, Debug)]
pub enum Load {
    /// The rigid body.
    RigidBody,
    /// A brake that holds eight levels one after the other.
    Brake,
    /// A load that swings.
    Swinging,
}

/// Levels of the brake, half Coulomb frictions.
const LEVELS: [f64; 8] = [0.0, 2.0, -2.0, 1.0, -1.0, 3.0, -3.0, 0.5];
/// Time of a change of level, s.
const CHANGE_S: f64 = 0.1;

/// Friction of a share of the load, one where the load is driven, one where it drives.
pub(super) fn friction(bench: &mut Bench, load: Load, driving: f64, driven: f64) {
    let (driving, driven) = if driving.to_bits() == driven.to_bits() {
        let share = bench.about(driving);
        (share, share)
    } else {
        (bench.about(driving), bench.about(driven))
    };
    let torque = match load {
        Load::RigidBody => bench.rigid_body.clone(),
        Load::Brake => brake(bench),
        Load::Swinging => swinging(bench),
    };
    if !matches!(load, Load::RigidBody) {
        bench.columns.push(("load_torque_Nm", torque.clone()));
        if bench.known_by == RigidBody::Column {
            for (index, torque) in torque.iter().enumerate() {
                bench.rigid_body[index] += torque;
                bench.stated_rigid_body[index] += torque;
            }
        }
    }
    let signs = bench.signs();
    let share = |i: usize| if torque[i] * bench.path.velocity[i] > 0.0 { driving } else { driven };
    bench.extra = (0..torque.len()).map(|i| share(i) * torque[i].abs() * signs[i]).collect();
    bench.note = format!(
        "{driving:.3} of the load when it is driven, {driven:.3} when it drives; {load:?}, up to {:.1} of Coulomb friction",
        peak(&torque) / bench.joint.coulomb
    );
}

fn brake(bench: &mut Bench) -> Vec<f64> {
    let part_s = bench.grid.duration_s() / LEVELS.len() as f64;
    let levels = LEVELS.map(|level| 0.5 * level * bench.joint.coulomb * bench.random.uniform(0.85, 1.15));
    let edge = |t: f64, part: usize| ((t - part_s * part as f64) / CHANGE_S).tanh();
    let at = |t: f64| levels.iter().enumerate().map(|(k, level)| 0.5 * level * (edge(t, k) - edge(t, k + 1))).sum();
    bench.path.time.iter().map(|t| at(*t)).collect()
}

fn swinging(bench: &mut Bench) -> Vec<f64> {
    let (fast, slow) = (phase(bench.random), phase(bench.random));
    let swing = |t: &f64| 3.0 * bench.joint.coulomb * (TAU * 0.17 * t + fast).sin() * (TAU * 0.031 * t + slow).sin();
    bench.path.time.iter().map(swing).collect()
}
