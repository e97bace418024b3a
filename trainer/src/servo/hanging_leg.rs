//! The case of PACE (Bjelonic et al. 2025): a leg that hangs free, chirps under a PD command of known gains, encoders only.

use std::fmt::Write;

use super::fit_servo;
use super::friction::GearFriction;
use crate::actuator::Partial;
use crate::fit::{Options, Training};
use crate::joint::Joint;
use crate::numerics::random::uniform;
use crate::parameter::Parameter;
use crate::recording::{Recording, parse};
use crate::rollout::{Body, Rig, Series, State, simulate};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

const PERIOD_S: f64 = 0.0025;
const SECONDS: f64 = 20.0;
/// Of the chirp, Hz.
const FREQUENCIES: [f64; 2] = [0.1, 8.0];

/// A joint of the leg.
#[derive(Clone, Copy, Debug)]
struct Leg {
    inertia: f64,
    gravity: f64,
    coulomb: f64,
    viscous: f64,
    offset: f64,
    delay: f64,
    amplitude: f64,
}

/// Hip, thigh and calf.
const LEGS: [Leg; 3] = [
    Leg { inertia: 0.06, gravity: 3.0, coulomb: 0.35, viscous: 0.12, offset: 0.2, delay: 0.01, amplitude: 0.3 },
    Leg { inertia: 0.08, gravity: 4.0, coulomb: 0.3, viscous: 0.15, offset: -0.15, delay: 0.0125, amplitude: 0.4 },
    Leg { inertia: 0.03, gravity: 0.8, coulomb: 0.25, viscous: 0.1, offset: 0.1, delay: 0.0075, amplitude: 0.5 },
];

impl Leg {
    /// The recording of 20 s at 400 Hz with an encoder of 16 bit that noise of half a count blurs.
    fn recorded(&self, random: &mut ChaCha8Rng) -> (Recording, Joint) {
        let known = "[actuator]\nkind = \"pd\"\nkp_Nm_rad = 25\nkd_Nms_rad = 0.6\n";
        let truth = Joint::parse(&format!("{known}delay_s = {}\n", self.delay)).unwrap();
        let joint = Joint::parse(known).unwrap();
        let rows = (SECONDS / PERIOD_S) as usize;
        let table = |position: &mut dyn FnMut(usize) -> f64| {
            let mut text = String::from("time_s,position_rad,reference_position_rad\n");
            for row in 0..rows {
                let time = PERIOD_S * row as f64;
                writeln!(text, "{time},{},{}", position(row), self.command(time)).unwrap();
            }
            text
        };
        let commanded = parse("leg.csv", table(&mut |_| 0.0).as_bytes(), &truth).unwrap();
        let partial = Partial::of(truth.actuator.kind, &truth.actuator.constants);
        let series = Series::of(&commanded, &partial.actuator).unwrap();
        let body = Body { inertia: self.inertia, gravity_sin: self.gravity, gravity_cos: 0.0, offset: self.offset };
        let mut friction = GearFriction {
            coulomb: self.coulomb,
            stribeck: 0.0,
            stribeck_velocity: 0.1,
            viscous: self.viscous,
            load: 0.0,
        };
        let rig = Rig { actuator: partial.actuator, body };
        let states = simulate(&rig, &series, &mut friction, &[(0, State::default())]).unwrap();
        let count = std::f64::consts::TAU / 65_536.0;
        let mut read = |row: usize| (states[row].position / count + uniform(random) - 0.5).round() * count;
        (parse("leg.csv", table(&mut read).as_bytes(), &joint).unwrap(), joint)
    }

    fn command(&self, time: f64) -> f64 {
        let [low, high] = FREQUENCIES;
        let phase = std::f64::consts::TAU * (low * time + 0.5 * (high - low) * time * time / SECONDS);
        self.amplitude * phase.sin()
    }

    /// Constants by the names under which they are told.
    fn constants(&self) -> [(&'static str, f64); 5] {
        [
            ("inertia", self.inertia),
            ("viscous_coefficient", self.viscous),
            ("coulomb_torque", self.coulomb),
            ("torque_offset", self.offset),
            ("delay", self.delay),
        ]
    }
}

fn fitted(leg: &Leg, seed: u64) -> Vec<Parameter> {
    let (recording, joint) = leg.recorded(&mut ChaCha8Rng::seed_from_u64(seed));
    let training = Training { restarts: Some(1), steps: Some(10), ..Training::default() };
    let options = Options { inputs: Some(vec!["velocity".to_owned()]), training, ..Options::default() };
    let found = fit_servo(&[recording], &[], &joint, &options, &|_| {}).unwrap();
    found.outcome.parameters
}

fn named<'a>(parameters: &'a [Parameter], name: &str) -> &'a Parameter {
    parameters.iter().find(|parameter| parameter.name == name).unwrap_or_else(|| panic!("{name}: {parameters:#?}"))
}

#[test]
fn a_hanging_leg_is_known_from_encoders_and_gains() {
    for leg in LEGS {
        let parameters = fitted(&leg, 1);
        for (name, truth) in leg.constants() {
            let found = named(&parameters, name);
            println!("{name} {} of {truth}, 95 % in {:?}", found.value, found.ci95);
            // A command acts from the middle of a step of the simulation on, so that its delay is known to half a step.
            let step = if name == "delay" { 0.5 * PERIOD_S / 3.0 } else { 0.0 };
            assert!((found.value - truth).abs() < 0.03 * truth.abs() + step, "{name} {} for {truth}", found.value);
        }
    }
}

/// Twenty draws of the noise; of a hundred intervals of 95 % at least ninety hold the truth.
#[test]
fn intervals_hold_the_constants_of_the_leg() {
    if std::env::var("FRIKAN_EXHAUSTIVE").is_err() {
        eprintln!("skipped: minutes long; FRIKAN_EXHAUSTIVE=1 asks for it");
        return;
    }
    let mut held = 0;
    for seed in 0..20 {
        let leg = LEGS[seed as usize % LEGS.len()];
        let parameters = fitted(&leg, seed);
        for (name, truth) in leg.constants() {
            let [low, high] = named(&parameters, name).ci95;
            let holds = low <= truth && truth <= high;
            if !holds {
                println!("seed {seed}: {name} {truth} outside [{low}, {high}]");
            }
            held += usize::from(holds);
        }
    }
    println!("{held} of 100");
    assert!(held >= 90, "{held} of 100");
}
