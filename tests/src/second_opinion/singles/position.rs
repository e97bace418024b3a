//! What depends on the position.

use super::Bench;
use crate::second_opinion::numeric::range;
use crate::second_opinion::random::phase;

/// Ripples of these orders (cycles over 2 pi, relative amplitude), of the torque or of the friction.
pub(super) fn ripple(bench: &mut Bench, torque: f64, orders: &[[f64; 2]], of_friction: bool) {
    let torque = bench.torque(torque);
    let waves: Vec<[f64; 3]> =
        orders.iter().map(|[order, share]| [*order, torque * share, phase(bench.random)]).collect();
    let joint = bench.joint;
    bench.add(|_, q, v, _| {
        let sum: f64 = waves.iter().map(|[order, height, phase]| height * (order * q + phase).sin()).sum();
        if of_friction { sum * joint.sign(v) } else { sum }
    });
    let orders: Vec<f64> = orders.iter().map(|[order, _]| *order).collect();
    let of = if of_friction { "friction" } else { "torque" };
    bench.note = format!("ripple of the {of}, {torque:.3}, orders {orders:.4?}");
}

/// A gear that turns unevenly shakes the inertia behind it.
pub(super) fn kinematic_error(bench: &mut Bench, order: f64, amplitude_rad: f64, link_column: bool) {
    let amplitude = bench.about(amplitude_rad);
    let phase = phase(bench.random);
    let inertia = bench.joint.inertia;
    bench.add(|_, q, v, a| {
        let (sine, cosine) = (order * q + phase).sin_cos();
        -inertia * amplitude * (order * cosine * a - order * order * sine * v * v)
    });
    if link_column {
        let link = bench.path.map(|_, q, _, _| q - amplitude * (order * q + phase).sin());
        bench.columns.push(("link_position_rad", link));
    }
    let seen = if link_column { "with" } else { "without" };
    bench.note = format!("uneven by {amplitude:.1e} rad, order {order}, {seen} the position of the link");
}

/// How friction lies over the range.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// One hump.
    Bump,
    /// Evenly rising.
    Linear,
    /// A step.
    Edge,
    /// A hump and a dip.
    Two,
}

/// Coulomb friction that differs along the range.
pub(super) fn friction(bench: &mut Bench, torque: f64, shape: Shape) {
    let torque = bench.torque(torque);
    let shift = bench.random.uniform(-0.05, 0.05);
    let (low, high) = range(&bench.path.position);
    let joint = bench.joint;
    bench.add(|_, q, v, _| {
        let x = (q - low) / (high - low) + shift;
        let hump = |at: f64, width: f64| (-((x - at) / width).powi(2)).exp();
        let height = match shape {
            Shape::Bump => hump(0.62, 0.13),
            Shape::Linear => x,
            Shape::Edge => 1.0 / (1.0 + (-(x - 0.7) / 0.04).exp()),
            Shape::Two => hump(0.25, 0.1) - 0.6 * hump(0.7, 0.15),
        };
        torque * height * joint.sign(v)
    });
    bench.note = format!("friction of up to {torque:.3} along the range, {shape:?}");
}
