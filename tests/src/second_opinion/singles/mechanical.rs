//! Six recordings of each effect of position, rigid body and torque chain.

use super::cases::{chirp, multisine, six, strokes};
use super::coupling::Partner;
use super::position::Shape;
use super::{Effect, RigidBody, Setup, VelocityColumn};
use crate::second_opinion::joint::{Joint, LARGE, ROBOT, SERVO};
use crate::second_opinion::motion::{Plan, STROKES};

/// Order of a screw of 20 mm lead, 1/m.
const SCREW: [f64; 2] = [std::f64::consts::TAU / 0.02, 1.0];

pub(super) fn ripple_and_position() -> Vec<Setup> {
    let ripple = |torque, orders, of_friction| Effect::PositionRipple { torque, orders, of_friction };
    let friction = |torque, shape| Effect::PositionFriction { torque, shape };
    let mut setups = six([
        ripple(0.15, &[[24.0, 1.0]], false),
        ripple(0.2, &[[8.0, 1.0], [16.0, 0.5]], false),
        ripple(0.2, &[[30.0, 1.0]], false),
        ripple(0.3, &[SCREW], false),
        ripple(0.1, &[[100.0, 1.0]], false),
        ripple(0.3, &[[6.0, 1.0]], true),
    ]);
    setups[2] = setups[2].lasting(250.0, 7500);
    setups.extend(six([
        friction(0.4, Shape::Bump),
        friction(0.3, Shape::Linear),
        friction(0.4, Shape::Edge),
        friction(0.5, Shape::Two),
        friction(0.3, Shape::Bump),
        friction(0.4, Shape::Linear),
    ]));
    setups
}

pub(super) fn kinematic_error() -> Vec<Setup> {
    let of = |order, amplitude_rad, link_column| Effect::KinematicError { order, amplitude_rad, link_column };
    let clean = VelocityColumn::Clean;
    let rigid_body = RigidBody::JointFile;
    let quick = Plan::BackAndForth { stroke: None, acceleration: Some(20.0), dwells_s: &[0.0, 0.1, 0.3, 0.6, 1.0] };
    let small = Joint { inertia: 8e-4, gravity: 0.05, ..SERVO };
    vec![
        Setup::nth(0, of(30.0, 1e-3, true)),
        Setup { joint: small, rigid_body, ..Setup::nth(1, of(20.0, 2e-3, false)).moving(quick) },
        Setup {
            joint: Joint { inertia: 60.0, ..LARGE },
            rigid_body,
            velocity: clean,
            ..Setup::nth(2, of(40.0, 1e-3, false)).lasting(500.0, 10_000)
        },
        Setup {
            joint: Joint { inertia: 2.0, ..ROBOT },
            rigid_body,
            ..Setup::nth(3, of(50.0, 5e-4, true)).moving(STROKES).lasting(500.0, 12_000)
        },
        Setup::nth(4, of(60.0, 8e-4, false)),
        Setup {
            joint: LARGE,
            rigid_body,
            velocity: clean,
            ..Setup::nth(5, of(24.0, 3e-3, true)).lasting(500.0, 10_000)
        },
    ]
}

pub(super) fn rigid_body() -> Vec<Setup> {
    let gravity = |share, phase_rad| Effect::GravityError { share, phase_rad };
    let inertia = |share| Effect::InertiaError { share };
    let rigid_body = RigidBody::JointFile;
    let light = Joint { gravity: 0.05, ..SERVO };
    let mut setups = vec![
        Setup::nth(0, gravity(0.1, 0.0)).moving(multisine(0.05, 0.6)).lasting(500.0, 15_000),
        Setup { rigid_body, ..Setup::nth(1, gravity(0.2, 0.0)).moving(strokes(4.0)) },
        Setup { rigid_body, ..Setup::nth(2, gravity(-0.1, 0.0)).moving(chirp(0.06, 1.0)).lasting(200.0, 8000) },
        Setup { joint: ROBOT, ..Setup::nth(3, gravity(0.0, 0.15)).moving(strokes(2.4)) },
        Setup { joint: SERVO, ..Setup::nth(4, gravity(0.15, 0.0)) },
        Setup { joint: light, rigid_body, ..Setup::nth(5, gravity(0.1, 0.1)).moving(strokes(5.0)) },
    ];
    let (file, column) = (RigidBody::JointFile, RigidBody::Column);
    let known = [file, file, column, column, file, file];
    let velocities =
        [0, 1, 2, 0, 1, 0].map(|which| [VelocityColumn::Clean, VelocityColumn::Noisy, VelocityColumn::Absent][which]);
    let errors = six([0.3, 0.5, 0.3, 1.0, -0.2, 0.4].map(inertia));
    setups.extend(errors.into_iter().enumerate().map(|(index, setup)| Setup {
        rigid_body: known[index],
        velocity: velocities[index],
        ..setup
    }));
    setups
}

pub(super) fn torque_chain() -> Vec<Setup> {
    let scale = |share| Effect::TorqueScale { share };
    let spring = |torque| Effect::Spring { torque };
    let rigid_body = RigidBody::JointFile;
    let mut setups = vec![
        Setup::nth(0, scale(0.1)).moving(multisine(0.06, 1.0)).lasting(500.0, 15_000),
        Setup { rigid_body, ..Setup::nth(1, scale(0.15)).moving(strokes(4.0)) },
        Setup { rigid_body, velocity: VelocityColumn::Clean, ..Setup::nth(2, scale(-0.1)) },
        Setup { joint: ROBOT, ..Setup::nth(3, scale(0.08)) },
        Setup::nth(4, scale(0.05)),
        Setup { rigid_body: RigidBody::Column, ..Setup::nth(5, scale(0.2)) },
    ];
    setups.extend(six([0.2, 0.1, -0.15, 0.3, 0.1, 0.2].map(|torque| Effect::TorqueOffset { torque })));
    setups.extend([
        Setup::nth(0, spring(0.5)).moving(multisine(0.05, 0.6)).lasting(500.0, 15_000),
        Setup::nth(1, spring(0.3)).moving(strokes(4.0)),
        Setup { rigid_body, ..Setup::nth(2, spring(0.4)).moving(chirp(0.06, 1.0)).lasting(200.0, 8000) },
        Setup::nth(3, spring(0.4)),
        Setup { joint: SERVO, ..Setup::nth(4, spring(0.3)) },
        Setup::nth(5, spring(0.4)).moving(strokes(4.0)),
    ]);
    setups
}

pub(super) fn coupling() -> Vec<Setup> {
    let of = |torque, partner| Effect::Coupling { torque, partner };
    six([
        of(0.3, Partner::Acceleration("joint2_acceleration_rad_s2")),
        of(0.2, Partner::AccelerationOfThree),
        of(0.3, Partner::Arm),
        of(0.3, Partner::Acceleration("ddq2")),
        of(0.15, Partner::Velocity),
        of(0.4, Partner::Position),
    ])
}
