//! Rigid body and torque chain.

use super::Bench;
use crate::second_opinion::numeric::peak;

/// The weight is larger by a share and stands at another angle.
pub(super) fn gravity_error(bench: &mut Bench, share: f64, phase_rad: f64) {
    let (share, phase_rad) = (bench.about(share), bench.about(phase_rad));
    let joint = bench.joint;
    bench.add(|_, q, _, _| (1.0 + share) * joint.weight(q + phase_rad) - joint.weight(q));
    bench.note = format!("weight {:+.0} %, turned by {phase_rad:.2} rad", 100.0 * share);
}

/// The inertia is larger by a share.
pub(super) fn inertia_error(bench: &mut Bench, share: f64) {
    let share = bench.about(share);
    let inertia = bench.joint.inertia;
    bench.add(|_, _, _, a| share * inertia * a);
    bench.note = format!("inertia {:+.0} %", 100.0 * share);
}

/// The rigid body is felt larger by a share.
pub(super) fn torque_scale(bench: &mut Bench, share: f64) {
    let share = bench.about(share);
    bench.extra = bench.rigid_body.iter().map(|torque| share * torque).collect();
    bench.note = format!("torque of the rigid body {:+.0} %", 100.0 * share);
}

/// A constant torque.
pub(super) fn torque_offset(bench: &mut Bench, torque: f64) {
    let torque = bench.torque(torque);
    bench.add(|_, _, _, _| torque);
    bench.note = format!("offset {torque:.3}");
}

/// A spring that is at rest a fifth of the way out.
pub(super) fn spring(bench: &mut Bench, torque: f64) {
    let torque = bench.torque(torque);
    let rest = bench.about(0.2) * peak(&bench.path.position);
    let strain = bench.path.map(|_, q, _, _| q - rest);
    let widest = peak(&strain);
    bench.extra = strain.iter().map(|strain| torque * strain / widest).collect();
    bench.note = format!("spring of up to {torque:.3} about {rest:.3}");
}
