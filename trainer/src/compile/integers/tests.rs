use super::*;
use crate::compile::formula::tests::stribeck_law;
use crate::compile::formula::{Curve, Formula, Operator};
use crate::compile::host_model::HostModel;
use crate::compile::integers::steps::IntegerReference;
use crate::compile::reference::integer_value;
use frikan_runtime::integer::IntegerTableInPlace;
use frikan_shared::image::{Image, encode};
use frikan_shared::model::{Input, Law, Provenance, RigidBody};
use frikan_shared::units::{Quantity, Unit};
use proptest::prelude::*;

fn wanted(low: f64, high: f64, bound: f64) -> Wanted {
    Wanted { range: [low, high], velocity_count: None, torque_count: None, bound, cells: 128 }
}

/// The law as the trainer has it: held at the ends of its range.
fn held(law: Formula, [low, high]: [f64; 2]) -> impl Fn(f64) -> f64 + Sync {
    move |velocity| law.value(velocity.clamp(low, high))
}

fn model(compiled: &IntegerLaw, [low, high]: [f64; 2]) -> HostModel {
    let (quantity, unit) = (Quantity::Velocity, Unit::RadianPerSecond);
    HostModel {
        law: Law::IntegerTable(compiled.table),
        cells: Pool::from_slice(&compiled.cells).unwrap(),
        inputs: std::iter::once(Input { quantity, unit, low: low as f32, high: high as f32 }).collect(),
        output_unit: Unit::NewtonMetre,
        output_limit: 1.0e3,
        rigid_body: RigidBody::default(),
        effects: heapless::Vec::new(),
    }
}

/// Largest difference of a drive's torque, by the drive's own code, at every count of 16 bits.
fn observed(compiled: &IntegerLaw, law: VelocityLaw<'_>, range: [f64; 2]) -> f64 {
    let mut buffer = vec![0; 1 << 16];
    let image = Image { provenance: Provenance::default(), model: model(compiled, range) };
    let image = encode(&image, &mut buffer).unwrap();
    let drive = IntegerTableInPlace::new(image, compiled.units).unwrap();
    let Units { velocity, torque } = compiled.units;
    let difference = |count: i32| {
        let expected = if count == 0 { 0.0 } else { law(f64::from(count) * f64::from(velocity)) };
        (f64::from(drive.friction(count)) * f64::from(torque) - expected).abs()
    };
    (-32_768..=32_767).map(difference).fold(0.0, f64::max)
}

#[test]
fn the_law_of_the_paper_fits_a_thousandth_of_its_range_in_integers() {
    let sided = stribeck_law().join(Operator::Add, Formula::Input(0).apply(crate::compile::formula::Function::Cos));
    for (law, range) in [(stribeck_law(), [-2.0, 2.0]), (sided, [-1.4, 2.0])] {
        let law = held(law, range);
        let compiled = compile_integers(&law, &wanted(range[0], range[1], 0.01)).unwrap();
        println!("{:?}: {} cells, {:?}", compiled.units, compiled.cells.len(), compiled.error);
        assert!(compiled.error.share() < 1.0e-3);
        // Q formats of 16 bits.
        let Units { velocity, torque } = compiled.units;
        assert!(q_format(velocity).is_some() && q_format(torque).is_some(), "{:?}", compiled.units);
        let observed = observed(&compiled, &law, range);
        // A count beyond the range, where the law is held.
        assert!((observed - compiled.error.largest).abs() < 2.0e-3, "{observed} {:?}", compiled.error);
    }
}

#[test]
fn integers_agree_exactly() {
    let sided = stribeck_law().join(Operator::Add, Formula::Constant(0.3));
    for law in [stribeck_law(), sided] {
        let compiled = compile_integers(&held(law, [-2.0, 2.0]), &wanted(-2.0, 2.0, 5.0e-2)).unwrap();
        let shape = compiled.table.shape();
        let pool = Pool::<128>::from_slice(&compiled.cells).unwrap();
        let around_the_ends = [i32::MIN, i32::MIN + 1, i32::MAX, -1, 0, 1];
        for steps in (-300_000..300_000).chain((i32::MIN..i32::MAX).step_by(40_009)).chain(around_the_ends) {
            assert_eq!(
                evaluate_integer(&compiled.table, &pool, steps),
                integer_value(&shape, &compiled.cells, steps),
                "{steps}"
            );
        }
    }
}

