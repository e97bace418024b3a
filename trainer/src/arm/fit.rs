//! The whole way of an arm: filter, bodies and friction of all joints, then a law and an image for each joint by the way of a single one, with
//! the torque of the bodies beside its own.

use super::base::Base;
use super::chain::Chain;
use super::identify::{Estimate, Identified, LoadFriction, Moving, identify, less, transmitted};
use super::motion::{Motion, Run, TorqueConstant, torque_of};
use super::plan::{Plan, plan_prediction};
use crate::error::{Error, Result, codes};
use crate::fit::outcome::Outcome as JointLaw;
use crate::fit::{Options, Progress, Stage, fit as fit_joint};
use crate::joint::Joint;
use crate::recording::{Quantity, Recording};
use crate::samples::states::{States, states};
use crate::samples::{BendingLaw, Preparation, Samples, told_of_clock};

/// Most samples of all runs together: constants of bodies and friction are known no better for more, and memory grows with them.
const MOST_SAMPLES: f64 = 20_000.0;

/// An arm with its recordings.
#[derive(Clone, Debug)]
pub struct Arm {
    /// Its moving joints.
    pub chain: Chain,
    /// What else is known of each, in the order of the chain.
    pub joints: Vec<Joint>,
    /// Recordings to learn from.
    pub runs: Vec<Run>,
    /// Recordings that are only scored.
    pub tests: Vec<Run>,
}

/// What was found of an arm.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Joint by joint, in the order of the chain.
    pub joints: Vec<JointOutcome>,
    /// Base inertial parameters.
    pub parameters: Vec<BaseEstimate>,
    /// The filter, in one sentence.
    pub filter: String,
}

/// What was found of one joint.
#[derive(Clone, Debug)]
pub struct JointOutcome {
    /// Its name.
    pub name: String,
    /// Friction per transmitted load; `None` where it does not show.
    pub load_friction: Option<LoadFriction>,
    /// What an ampere is in torque, where the joint reports a current.
    pub torque_constant: Option<TorqueConstant>,
    /// Law, image and scores; `None` of a joint that hardly moves, with the reason.
    pub law: std::result::Result<Box<JointLaw>, Error>,
    /// Its recordings with the torque of the bodies, the load that its gear transmits, and its own: those learnt from, then those of the tests.
    pub recordings: Vec<Recording>,
}

/// A base parameter as it was found.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseEstimate {
    /// Which, as text over numbers of links and rotors.
    pub expression: String,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub estimate: Estimate,
}

/// What is being done, and to which joint.
pub type ArmProgress<'a> = &'a (dyn Fn(Option<&str>, &Progress) + Sync);

/// Fits an arm.
///
/// # Errors
/// `FRK-D...` when recordings cannot be used, `FRK-N001` when nothing can be told apart. A joint whose own law cannot be fitted is told in
/// its outcome.
pub fn fit(arm: &Arm, options: &Options, progress: ArmProgress<'_>) -> Result<Outcome> {
    let tell = |stage| progress(None, &Progress { stage, steps: 0, rmse: None });
    tell(Stage::Separating);
    require_torques(arm)?;
    let (chain, base) = (&arm.chain, Base::of(&arm.chain));
    let given: Vec<Option<f64>> = arm.joints.iter().map(|joint| joint.drive.joint_torque_per_ampere()).collect();
    let Plan { preparation, constants } = Plan::of(chain, &base, &arm.runs, &given)?;
    let mut motion = Motion::of(&arm.runs, &preparation, MOST_SAMPLES)?;
    motion.scale(&constants);
    let columns = motion.columns(chain, &base);
    let moving = moving(arm, &motion)?;
    let found = identify(chain, &base, &motion, &columns, &moving)?;
    drop(columns);

    let with_bodies = |run: &Run| with_bodies(arm, &base, run, &found, &constants);
    let runs = arm.runs.iter().map(with_bodies).collect::<Result<Vec<_>>>()?;
    let tests = arm.tests.iter().map(with_bodies).collect::<Result<Vec<_>>>()?;
    let joint = |index: usize| {
        let name = &chain.joints[index].name;
        let of = |runs: &[Vec<Recording>]| runs.iter().map(|run| run[index].clone()).collect::<Vec<_>>();
        let (own, own_tests) = (of(&runs), of(&tests));
        let mut joint = arm.joints[index].clone();
        joint.name.get_or_insert_with(|| name.clone());
        joint.rigid_body.recorded_is_exact = true;
        joint.drive.torque_constant_nm_a = None;
        let inputs = std::iter::once("velocity").chain(found.load[index].map(|_| "load_torque"));
        let options = Options { inputs: Some(inputs.map(str::to_owned).collect()), ..options.clone() };
        let law = fit_joint(&own, &own_tests, &joint, &options, &|stage| progress(Some(name), stage)).map(Box::new);
        JointOutcome {
            name: name.clone(),
            load_friction: found.load[index],
            torque_constant: constants[index],
            law,
            recordings: [own, own_tests].concat(),
        }
    };
    let parameters = base.parameters.iter().zip(found.parameters);
    Ok(Outcome {
        joints: (0..chain.len()).map(joint).collect(),
        parameters: parameters
            .map(|(parameter, estimate)| BaseEstimate {
                expression: parameter.expression(chain),
                unit: parameter.unit(chain),
                estimate,
            })
            .collect(),
        filter: preparation.to_string() + told_of_clock(arm.runs.iter().flat_map(|run| &run.joints)),
    })
}

