use super::*;

fn moving(seconds: f64, rate: f64, phase: f64) -> Signals {
    let period = 1.0 / rate;
    let time: Vec<f64> = (0..(seconds * rate) as usize).map(|i| i as f64 * period).collect();
    let swing = |t: f64| [(1.0, 0.8), (0.6, 2.1), (0.3, 5.3)].map(|(a, w): (f64, f64)| (a, w, w * t + phase));
    let sum = |f: fn((f64, f64, f64)) -> f64| -> Vec<f64> {
        time.iter().map(|t| swing(*t).into_iter().map(f).sum()).collect()
    };
    let position = sum(|(a, _, x)| a * x.sin());
    let velocity = sum(|(a, w, x)| a * w * x.cos());
    let acceleration = sum(|(a, w, x)| -a * w * w * x.sin());
    let torque = (0..time.len())
        .map(|i| {
            0.4 * acceleration[i] + 3.0 * position[i].sin() + 2.0 * (velocity[i] / 0.002).tanh() + 0.5 * velocity[i]
        })
        .collect();
    Signals::without_gap(period, time, position, torque)
}

#[test]
fn a_law_learned_elsewhere_holds_at_other_states() {
    // Shorter, shifted in time and sampled differently.
    let real = moving(31.0, 500.0, 0.0);
    let law = learn(&moving(20.0, 400.0, 1.3), &real, &|_| Vec::new()).unwrap();
    let reference = law.at(&real.states());
    let error: f64 =
        reference.torque.iter().zip(&real.torque).skip(500).take(14000).map(|(a, b)| (a - b).powi(2)).sum();
    assert!((error / 14000.0).sqrt() < 0.15, "{}", (error / 14000.0).sqrt());
    let [inertia, _, sine, _, _] = law.rigid_body();
    assert!((inertia - 0.4).abs() < 0.02 && (sine - 3.0).abs() < 0.1, "{inertia} {sine}");
}

#[test]
fn rest_teaches_nothing() {
    let mut still = moving(5.0, 400.0, 0.0);
    still.position.fill(0.3);
    assert!(learn(&still, &moving(5.0, 400.0, 0.0), &|_| Vec::new()).is_err());
}