#[test]
fn counts_that_cannot_be_are_refused() {
    let law = held(stribeck_law(), [-2.0, 2.0]);
    let refused = |wanted: Wanted| compile_integers(&law, &wanted).unwrap_err();
    let open = wanted(-2.0, 2.0, 0.02);
    assert!(matches!(refused(wanted(1.0, 1.0, 0.02)), IntegerError::Range { .. }));
    for count in [2.5, 1.0e-7] {
        let error = refused(Wanted { velocity_count: Some(count), ..open });
        assert!(matches!(error, IntegerError::VelocityCount { .. }), "{error}");
    }
    let error = refused(Wanted { torque_count: Some(1.0e-4), ..open });
    assert!(matches!(error, IntegerError::TorqueCount { .. }), "{error}");
    assert!(matches!(refused(Wanted { cells: 15, ..open }), IntegerError::Cells { cells: 15 }));
    let nowhere = |velocity: f64| 1.0 / (velocity - 1.0).max(0.0);
    assert!(matches!(compile_integers(&nowhere, &open), Err(IntegerError::Range { .. })));
}

#[test]
fn powers_of_two_have_a_format() {
    let formats = [2f32.powi(-12), 1.0, 2f32.powi(-15), 2f32.powi(-16), 2.0, 0.001].map(q_format);
    assert_eq!(
        formats.each_ref().map(Option::as_deref),
        [Some("Q3.12"), Some("Q15.0"), Some("Q0.15"), None, None, None]
    );
}

/// Velocities of 24 bits, torques of per mille of 50 N m.
#[test]
fn counts_of_the_drive_are_taken_as_they_are() {
    let law = held(stribeck_law(), [-2.0, 2.0]);
    let counts = Wanted { velocity_count: Some(1.0e-6), torque_count: Some(0.05), ..wanted(-2.0, 2.0, 0.025) };
    let compiled = compile_integers(&law, &counts).unwrap();
    println!("{} cells, {:?}", compiled.cells.len(), compiled.error);
    assert_eq!(compiled.units, Units { velocity: 1.0e-6, torque: 0.05 });
    assert_eq!(compiled.error.counts, 2 * 2_000_000 + 1);
    // The bound, half a count of torque, and what comes of the steps of the table.
    assert!(compiled.error.largest <= 0.07);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Whatever the law and the counts: the error told is the drive's at every count, and no more than the bound that its cells allow.
    #[test]
    fn the_error_told_is_that_of_the_drive(
        coulomb in 0.1f64..40.0, stribeck in -0.2f64..2.0, width in 0.02f64..0.5, smooth in 2.0f64..80.0,
        viscous in 0.0f64..5.0, offset in prop_oneof![Just(0.0), -0.5f64..0.5], low in -8.0f64..-0.5, high in 0.5f64..8.0,
        counts in prop_oneof![Just(None), (200.0f64..30_000.0, 200.0f64..4_000.0).prop_map(Some)],
    ) {
        // As an image has them.
        let [low, high] = [low, high].map(|end| f64::from(end as f32));
        let law = |velocity: f64| {
            let v = velocity.clamp(low, high);
            coulomb * ((1.0 + stribeck * (-(v / width).abs()).exp()) * (smooth * v).tanh() + offset) + viscous * v
        };
        let largest = coulomb * (3.5) + 8.0 * viscous;
        let wanted = Wanted {
            velocity_count: counts.map(|(velocity, _)| low.abs().max(high) / velocity),
            torque_count: counts.map(|(_, torque)| largest / torque),
            ..wanted(low, high, 1.0e-4 * largest)
        };
        let compiled = compile_integers(&law, &wanted).unwrap();
        let error = compiled.error;
        prop_assert!(compiled.cells.len() <= 128 && error.rms <= error.largest && error.share() < 0.2, "{error:?}");
        let range = [low, high];
        let model = model(&compiled, range);
        let reference = IntegerReference::new(&model, compiled.units).unwrap();
        let [first, last] = reference.range();
        prop_assert_eq!(error.counts as i64, last - first + 1);
        let mut worst = 0.0f64;
        for count in first..=last {
            let told = reference.friction(count as i32) as f64 * f64::from(compiled.units.torque);
            if count != 0 {
                worst = worst.max((told - law(count as f64 * f64::from(compiled.units.velocity))).abs());
            }
        }
        prop_assert!((worst - error.largest).abs() <= 1e-9 * largest, "{worst} told {}", error.largest);
        // Beyond the range the law is held at its end, the drive at the last count within: at most a count of the steepest slope there.
        let beyond = (viscous + 6.0 * coulomb) * f64::from(compiled.units.velocity);
        prop_assert!((observed(&compiled, &law, range) - worst).abs() <= beyond + 1e-9 * largest);
    }
}