fn require_torques(arm: &Arm) -> Result<()> {
    let all = arm.runs.iter().chain(&arm.tests).flat_map(|run| run.joints.iter().zip(&arm.chain.joints));
    for (recording, joint) in all {
        let purpose = format!("joint {} of the arm", joint.name);
        recording.require(&[Quantity::Torque, Quantity::Force, Quantity::Current], &purpose)?;
        recording.require(&[Quantity::Position], &purpose)?;
        recording.require(&[Quantity::Time], &purpose)?;
    }
    Ok(())
}

/// Where each joint moves, with the noise of its motion.
fn moving(arm: &Arm, motion: &Motion) -> Result<Vec<Moving>> {
    let preparation = &motion.preparation;
    let of = |(joint, samples): (usize, &Samples)| {
        let recordings: Vec<Recording> = arm.runs.iter().map(|run| run.joints[joint].clone()).collect();
        let mut noise = [0.0_f64; 2];
        let mut is_seen = false;
        for recording in &recordings {
            is_seen |= Preparation::of_joints(&[recording]).is_ok_and(|found| !found.is_empty());
            let own = preparation.with_noise_of(recording)?;
            noise = [noise[0].max(own.velocity_noise()), noise[1].max(own.acceleration_noise)];
        }
        let rows: Vec<usize> = if is_seen { (0..samples.len()).collect() } else { Vec::new() };
        let states = states(&recordings, preparation, samples, &rows)?.unwrap_or_default();
        // A joint that hardly changes its velocity shows no friction of its own.
        let shows = BendingLaw::over(&states.velocity).is_ok();
        Ok(Moving { states: if shows { states } else { States::default() }, noise })
    };
    motion.joints.iter().enumerate().map(of).collect()
}

/// The recordings of each joint with the torque of the bodies and the load that its gear transmits, in the unit of its actuator.
fn with_bodies(
    arm: &Arm,
    base: &Base,
    run: &Run,
    found: &Identified,
    constants: &[Option<TorqueConstant>],
) -> Result<Vec<Recording>> {
    let values = &found.values();
    let preparation = plan_prediction(&arm.chain, base, run, values, constants)?;
    let motion = Motion::every_row(run, &preparation)?;
    let columns = motion.columns(&arm.chain, base);
    let of = |(joint, recording): (usize, &Recording)| {
        let per_ampere = constants[joint].map(|constant| constant.value);
        let actuator = recording.actuator().map(|channel| channel.values.clone()).unwrap_or_default();
        let scaled = |values: Vec<f64>, by: f64| values.into_iter().map(|value| value * by).collect::<Vec<f64>>();
        let torque = scaled(actuator, per_ampere.unwrap_or(1.0));
        let body = torque_of(&columns[joint], values, |_| true);
        let acceleration = motion.joints[joint].acceleration.as_deref().unwrap_or_default();
        let load = less(transmitted(base, &columns[joint], values, joint), found.before_gear[joint], acceleration);
        let load = scaled(load, per_ampere.map_or(1.0, f64::recip));
        let others = vec![("rigid_body_torque".to_owned(), body), ("load_torque".to_owned(), load)];
        let with_torque = recording.clone().with_torque(torque, others);
        match per_ampere {
            Some(constant) => with_torque.with_torque_as_current(constant.recip()),
            None => with_torque,
        }
    };
    if columns.iter().any(|of_joint| of_joint.iter().all(Option::is_none)) {
        return Err(Error::new(&codes::NOT_IDENTIFIABLE, "a joint of this arm moves nothing"));
    }
    Ok(run.joints.iter().enumerate().map(of).collect())
}
