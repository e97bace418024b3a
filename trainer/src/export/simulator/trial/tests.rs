//! The steps of a joint, beside those of MuJoCo itself.

use super::scheme::{Bristles, Drive, Integrator, Motion, SimulatedJoint, Softness};

/// What `tests/simulators/joint_steps.py` prints.
const OF_MUJOCO: &str = include_str!("mujoco_steps.txt");

fn joint(form: &str) -> SimulatedJoint {
    let bristles = |stiffness, damping, coulomb, at_rest| {
        Some(Bristles { stiffness, damping, coulomb, at_rest, stribeck_velocity: 0.1 })
    };
    let plain = SimulatedJoint {
        inertia: 0.5,
        friction_loss: 2.0,
        softness: Softness::default(),
        damping: [1.2, 0.0, 0.0],
        bristles: None,
    };
    match form {
        "attributes" => plain,
        "polynomial" => SimulatedJoint { friction_loss: 0.0, damping: [1.2, 0.1, -0.01], ..plain },
        "softness" => {
            SimulatedJoint { softness: Softness { reference: [0.005, 1.0], impedance: [0.98, 0.99] }, ..plain }
        }
        "bristles" => SimulatedJoint { friction_loss: 0.0, bristles: bristles(2e4, 100.0, 2.0, 3.0), ..plain },
        "peak" => SimulatedJoint { bristles: bristles(5e3, 0.0, 0.0, 1.0), ..plain },
        other => panic!("{other}"),
    }
}

fn integrator(name: &str) -> Integrator {
    match name {
        "Euler" => Integrator::Euler,
        "implicit" | "implicitfast" => Integrator::Implicit,
        "RK4" => Integrator::RungeKutta,
        "discrete" => Integrator::Discrete,
        other => panic!("{other}"),
    }
}

#[test]
fn a_joint_steps_as_in_mujoco() {
    for line in OF_MUJOCO.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let [kind, form, drive] = [words[0], words[1], words[2]];
        if words[4] == "diverges" {
            continue;
        }
        let numbers: Vec<f64> = words[3..].iter().map(|word| word.parse().unwrap()).collect();
        let [step, q, v, z] = numbers[..] else { panic!("{line}") };
        let (joint, mut motion) = (joint(form), Motion::default());
        for index in 0..400 {
            let wave = (20.0 * f64::from(index) * step).sin();
            let drive = match drive {
                "motor" => Drive::Held(6.0 * wave),
                _ => Drive::Actuator { kp: 200.0, kv: 15.0, reference: 0.1 * wave },
            };
            joint.step(&mut motion, drive, &|_| 0.0, integrator(kind), step);
        }
        let near = |own: f64, of_mujoco: f64| (own - of_mujoco).abs() < 1e-7 * of_mujoco.abs().max(1e-4);
        assert!(near(motion.q, q) && near(motion.v, v) && near(motion.z, z), "{line}: {motion:?}");
    }
}
