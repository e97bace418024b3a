//! The correction terms as statements that add to the sums `torque` and `place`.

use frikan_shared::effect::{Effect, Kind};

use super::language::Language;
use super::lookup::lookup;

/// Statements of the effect with the memory of number `index`.
pub(super) fn statements_of_effect(language: Language, effect: &Effect, index: usize) -> Vec<String> {
    let number = |x: f32| language.number(x);
    let numbers = |values: &[f32]| values.iter().map(|value| number(*value)).collect::<Vec<_>>().join(", ");
    let motion = language.motion();
    let memory = language.field(&format!("memory[{index}]"));
    let added = |value: String| vec![language.statement(&format!("torque = torque + {value}"))];
    match *effect {
        // The law sees the lagged velocity; a term of nothing turns a friction of -0 to 0, as in the drive.
        Effect::FrictionalLag { .. } => added(number(0.0)),
        Effect::Coulomb { coulomb, viscous, smoothing_velocity } => {
            added(format!("coulomb({motion}, {})", numbers(&[coulomb, viscous, smoothing_velocity])))
        }
        Effect::Stribeck { amplitude, velocity, exponent, smoothing_velocity } => {
            added(format!("stribeck({motion}, {})", numbers(&[amplitude, velocity, exponent, smoothing_velocity])))
        }
        Effect::PowerViscous { coefficient, exponent, smoothing_velocity } => {
            added(format!("power_viscous({motion}, {})", numbers(&[coefficient, exponent, smoothing_velocity])))
        }
        Effect::Asymmetry { coulomb, viscous, smoothing_velocity } => {
            added(format!("asymmetry({motion}, {})", numbers(&[coulomb, viscous, smoothing_velocity])))
        }
        Effect::Temperature { reference, coulomb, viscous, decay, smoothing_velocity } => {
            let arguments = numbers(&[reference, coulomb, viscous, decay, smoothing_velocity]);
            added(format!("temperature_friction({motion}, {arguments})"))
        }
        Effect::WarmUp { time_constant, coulomb, viscous, power_limit, smoothing_velocity } => {
            let (lag, slopes) = (language.row(&[time_constant, power_limit]), numbers(&[coulomb, viscous]));
            added(format!("warm_up({motion}, {memory}, {lag}, {slopes}, {})", number(smoothing_velocity)))
        }
        Effect::Load { mean, difference, quadratic, stribeck, velocity, smoothing_velocity } => {
            let (coefficients, peak) = (language.row(&[mean, difference, quadratic]), numbers(&[stribeck, velocity]));
            added(format!("load_friction({motion}, {coefficients}, {peak}, {})", number(smoothing_velocity)))
        }
        Effect::Presliding { smoothing_velocity, ref elements } => {
            let elements: Vec<[f32; 2]> = elements.iter().map(|element| [element.torque, element.distance]).collect();
            let elements = language.rows(&elements);
            added(format!("presliding({motion}, {memory}, {elements}, {})", number(smoothing_velocity)))
        }
        Effect::DwellBreakaway { gain, time, distance, rest_velocity, dwell_limit, smoothing_velocity } => {
            let constants = language.row(&[gain, time, distance, rest_velocity, dwell_limit]);
            added(format!("dwell_breakaway({motion}, {memory}, {constants}, {})", number(smoothing_velocity)))
        }
        Effect::Ripple { kind, smoothing_velocity, ref harmonics } => {
            let lines: Vec<[f32; 3]> = harmonics.iter().map(|line| [line.order, line.cosine, line.sine]).collect();
            of_kind(language, kind, &format!("ripple({motion}, {})", language.rows(&lines)), smoothing_velocity)
        }
        Effect::PositionTable { kind, smoothing_velocity, ref table } => {
            of_kind(language, kind, &lookup(language, table, "m.position"), smoothing_velocity)
        }
        Effect::Play { half_width, torque } => {
            let behind = format!("behind_{index}");
            let play = format!("play({motion}, {memory}, {})", number(half_width));
            let mut statements = vec![language.constant(&behind, &play)];
            statements.extend(added(format!("{} * ({behind} / {})", number(torque), number(half_width))));
            statements.push(language.statement(&format!("place = place - {behind}")));
            statements
        }
        Effect::WindupHysteresis { torque, distance } => {
            added(format!("windup({motion}, {memory}, {})", numbers(&[torque, distance])))
        }
        Effect::Spring { stiffness, rest } => added(format!("spring({motion}, {})", numbers(&[stiffness, rest]))),
    }
}

/// A value as what a kind says.
fn of_kind(language: Language, kind: Kind, value: &str, width: f32) -> Vec<String> {
    let sign = format!("smooth_sign({}, {})", language.motion(), language.number(width));
    let (torque, place) = match kind {
        Kind::Torque => (value.to_owned(), None),
        Kind::Friction => (format!("{value} * {sign}"), None),
        Kind::Position => (language.number(0.0), Some(language.statement(&format!("place = place + {value}")))),
    };
    std::iter::once(language.statement(&format!("torque = torque + {torque}"))).chain(place).collect()
}

/// Whether an effect adds to the position.
pub(super) fn moves_link(effect: &Effect) -> bool {
    matches!(
        effect,
        Effect::Play { .. }
            | Effect::Ripple { kind: Kind::Position, .. }
            | Effect::PositionTable { kind: Kind::Position, .. }
    )
}
