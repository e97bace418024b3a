//! Models with correction terms.

use frikan_runtime::shared::effect::{Effect, Element, Harmonic, Kind, MAX_EFFECTS};
use frikan_runtime::shared::model::Input;
use frikan_runtime::shared::table::{Cell, Table, Uniform, UniformShape};
use frikan_runtime::shared::units::{Quantity, Unit};

use super::{TestModel, symmetric_table};

/// Width of the smoothed sign, rad/s.
const SMOOTHING: f32 = 0.02;

/// A table of Stribeck friction that reads position, load and temperature as well, with `effects`; the last cell of its pool is left to
/// a table of an effect.
///
/// # Panics
/// Where there are more effects than a model holds, or one is not valid.
#[must_use]
pub fn with_effects(effects: &[Effect]) -> TestModel {
    let mut model = symmetric_table();
    let channels = [
        (Quantity::Position, Unit::Radian, 3.0),
        (Quantity::Load, Unit::NewtonMetre, 20.0),
        (Quantity::Temperature, Unit::Celsius, 60.0),
    ];
    model.inputs.extend(channels.map(|(quantity, unit, high)| Input { quantity, unit, low: -high, high }));
    let own_cell = Cell::from_floats([0.3, -0.2, 0.1, 0.05]);
    model.cells = model.cells.iter().copied().chain([own_cell]).collect();
    model.effects.extend(effects.iter().cloned());
    model.validate().expect("the tests' models are valid");
    model
}

/// An effect of each kind and form, with a name.
#[must_use]
pub fn every_effect() -> Vec<(&'static str, Effect)> {
    let smoothing_velocity = SMOOTHING;
    let line = |order: f32| Harmonic { order, cosine: 0.4, sine: -0.3 };
    let harmonics: heapless::Vec<Harmonic, 4> = [1.0, 7.0, 12.0].map(line).into_iter().collect();
    let ripple = |kind| Effect::Ripple { kind, smoothing_velocity, harmonics: harmonics.clone() };
    let first_cell = symmetric_table().cells.len() as u16;
    let table = Table::Uniform(Uniform::new(UniformShape { first_cell, cells: 1, low: -2.0, high: 2.0 }));
    let of_table = |kind| Effect::PositionTable { kind, smoothing_velocity, table };
    let temperature =
        |decay| Effect::Temperature { reference: 20.0, coulomb: -0.1, viscous: -0.05, decay, smoothing_velocity };
    vec![
        ("FrictionalLag", Effect::FrictionalLag { time_constant: 0.01 }),
        ("Coulomb", Effect::Coulomb { coulomb: 0.5, viscous: 0.1, smoothing_velocity }),
        ("Stribeck", Effect::Stribeck { amplitude: 2.0, velocity: 0.1, exponent: 0.5, smoothing_velocity }),
        ("PowerViscous", Effect::PowerViscous { coefficient: 1.0, exponent: 0.7, smoothing_velocity }),
        ("Asymmetry", Effect::Asymmetry { coulomb: 0.5, viscous: 0.1, smoothing_velocity }),
        ("Temperature", temperature(0.0)),
        ("Temperature of a grease", temperature(0.03)),
        (
            "WarmUp",
            Effect::WarmUp { time_constant: 60.0, coulomb: -0.1, viscous: 0.1, power_limit: 20.0, smoothing_velocity },
        ),
        (
            "Load",
            Effect::Load {
                mean: 0.05,
                difference: 0.01,
                quadratic: 1.0e-3,
                stribeck: 0.3,
                velocity: 0.1,
                smoothing_velocity,
            },
        ),
        ("Presliding", presliding(1)),
        ("Presliding of four elements", presliding(4)),
        (
            "DwellBreakaway",
            Effect::DwellBreakaway {
                gain: 1.0,
                time: 0.1,
                distance: 1.0e-2,
                rest_velocity: 1.0e-3,
                dwell_limit: 100.0,
                smoothing_velocity,
            },
        ),
        ("Ripple of torque", ripple(Kind::Torque)),
        ("Ripple of friction", ripple(Kind::Friction)),
        ("Ripple of position", ripple(Kind::Position)),
        ("PositionTable of torque", of_table(Kind::Torque)),
        ("PositionTable of friction", of_table(Kind::Friction)),
        ("PositionTable of position", of_table(Kind::Position)),
        ("Play", Effect::Play { half_width: 1.0e-2, torque: 1.0 }),
        ("WindupHysteresis", Effect::WindupHysteresis { torque: 2.0, distance: 0.1 }),
        ("Spring", Effect::Spring { stiffness: 1.0, rest: 0.1 }),
    ]
}

/// A model for every effect alone, and models in which as many as one holds are together, by the names of their effects.
#[must_use]
pub fn with_every_effect() -> Vec<(String, TestModel)> {
    let effects = every_effect();
    let alone = effects.iter().map(|(name, effect)| ((*name).to_owned(), with_effects(std::slice::from_ref(effect))));
    let together = effects.chunks(MAX_EFFECTS).map(|chunk| {
        let (names, effects): (Vec<_>, Vec<_>) = chunk.iter().cloned().unzip();
        (names.join(", "), with_effects(&effects))
    });
    let short = [1, 2].into_iter().flat_map(|inputs| {
        let one = (format!("table of {inputs} inputs with one element"), table_with_presliding(inputs, 1));
        [one, (format!("table of {inputs} inputs with four elements"), table_with_presliding(inputs, 4))]
    });
    alone.chain(together).chain([("ways by the velocity".to_owned(), by_velocity())]).chain(short).collect()
}

/// A table of velocity, or of velocity beside a position, with presliding and nothing else: what a drive has most.
#[must_use]
pub fn table_with_presliding(inputs: usize, elements: usize) -> TestModel {
    let mut model = with_effects(&[presliding(elements)]);
    model.inputs.truncate(inputs);
    model.validate().expect("the tests' models are valid");
    model
}

/// Presliding of up to four elements.
fn presliding(count: usize) -> Effect {
    let elements = [(5.0, 1.0e-3), (3.0, 4.0e-3), (2.0, 1.6e-2), (1.0, 6.4e-2)];
    let elements = elements.into_iter().take(count).map(|(torque, distance)| Element { torque, distance });
    Effect::Presliding { smoothing_velocity: SMOOTHING, elements: elements.collect() }
}

/// A table that reads velocity alone, with the effects that go by a way.
#[must_use]
pub fn by_velocity() -> TestModel {
    let goes_by_a_way = |effect: &Effect| {
        matches!(effect, Effect::Presliding { .. } | Effect::DwellBreakaway { .. } | Effect::WindupHysteresis { .. })
    };
    let mut model = symmetric_table();
    model.effects.extend(every_effect().into_iter().map(|(_, effect)| effect).filter(goes_by_a_way));
    model.validate().expect("the tests' models are valid");
    model
}
