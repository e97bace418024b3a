//! The classical laws fitted as they stand: exact on clean data, honest under noise, told apart.

use frikan_tests::exhaustive;
use frikan_tests::laws::{data, joint, velocity};
use frikan_tests::paper::{JOINTS, SAMPLES, SMOOTHING, with_noise};
use frikan_trainer::kan::Random;
use frikan_trainer::law::{FormFit, KnownForm, fit_form, rank_forms, remainder};

const NAMES: [&str; 4] = ["coulomb_torque", "stribeck_extra_torque", "stribeck_velocity", "viscous_coefficient"];

fn place(fit: &FormFit, name: &str) -> usize {
    fit.law.parameters.iter().position(|p| p.name == name).unwrap()
}

#[test]
fn known_form_is_recovered_to_rounding_from_any_share_of_the_data() {
    let mut worst: f64 = 0.0;
    for (j, k) in JOINTS.into_iter().enumerate() {
        for rows in [100, 300, 800] {
            let fit = fit_form(KnownForm::Stribeck, &joint(k, rows, 0.0, 40 + j as u64), Some(SMOOTHING)).unwrap();
            for (name, truth) in NAMES.into_iter().zip(k) {
                worst = worst.max((fit.law.parameters[place(&fit, name)].value / truth - 1.0).abs());
            }
        }
    }
    println!("largest relative error of a constant: {worst:.1e}");
    assert!(worst < 1e-9);
}

#[test]
fn under_heavy_noise_constants_of_the_known_form_stay_within_two_standard_errors() {
    let seeds = if exhaustive() { 200 } else { 6 };
    for (j, k) in JOINTS.into_iter().enumerate() {
        let mut within = [0; 4];
        for seed in 0..seeds {
            let fit = fit_form(KnownForm::Stribeck, &joint(k, SAMPLES, 0.25, 1000 + seed), Some(SMOOTHING)).unwrap();
            for (i, name) in NAMES.into_iter().enumerate() {
                let at = place(&fit, name);
                let miss = (fit.law.parameters[at].value - k[i]).abs();
                within[i] += u64::from(miss <= 2.0 * fit.uncertainty.standard_errors[at]);
            }
        }
        println!("joint {}: within two standard errors {within:?} of {seeds}", j + 1);
        assert!(within.iter().all(|n| n * 100 >= seeds * if exhaustive() { 93 } else { 60 }));
    }
}

#[test]
fn the_form_that_generated_the_data_ranks_first_among_the_known_ones() {
    let ranked = rank_forms(&joint(JOINTS[2], 600, 0.0, 21)).unwrap();
    assert_eq!(ranked[0].0, KnownForm::Stribeck);
    let mut random = Random::new(5, 0);
    let v: Vec<f64> = (0..800).map(|_| random.uniform(-1.5, 1.5)).collect();
    let clean: Vec<f64> = v.iter().map(|v| 8.0 * (60.0 * v).tanh() + 3.0 * v).collect();
    let ranked = rank_forms(&data(vec![velocity(v)], with_noise(&clean, 0.03, &mut random))).unwrap();
    assert_eq!(ranked[0].0, KnownForm::CoulombViscous);
}

#[test]
fn a_law_is_not_itself_at_the_end_of_its_range_or_with_a_negative_coulomb_torque() {
    let mut random = Random::new(6, 0);
    let v: Vec<f64> = (0..800).map(|_| random.uniform(-1.0, 1.0)).collect();
    let is_stribeck = |coulomb: f64, stribeck_velocity: f64| {
        let torque = |v: &f64| (60.0 * v).tanh() * (coulomb + 3.0 * (-v.abs() / stribeck_velocity).exp()) + v;
        let data = data(vec![velocity(v.clone())], v.iter().map(torque).collect());
        remainder(&KnownForm::Stribeck.structure(), &data, None).unwrap().converged
    };
    assert!(is_stribeck(2.0, 0.1), "a law within its bounds");
    assert!(!is_stribeck(2.0, 4.0), "a decline over four times the largest speed");
    assert!(!is_stribeck(-1.0, 0.9), "a Coulomb torque of -1 N m");
}
