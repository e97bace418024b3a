//! Six recordings of each single effect; here those of the velocity law, of other channels and of memory.

use super::load::Load;
use super::mechanical::{coupling, kinematic_error, rigid_body, ripple_and_position, torque_chain};
use super::memory::Presliding;
use super::state::Profile;
use super::{Effect, RigidBody, Setup, VelocityColumn};
use crate::second_opinion::joint::ROBOT;
use crate::second_opinion::motion::{CHIRP, MULTISINE, Plan, STROKES};
use crate::second_opinion::{Case, Part};

/// All of them.
#[must_use]
pub fn cases() -> Vec<Case> {
    let groups = [
        velocity_law(),
        temperature(),
        warm_up(),
        load(),
        memory(),
        ripple_and_position(),
        kinematic_error(),
        rigid_body(),
        torque_chain(),
        coupling(),
    ];
    let mut counts = std::collections::BTreeMap::new();
    let case = |setup: Setup| {
        let name = setup.effect.name().unwrap_or("control");
        let number: &mut usize = counts.entry(name).or_default();
        *number += 1;
        Case::new(format!("{name}-{number}"), Part::Singles, vec![name], move |random| setup.record(random))
    };
    groups.into_iter().flatten().map(case).collect()
}

/// The six ways to record, each with what it hides.
pub(super) fn six(effects: [Effect; 6]) -> Vec<Setup> {
    effects.into_iter().enumerate().map(|(index, effect)| Setup::nth(index, effect)).collect()
}

pub(super) const fn multisine(lowest: f64, highest: f64) -> Plan {
    Plan::Multisine { hz: [lowest, highest] }
}

pub(super) const fn chirp(from: f64, to: f64) -> Plan {
    Plan::Chirp { hz: [from, to] }
}

pub(super) const fn strokes(stroke: f64) -> Plan {
    Plan::BackAndForth { stroke: Some(stroke), acceleration: None, dwells_s: &[0.0, 0.1, 0.3, 0.6, 1.0] }
}

fn velocity_law() -> Vec<Setup> {
    let stribeck = |torque, speed, exponent| Effect::Stribeck { torque, speed, exponent };
    let power = |power, torque| Effect::ViscousNonlinearity { torque, power };
    let asymmetry = |torque, viscous| Effect::DirectionAsymmetry { torque, viscous };
    let mut setups = six([
        stribeck(0.3, 0.06, 2.0),
        stribeck(0.4, 0.08, 1.0),
        stribeck(0.3, 0.1, 2.0),
        stribeck(0.5, 0.1, 2.0),
        stribeck(0.2, 0.05, 2.0),
        stribeck(0.3, 0.12, 1.5),
    ]);
    setups[0].plan = multisine(0.07, 0.8);
    setups[2].plan = chirp(0.1, 1.0);
    setups[5].plan = STROKES;
    setups.extend(six([
        power(2.0, 0.5),
        power(3.0, 0.4),
        power(2.0, 0.3),
        power(2.0, 0.5),
        power(0.6, 1.0),
        power(2.5, 0.4),
    ]));
    setups.extend(six([
        asymmetry(0.15, 0.0),
        asymmetry(0.1, 0.2),
        asymmetry(0.2, 0.1),
        asymmetry(0.2, 0.2),
        asymmetry(0.1, 0.15),
        asymmetry(0.05, 0.1),
    ]));
    setups
}

fn temperature() -> Vec<Setup> {
    let of = |profile, coulomb_per_k, viscous_per_k, step_k| Effect::Temperature {
        profile,
        coulomb_per_k,
        viscous_per_k,
        step_k,
    };
    let slow = multisine(0.08, 1.0);
    let [a, b, c, d, e, f] = [
        of(Profile::WarmRestWarm, -0.01, 0.02, 0.01),
        of(Profile::Sine, -0.01, 0.02, 0.01),
        of(Profile::Fall, -0.008, 0.03, 0.01),
        of(Profile::WarmRestWarm, -0.02, 0.0, 0.01),
        of(Profile::Rise, -0.01, 0.02, 0.1),
        of(Profile::WarmRestWarm, 0.0, 0.04, 0.01),
    ];
    vec![
        Setup::nth(0, a).lasting(100.0, 20_000).moving(slow),
        Setup::nth(1, b).lasting(100.0, 15_000).moving(STROKES),
        Setup::nth(2, c).lasting(100.0, 20_000).moving(STROKES),
        Setup::nth(3, d).lasting(100.0, 10_000).moving(slow),
        Setup::nth(4, e).lasting(100.0, 20_000).moving(STROKES),
        Setup::nth(5, f).lasting(200.0, 20_000).moving(CHIRP),
    ]
}

fn warm_up() -> Vec<Setup> {
    let of = |time_constant_s, coulomb, viscous| Effect::WarmUp { time_constant_s, coulomb, viscous };
    let slow = |spans, depth| Plan::Pausing { hz: [0.08, 1.0], spans, depth };
    let twice: &[(f64, f64)] = &[(0.3, 0.55), (0.75, 0.9)];
    let at = |way, effect, plan| Setup::nth(way, effect).lasting(100.0, 20_000).moving(plan);
    vec![
        at(0, of(30.0, -0.3, -0.4), slow(twice, 0.8)),
        at(1, of(25.0, -0.3, -0.4), slow(&[(0.4, 0.7)], 0.95)),
        at(2, of(40.0, -0.4, -0.3), slow(&[(0.25, 0.6)], 0.8)),
        at(3, of(20.0, -0.3, 0.0), slow(twice, 0.8)),
        at(4, of(60.0, -0.3, -0.4), STROKES),
        at(5, of(60.0, -0.3, -0.4), Plan::Pausing { hz: [0.05, 0.5], spans: twice, depth: 0.8 }).lasting(50.0, 20_000),
    ]
}

