//! Recordings in which nothing is hidden.

use super::{Decoy, Effect, RigidBody, Setup, VelocityColumn};
use crate::second_opinion::joint::ROBOT;
use crate::second_opinion::motion::{MULTISINE, Plan, STROKES};
use crate::second_opinion::{Case, Part};

/// Twenty of them.
#[must_use]
pub fn controls() -> Vec<Case> {
    let case = |(index, setup): (usize, Setup)| {
        let record = move |random: &mut _| setup.record(random);
        Case::new(format!("control-{}", index + 1), Part::Controls, Vec::new(), record)
    };
    setups().into_iter().enumerate().map(case).collect()
}

fn setups() -> Vec<Setup> {
    let at = |index| Setup::nth(index, Effect::Nothing);
    let (clean, absent) = (VelocityColumn::Clean, VelocityColumn::Absent);
    let (file, none) = (RigidBody::JointFile, RigidBody::Absent);
    let slow = Plan::SlowSines { unit: 5e-3 };
    let wide = |setup: Setup| {
        let mut setup = setup;
        setup.joint.sign_width = 0.01 * setup.joint.top_speed;
        setup
    };
    vec![
        at(0),
        at(1),
        at(2),
        at(3),
        at(4),
        at(5),
        Setup { noise: 5e-4, ..at(6).moving(STROKES) },
        Setup { noise: 0.0, velocity: clean, rigid_body: none, ..at(7) },
        Setup {
            noise: 0.0,
            velocity: clean,
            rigid_body: file,
            joint: ROBOT,
            acceleration: true,
            ..at(8).moving(MULTISINE)
        },
        Setup { noise: 5e-4, velocity: clean, ..at(9) },
        Setup { noise: 0.0, velocity: clean, rigid_body: RigidBody::Column, ..at(10).moving(STROKES) },
        Setup { noise: 0.02, decoys: &[Decoy::Temperature, Decoy::OtherJoint], ..at(11).lasting(100.0, 10_000) },
        Setup { noise: 0.01, decoys: &[Decoy::Load], ..at(12).moving(STROKES) },
        Setup { noise: 0.003, ..at(13).moving(Plan::Oscillation) },
        Setup { rigid_body: none, ..at(14).moving(slow) },
        Setup { noise: 0.003, velocity: absent, ..at(15).moving(STROKES) },
        Setup { noise: 0.05, coloured: true, decoys: &[Decoy::Link], ..at(16) },
        Setup { noise: 0.003, velocity: absent, rigid_body: file, ..at(17).moving(MULTISINE) },
        wide(Setup { noise: 5e-4, rigid_body: none, ..at(18).moving(MULTISINE) }),
        Setup {
            noise: 0.02,
            coloured: true,
            decoys: &[Decoy::Temperature],
            ..at(19).moving(STROKES).lasting(100.0, 20_000)
        },
    ]
}
