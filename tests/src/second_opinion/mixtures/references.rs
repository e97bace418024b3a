//! Recordings beside a simulation of the joint, or a model of another of its recordings, with and without something missing.

use super::PROTOCOLS;
use super::added::{Taken, record};
use crate::second_opinion::closed_loop::Loop;
use crate::second_opinion::motion::Trajectory;
use crate::second_opinion::protocol::{Fine, Protocol};
use crate::second_opinion::random::Random;
use crate::second_opinion::recording::{Compared, Material, Recording};
use crate::second_opinion::{Case, Part};

/// What the simulations lack; they begin with eight that lack nothing.
const MISSING: [Option<&str>; 20] = [
    None,
    None,
    None,
    None,
    None,
    None,
    None,
    None,
    Some("stribeck"),
    Some("load_friction"),
    Some("position_ripple"),
    Some("inertia_error"),
    Some("gravity_error"),
    Some("temperature"),
    Some("viscous_nonlinearity"),
    Some("torque_offset"),
    Some("presliding"),
    Some("contact"),
    Some("direction_asymmetry"),
    Some("transient_event"),
];
/// Which protocols record them, one after the other.
const SIMULATED: [usize; 8] = [0, 1, 3, 4, 7, 5, 6, 2];

/// What the models lack, and which protocol records them.
const MODELLED: [(Option<&str>, usize); 11] = [
    (None, 0),
    (None, 7),
    (None, 3),
    (None, 4),
    (None, 6),
    (Some("stribeck"), 5),
    (Some("position_ripple"), 0),
    (Some("gravity_error"), 4),
    (Some("load_friction"), 2),
    (Some("contact"), 7),
    (Some("temperature"), 4),
];

pub(super) fn cases() -> Vec<Case> {
    let simulated = MISSING.into_iter().enumerate().map(|(index, missing)| {
        let make = move |random: &mut _| beside_a_simulation(index, missing, random);
        Case::new(format!("simulation-{}", index + 1), Part::Simulations, missing.into_iter().collect(), make)
    });
    let modelled = MODELLED.into_iter().enumerate().map(|(index, (missing, protocol))| {
        let make = move |random: &mut _| beside_a_model(&PROTOCOLS[protocol], missing, random);
        Case::new(format!("model-{}", index + 1), Part::Models, missing.into_iter().collect(), make)
    });
    let of_level = |random: &mut _| beside_a_simulation(0, Some("friction_level"), random);
    let level = Case::new("simulation-21".to_owned(), Part::Simulations, vec!["friction_level"], of_level);
    simulated.chain(modelled).chain([level]).collect()
}

/// How far the simulated motion is from the recorded one.
const STRETCH: f64 = 1.005;
/// Noise of a simulation over that of the recording.
const SIMULATION_NOISE: f64 = 0.7;
/// In which ways simulations differ from recordings.
const WAYS: [&str; 6] = [
    "of nearly the same motion",
    "at half the rate",
    "without noise",
    "0.37 s later",
    "30 % shorter",
    "in closed loop",
];

fn beside_a_simulation(index: usize, missing: Option<&str>, random: &mut Random) -> Material {
    let mut protocol = PROTOCOLS[SIMULATED[index % SIMULATED.len()]];
    // Every third joint has a break-away of its own, which the simulation holds.
    if index % 3 == 1 && missing != Some("stribeck") {
        protocol.joint.stribeck = 0.3 * protocol.joint.coulomb;
        protocol.joint.stribeck_speed = 0.06 * protocol.joint.top_speed;
    }
    let fine = protocol.fine(random);
    let effects: Vec<&str> = missing.into_iter().collect();
    let (real, note) = record(&protocol, &fine, &effects, Taken::by(&protocol, fine.step), random);
    let way = index % WAYS.len();
    let simulation = if way == 5 {
        in_closed_loop(&protocol, &fine, random)
    } else {
        let quiet = way == 2;
        let noise = if quiet { 0.0 } else { SIMULATION_NOISE * protocol.noise_percent };
        let taken = Taken {
            step: if way == 1 { 2 * fine.step } else { fine.step },
            share: if way == 4 { 0.7 } else { 1.0 },
            begin_s: if way == 3 { 0.37 } else { 0.0 },
            noise: (noise, 0.0),
            velocity_noise: if quiet { 0.0 } else { 1e-4 },
        };
        let motion = Fine { path: stretched(&fine.path), ..fine.clone() };
        record(&protocol, &motion, &[], taken, random).0
    };
    let own = if protocol.joint.stribeck > 0.0 { ", which has the joint's break-away" } else { "" };
    let note = format!("{note}; simulation {}{own}", WAYS[way]);
    Material { compared: Compared::Simulation(simulation), ..protocol.of(&fine.joint, real, &note) }
}

fn stretched(path: &Trajectory) -> Trajectory {
    let begin = path.position[0];
    let larger = |values: &[f64]| values.iter().map(|value| STRETCH * value).collect();
    Trajectory {
        time: path.time.clone(),
        position: path.position.iter().map(|q| begin + STRETCH * (q - begin)).collect(),
        velocity: larger(&path.velocity),
        acceleration: larger(&path.acceleration),
    }
}

fn in_closed_loop(protocol: &Protocol, fine: &Fine, random: &mut Random) -> Recording {
    let controller =
        Loop { joint: &fine.joint, period_s: fine.period_s, bandwidth_rad_s: 35.0, limit: None, obstacle: None };
    let driven = controller.follow(&fine.path);
    let mut command = fine.samples_of(&driven.command);
    let quieter = Protocol { noise_percent: 0.5 * protocol.noise_percent, correlation: 0.0, ..*protocol };
    quieter.disturb(&mut command, random);
    Protocol::columns(&fine.joint, &driven.path.every(fine.step), command, 1e-5, random)
}

fn beside_a_model(protocol: &Protocol, missing: Option<&str>, random: &mut Random) -> Material {
    let fine = protocol.fine(random);
    let effects: Vec<&str> = missing.into_iter().collect();
    let taken = Taken::by(protocol, fine.step);
    let (real, note) = record(protocol, &fine, &effects, taken, random);
    // The other recording is of the same joint.
    let other = Fine { joint: fine.joint, ..protocol.fine(random) };
    let (clean, _) = record(protocol, &other, &[], taken, random);
    let note = format!("{note}; model of a clean recording");
    Material { compared: Compared::Model(clean), ..protocol.of(&fine.joint, real, &note) }
}