fn load() -> Vec<Setup> {
    let share = |load, share| Effect::LoadFriction { load, share };
    let two = |load, driving, driven| Effect::DriveBackdrive { load, driving, driven };
    let recorded = |effects: [Effect; 6]| {
        let mut setups = six(effects);
        setups[0] = setups[0].lasting(500.0, 15_000).moving(multisine(0.06, 1.0));
        setups[2].plan = chirp(0.1, 1.0);
        setups[3].joint = ROBOT;
        setups[5].plan = strokes(3.0);
        let known = [RigidBody::JointFile, RigidBody::Removed, RigidBody::Column];
        for (index, setup) in setups.iter_mut().enumerate() {
            setup.rigid_body = [known[0], known[1], known[2], known[2], known[1], known[0]][index];
        }
        setups
    };
    let mut setups = recorded([
        share(Load::RigidBody, 0.1),
        share(Load::Brake, 0.15),
        share(Load::Swinging, 0.12),
        share(Load::Brake, 0.1),
        share(Load::Swinging, 0.1),
        share(Load::RigidBody, 0.2),
    ]);
    setups.extend(recorded([
        two(Load::RigidBody, 0.05, 0.2),
        two(Load::Brake, 0.1, 0.3),
        two(Load::Swinging, 0.05, 0.2),
        two(Load::Brake, 0.05, 0.2),
        two(Load::Swinging, 0.2, 0.05),
        two(Load::RigidBody, 0.05, 0.2),
    ]));
    let drifts = [
        (0.2, 100.0, 12_000),
        (0.15, 250.0, 15_000),
        (0.1, 100.0, 6000),
        (0.3, 200.0, 12_000),
        (-0.1, 500.0, 20_000),
        (0.1, 200.0, 20_000),
    ];
    setups.extend(drifts.into_iter().enumerate().map(|(way, (torque, rate_hz, samples))| {
        Setup::nth(way, Effect::SlowDrift { torque }).lasting(rate_hz, samples)
    }));
    setups
}

fn memory() -> Vec<Setup> {
    let presliding = |kind, distance| Effect::Presliding { kind, distance };
    let lag = |time_constant_s, pure_delay| Effect::FrictionalLag { time_constant_s, pure_delay };
    let dwell = |torque, distance| Effect::DwellBreakaway { torque, distance };
    let (dahl, four) = (Presliding::Dahl, Presliding::FourElements);
    let without_rest = Plan::BackAndForth { stroke: None, acceleration: None, dwells_s: &[0.0] };
    let resting = Plan::BackAndForth { stroke: None, acceleration: None, dwells_s: &[0.1, 0.3, 0.6, 1.0, 2.0] };
    let slow = |unit| Plan::SlowSines { unit };
    let mut setups = vec![
        Setup { rigid_body: RigidBody::Absent, ..Setup::nth(0, presliding(dahl, 2e-3)).moving(slow(2e-3)) },
        Setup::nth(1, presliding(four, 5e-3)).moving(slow(5e-3)).lasting(500.0, 15_000),
        Setup {
            velocity: VelocityColumn::Clean,
            rigid_body: RigidBody::JointFile,
            ..Setup::nth(2, presliding(dahl, 1e-2)).moving(multisine(0.05, 0.6)).lasting(250.0, 10_000)
        },
        Setup::nth(3, presliding(dahl, 1e-2)).moving(without_rest).lasting(1000.0, 20_000),
        Setup::nth(4, presliding(four, 5e-3)).moving(multisine(0.05, 0.6)),
        Setup::nth(5, presliding(dahl, 1e-2)).moving(slow(1e-2)).lasting(200.0, 8000),
    ];
    setups.extend([
        Setup::nth(0, lag(0.04, false)).moving(Plan::Oscillation),
        Setup { noise: 0.003, ..Setup::nth(1, lag(0.06, false)).moving(Plan::Oscillation) },
        Setup::nth(2, lag(0.05, false)).moving(MULTISINE).lasting(200.0, 6000),
        Setup { noise: 0.02, ..Setup::nth(3, lag(0.03, true)).moving(Plan::Oscillation) },
        Setup::nth(4, lag(0.03, false)).moving(chirp(0.1, 3.0)),
        Setup::nth(5, lag(0.05, false)).moving(Plan::Oscillation).lasting(250.0, 7500),
    ]);
    let rests = [
        (dwell(0.5, 0.02), 1000.0, 20_000),
        (dwell(0.4, 0.1), 250.0, 15_000),
        (dwell(0.5, 0.03), 200.0, 8000),
        (dwell(0.5, 0.05), 500.0, 15_000),
        (dwell(0.3, 0.02), 1000.0, 20_000),
        (dwell(0.5, 0.1), 250.0, 10_000),
    ];
    setups.extend(rests.into_iter().enumerate().map(|(way, (effect, rate_hz, samples))| {
        let velocity = match way {
            4 => VelocityColumn::Noisy,
            5 => VelocityColumn::Absent,
            _ => VelocityColumn::Clean,
        };
        Setup { velocity, ..Setup::nth(way, effect).moving(resting).lasting(rate_hz, samples) }
    }));
    setups
}
