//! Does discovery find the law that generated the data? A few draws by default, all of them with `FRIKAN_EXHAUSTIVE=1`.

use std::time::Instant;

use frikan_tests::exhaustive;
use frikan_tests::laws::reference::{self, identifiable};
use frikan_tests::laws::simple::{Truth, too_rich};
use frikan_tests::laws::{channel, data, joint, other, velocity};
use frikan_tests::paper::{JOINTS, SAMPLES, SMOOTHING, with_noise};
use frikan_trainer::kan::Random;
use frikan_trainer::law::{ChannelRole, Nuisance, SearchOptions, discover};

#[test]
fn clean_reference_law_is_found_exactly_for_every_joint() {
    for (j, k) in JOINTS.into_iter().enumerate() {
        let start = Instant::now();
        let found = discover(&joint(k, SAMPLES, 0.0, 7), &SearchOptions::default()).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        println!("joint {}: {} structures, {seconds:.2} s", j + 1, found.explored.len());
        assert_eq!(found.law.structure, reference::whole(), "joint {}: {:?}", j + 1, found.front);
        assert!(found.law.expression.node_count() <= 20);
        let truths = identifiable(k).into_iter().chain([("viscous_coefficient", k[3])]);
        for (name, truth) in truths {
            let got = found.law.parameters.iter().find(|p| p.name == name).unwrap().value;
            assert!((got / truth - 1.0).abs() < 1e-3, "{name} {got} {truth}");
        }
        assert!(seconds < 10.0);
    }
}

#[test]
fn under_the_noise_of_the_paper_the_identifiable_law_is_found_with_honest_intervals() {
    let draws = if exhaustive() { 20 } else { 2 };
    let (mut inside, mut intervals) = ([0; 4], 0);
    for j in 0..JOINTS.len() {
        let tally = reference::tally(j, (0..draws).map(|seed| 1000 * (j as u64 + 1) + seed));
        println!("joint {}: {} of {} right; else {:?}", j + 1, tally.right, tally.draws, tally.wrong);
        assert!(tally.right * 10 >= tally.draws * 8 || (!exhaustive() && tally.right > 0));
        inside.iter_mut().zip(tally.inside).for_each(|(sum, n)| *sum += n);
        intervals += tally.right;
    }
    println!("inside their 95 % intervals: {inside:?} of {intervals} each");
    let rate = inside.iter().sum::<usize>() as f64 / (4 * intervals) as f64;
    assert!(rate >= 0.90 && (rate <= 0.97 || !exhaustive()), "{rate}");
}

#[test]
fn other_laws_are_found_clean_and_under_noise() {
    let draws = if exhaustive() { 10 } else { 1 };
    // Noise as a share of the range; 5 % in the paper's own reading is a standard deviation of 2.5 %. Twice that is run as well.
    for (share, needed) in [(0.0, 9), (0.025, 7), (0.05, 5)] {
        let mut right = 0;
        for seed in 300..300 + draws {
            for case in other::cases(seed) {
                let name = case.name;
                match case.mistaken(share, seed) {
                    None => right += 1,
                    Some(wrong) => println!("  {share} {seed} {name}: {wrong:?}"),
                }
            }
        }
        println!("noise {share}: {right} of {} right", 10 * draws);
        assert!(right >= needed * draws as usize, "noise {share}: {right} of {}", 10 * draws);
    }
}

#[test]
fn no_false_richness() {
    let sets = if exhaustive() { 50 } else { 4 };
    for truth in [Truth::Noise, Truth::CoulombViscous] {
        let rich: Vec<_> = (5000..5000 + sets).filter_map(|seed| too_rich(truth, seed)).collect();
        println!("{truth:?}: {} of {sets} too rich: {rich:?}", rich.len());
        assert!(rich.len() * 20 <= sets as usize);
    }
}

/// A rigid body that is fitted along takes nothing from the law, and its coefficients come with honest intervals.
#[test]
fn inertia_gravity_and_offset_are_found_beside_the_law() {
    let n = 1500;
    let time = |i: usize| i as f64 * 0.02;
    let motion = |t: f64| (0.9 * t).sin() + 0.5 * (2.3 * t + 1.0).sin() + 0.2 * (5.1 * t).sin();
    let slope = |f: &dyn Fn(f64) -> f64, t: f64| (f(t + 1e-5) - f(t - 1e-5)) / 2e-5;
    let rate = |t: f64| slope(&motion, t);
    let over_time = |f: &dyn Fn(f64) -> f64| -> Vec<f64> { (0..n).map(|i| f(time(i))).collect() };
    let (q, v, a) = (over_time(&motion), over_time(&rate), over_time(&|t| slope(&rate, t)));
    let friction = |v: f64| (6.0 + 3.0 * (-(v / 0.3).abs()).exp()) * (40.0 * v).tanh() + 2.0 * v;
    let body = |i: usize| 1.5 * a[i] + 12.0 * q[i].sin() - 4.0 * q[i].cos() + 0.8;
    let clean: Vec<f64> = (0..n).map(|i| friction(v[i]) + body(i)).collect();
    let column = |name: &str, unit: &str, values: Vec<f64>| Nuisance { name: name.into(), unit: unit.into(), values };
    let mut samples = data(vec![velocity(v.clone())], with_noise(&clean, 0.005, &mut Random::new(77, 0)));
    samples.nuisance = vec![
        column("inertia", "kg m²", a.clone()),
        column("gravity_sine", "N m", q.iter().map(|q| q.sin()).collect()),
        column("gravity_cosine", "N m", q.iter().map(|q| q.cos()).collect()),
        column("offset", "N m", vec![1.0; n]),
    ];
    let found = discover(&samples, &SearchOptions::default()).unwrap();
    assert_eq!(found.law.structure, reference::whole());
    for (coefficient, truth) in found.nuisance.iter().zip([1.5, 12.0, -4.0, 0.8]) {
        let half = 0.5 * (coefficient.ci95[1] - coefficient.ci95[0]);
        assert!((coefficient.value - truth).abs() < 1.6 * half, "{coefficient:?} {truth}");
        assert!(half < 0.1);
    }
}

#[test]
fn a_constant_channel_is_no_input() {
    let k = JOINTS[3];
    let mut samples = joint(k, 600, 0.0, 3);
    samples.channels.push(channel("temperature", "°C", ChannelRole::Temperature, vec![SMOOTHING; 600]));
    let found = discover(&samples, &SearchOptions::default()).unwrap();
    assert_eq!(found.law.structure, reference::whole());
}
