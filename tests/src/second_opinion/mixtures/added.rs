//! Effects that add a torque to a recording, each at about half of Coulomb friction, and the recording of several.

use crate::second_opinion::joint::Joint;
use crate::second_opinion::motion::Trajectory;
use crate::second_opinion::numeric::{peak, quantile, range};
use crate::second_opinion::protocol::{Fine, Protocol};
use crate::second_opinion::random::{Random, factor, phase};
use crate::second_opinion::recording::Recording;
use crate::second_opinion::singles::dahl;

/// An effect on a motion: its torque (N m or N), a temperature (degC) where it has one, and what it is in words.
struct Added {
    torque: Vec<f64>,
    temperature: Option<Vec<f64>>,
    note: String,
}

/// Size of an effect, Coulomb frictions.
const SIZE: f64 = 0.5;
/// Order of a ripple of a screw of 20 mm lead, 1/m.
const SCREW: f64 = std::f64::consts::TAU / 0.02;

fn added(name: &str, joint: &Joint, path: &Trajectory, random: &mut Random) -> Added {
    let share = SIZE * factor(random);
    let size = share * joint.coulomb;
    let top = joint.top_speed;
    let reach = peak(&path.position);
    let sign = |v: f64| joint.sign(v);
    let last = path.time[path.len() - 1];
    let mut temperature = None;
    let (torque, note) = match name {
        "stribeck" => {
            let speed = 0.06 * top;
            let torque = path.map(|_, _, v, _| size * (-(v / speed).powi(2)).exp() * sign(v));
            (torque, format!("break-away {size:.3}, Stribeck velocity {speed:.3}"))
        }
        "position_ripple" => {
            let order = if joint.linear { SCREW } else { (9.0 / reach).round() };
            let (height, phase) = (0.5 * size, phase(random));
            (path.map(|_, q, _, _| height * (order * q + phase).sin()), format!("{height:.3} of order {order:.0}"))
        }
        "temperature" => {
            let course = path.map(|t, _, _, _| {
                let cooling = 8.0 * ((t - 0.6 * last) / (0.4 * last)).clamp(0.0, 1.0);
                25.0 + 12.0 * (1.0 - (-4.0 * t / last).exp()) - cooling
            });
            let (coulomb, viscous) = (0.036 * share * joint.coulomb, 0.024 * share * joint.viscous);
            let colder = |(v, t): (&f64, &f64)| -(coulomb * sign(*v) + viscous * v) * (t - 25.0);
            let torque = path.velocity.iter().zip(&course).map(colder).collect();
            let note = format!("-{:.1} %/K up to {:.0} degC and back", 3.6 * share, range(&course).1);
            temperature = Some(course);
            (torque, note)
        }
        "presliding" => {
            let distance = 0.006 * reach * factor(random);
            let level = dahl(&path.position, distance);
            let torque = level.iter().zip(&path.velocity).map(|(z, v)| joint.coulomb * (z - sign(*v))).collect();
            (torque, format!("distance {distance:.4}"))
        }
        "torque_offset" => (vec![0.5 * size; path.len()], format!("{:.3}", 0.5 * size)),
        "load_friction" => {
            let load = path.map(|_, q, _, a| joint.rigid_body(q, a));
            let share = 1.6 * size / peak(&load);
            let torque = load.iter().zip(&path.velocity).map(|(load, v)| share * load.abs() * sign(*v)).collect();
            (torque, format!("{share:.3} of the load"))
        }
        "viscous_nonlinearity" => {
            let coefficient = 2.0 * size / (top * top);
            (path.map(|_, _, v, _| coefficient * v * v.abs()), format!("{coefficient:.3} v^2"))
        }
        "friction_level" => {
            let viscous = 0.3 * size / top;
            let torque = path.map(|_, _, v, _| size * sign(v) + viscous * v);
            (torque, format!("{size:.3} of Coulomb and {viscous:.3} v of viscous friction more"))
        }
        "direction_asymmetry" => {
            let (coulomb, viscous) = (0.4 * size, 0.2 * share * joint.viscous);
            let torque = path.map(|_, _, v, _| coulomb * sign(v).abs() + viscous * v.abs());
            (torque, format!("twice {coulomb:.3} and {viscous:.3} v"))
        }
        "gravity_error" => {
            let turned = joint.gravity_phase_rad + 0.5;
            (path.map(|_, q, _, _| size * (q + turned).sin()), format!("{size:.3}, turned by 0.5 rad"))
        }
        "inertia_error" => {
            let inertia = 1.5 * size / peak(&path.acceleration);
            (path.map(|_, _, _, a| inertia * a), format!("{:+.0} %", 100.0 * inertia / joint.inertia))
        }
        "contact" => {
            let at = quantile(&path.position, 0.9);
            let stiffness = 1.5 * size / (range(&path.position).1 - at);
            (path.map(|_, q, _, _| stiffness * (q - at).max(0.0)), format!("from {at:.3} on, {stiffness:.3} a unit"))
        }
        "spring" => (path.map(|_, q, _, _| size * q / reach), format!("up to {size:.3}")),
        "slow_drift" => {
            (path.map(|t, _, v, _| 1.2 * size * t / last * sign(v)), format!("{:+.3} over the recording", 1.2 * size))
        }
        "transient_event" => {
            let begin = random.uniform(0.35, 0.55) * last;
            let push = |t: f64| if t > begin && t < begin + 1.0 { 1.3 * size } else { 0.0 };
            (path.map(|t, _, _, _| push(t)), format!("{:.3} for 1 s at {begin:.1} s", 1.3 * size))
        }
        "position_friction" => {
            let at = 0.3 * reach * factor(random);
            let hump = |q: f64| size * (-((q - at) / (0.25 * reach)).powi(2)).exp();
            (path.map(|_, q, v, _| hump(q) * sign(v)), format!("hump of {size:.3} at {at:.3}"))
        }
        other => unreachable!("{other} is no effect of a mixture"),
    };
    Added { torque, temperature, note: format!("{name}: {note}") }
}

