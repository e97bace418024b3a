//! The shape of the velocity law.

use super::Bench;

/// Break-away that falls with speed as exp(-(v/vs)^exponent).
pub(super) fn stribeck(bench: &mut Bench, torque: f64, speed: f64, exponent: f64) {
    let torque = bench.torque(torque);
    let speed = bench.about(speed * bench.joint.top_speed);
    let joint = bench.joint;
    bench.add(|_, _, v, _| torque * (-(v.abs() / speed).powf(exponent)).exp() * joint.sign(v));
    bench.note = format!("break-away {torque:.3}, Stribeck velocity {speed:.3}, exponent {exponent}");
}

/// A power of the speed beside the first.
pub(super) fn nonlinearity(bench: &mut Bench, torque: f64, power: f64) {
    let torque = bench.torque(torque);
    let joint = bench.joint;
    bench.add(|_, _, v, _| torque * (v.abs() / joint.top_speed).powf(power) * joint.sign(v));
    bench.note = format!("{torque:.3} times the speed to the power of {power}");
}

/// Friction that differs between the directions, Coulomb friction and its growth with speed.
pub(super) fn asymmetry(bench: &mut Bench, torque: f64, viscous: f64) {
    let (torque, viscous) = (bench.torque(torque), bench.torque(viscous));
    let joint = bench.joint;
    bench.add(|_, _, v, _| torque * joint.sign(v).abs() + viscous * v.abs() / joint.top_speed);
    bench.note = format!("directions differ by twice {torque:.3} and {viscous:.3} at top speed");
}