/// Which samples are recorded and how.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taken {
    /// Fine steps of a sample.
    pub step: usize,
    /// Share of the motion that is recorded.
    pub share: f64,
    /// Time of the first sample, s.
    pub begin_s: f64,
    /// Noise of the torque, % of Coulomb friction, and its correlation.
    pub noise: (f64, f64),
    /// Noise of the velocity as a share of the top speed.
    pub velocity_noise: f64,
}

impl Taken {
    /// As the protocol has it.
    pub(super) const fn by(protocol: &Protocol, step: usize) -> Self {
        let noise = (protocol.noise_percent, protocol.correlation);
        Self { step, share: 1.0, begin_s: 0.0, noise, velocity_noise: 1e-4 }
    }
}

/// The recording of a motion with these effects, and what they are in words.
pub(super) fn record(
    protocol: &Protocol,
    fine: &Fine,
    effects: &[&str],
    taken: Taken,
    random: &mut Random,
) -> (Recording, String) {
    let joint = &fine.joint;
    let mut torque = Protocol::torque(joint, &fine.path);
    let mut notes = Vec::new();
    let mut temperature = None;
    for name in effects {
        let effect = added(name, joint, &fine.path, random);
        torque.iter_mut().zip(&effect.torque).for_each(|(sum, torque)| *sum += torque);
        notes.push(effect.note);
        temperature = effect.temperature.or(temperature);
    }
    let count = (taken.share * fine.path.len() as f64) as usize;
    let rows: Vec<usize> = (0..count).step_by(taken.step).collect();
    let at_rows = |values: &[f64]| -> Vec<f64> { rows.iter().map(|i| values[*i]).collect() };
    let mut path = fine.path.at(&rows);
    path.time.iter_mut().for_each(|t| *t += taken.begin_s);
    let mut torque = at_rows(&torque);
    let disturbed = Protocol { noise_percent: taken.noise.0, correlation: taken.noise.1, ..*protocol };
    disturbed.disturb(&mut torque, random);
    let mut recording = Protocol::columns(joint, &path, torque, taken.velocity_noise, random);
    if let Some(course) = temperature {
        let hundredths = |t: &f64| (100.0 * t).round() / 100.0;
        recording.put("temperature_C", at_rows(&course).iter().map(hundredths).collect());
    }
    (recording, if notes.is_empty() { String::from("nothing missing") } else { notes.join("; ") })
}
