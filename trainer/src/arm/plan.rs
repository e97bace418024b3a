//! The filter for all joints, chosen by what bodies and friction leave of the recorded torques on blocks held out; and what an ampere of
//! each joint is in torque.

use nalgebra::DVector;
use rayon::prelude::*;

use super::base::Base;
use super::chain::Chain;
use super::identify::expected;
use super::motion::{Columns, Motion, Run, TorqueConstant, torque_of};
use super::system::{Expected, JointRows, System};
use crate::error::{Error, Result, codes};
use crate::numerics::jackknife::{ERROR_BLOCKS, even_blocks};
use crate::numerics::regression::least_squares;
use crate::numerics::statistics::NORMAL_95;
use crate::recording::Recording;
use crate::samples::{Preparation, Samples, smooth_friction_columns, top_speed};

/// Samples at which one width is tried.
const TRIED_SAMPLES: f64 = 5_000.0;
/// Blocks, every other of which is held out in turn.
const BLOCKS: usize = 40;
/// Below this share of the top speed a joint is taken to rest.
const REST_SHARE: f64 = 0.01;
/// Turns in which bodies and torque constants are identified, at most, and the change at which they agree.
const TURNS: usize = 100;
const AGREED: f64 = 1e-4;
/// Standard errors from which the torque of an ampere is known.
const CLEAR: f64 = 4.0;

/// How recordings of an arm are prepared, and the torque constant of each joint that reports a current.
pub(super) struct Plan {
    pub(super) preparation: Preparation,
    pub(super) constants: Vec<Option<TorqueConstant>>,
}

impl Plan {
    /// Chooses the filter that leaves least; the logarithms of what is left of the joints add up, so that each counts alike.
    ///
    /// # Errors
    /// `FRK-D016` when no joint moves, `FRK-D014` for the torque constant of a joint that nothing tells.
    pub(super) fn of(chain: &Chain, base: &Base, runs: &[Run], given: &[Option<f64>]) -> Result<Self> {
        let all: Vec<&Recording> = runs.iter().flat_map(|run| &run.joints).collect();
        let candidates = Preparation::of_joints(&all)?;
        let expected = expected(chain, base);
        let tried = candidates.par_iter().map(|preparation| {
            let mut motion = Motion::of(runs, preparation, TRIED_SAMPLES)?;
            let columns = motion.columns(chain, base);
            let mut constants = constants(chain, &expected.values, &motion, &columns, given)?;
            motion.scale(&constants);
            let rows: Vec<Vec<usize>> = motion.joints.iter().map(moving_rows).collect();
            let mut system = system(&motion, &columns, &rows);
            agree(&mut system, &expected, &mut constants)?;
            Ok((cross_fitted(&system, &expected)?, Self { preparation: *preparation, constants }))
        });
        let (mut best, mut failed) = (None, None);
        for trial in tried.collect::<Vec<Result<(f64, Self)>>>() {
            match trial {
                Ok((left, plan)) if best.as_ref().is_none_or(|(least, _)| left < *least) => best = Some((left, plan)),
                Ok(_) => {}
                Err(error) => failed = Some(error),
            }
        }
        let still = || Error::new(&codes::NO_MOTION, "no joint moves, so there is nothing to identify");
        best.map(|(_, plan)| plan).ok_or_else(|| failed.unwrap_or_else(still))
    }
}

/// Rows in which a joint moves.
fn moving_rows(samples: &Samples) -> Vec<usize> {
    let velocity = samples.velocity.as_deref().unwrap_or_default();
    let least = REST_SHARE * top_speed(velocity);
    (0..velocity.len()).filter(|&row| velocity[row].abs() > least).collect()
}

/// The normal equations with friction of a few smooth shapes.
fn system(motion: &Motion, columns: &Columns, rows: &[Vec<usize>]) -> System {
    let of = |joint: usize| {
        let samples = &motion.joints[joint];
        let velocity = samples.velocity.as_deref().unwrap_or_default();
        let velocity: Vec<f64> = rows[joint].iter().map(|row| velocity[*row]).collect();
        JointRows {
            rows: &rows[joint],
            shared: &columns[joint],
            own: if velocity.is_empty() { Vec::new() } else { smooth_friction_columns(&velocity) },
            target: samples.actuator.as_deref().unwrap_or_default(),
            scored: samples.recorded.as_deref().unwrap_or_default(),
        }
    };
    let joints: Vec<JointRows<'_>> = (0..rows.len()).map(of).collect();
    System::new(&joints, &even_blocks(motion.len(), BLOCKS))
}

/// Bodies and friction of the blocks that count, with the weights that what they leave gives the joints.
fn solved(system: &System, expected: &Expected, counts: &dyn Fn(usize) -> bool) -> Result<DVector<f64>> {
    let not_told = || {
        Error::new(&codes::NOT_IDENTIFIABLE, "bodies and friction of the joints cannot be told apart on this motion")
    };
    let first = system.solve(&vec![1.0; system.joints()], expected, counts).ok_or_else(not_told)?;
    let squares = system.left(&first, counts, false);
    let weights: Vec<f64> = squares.into_iter().map(|square| if square > 0.0 { square.recip() } else { 0.0 }).collect();
    system.solve(&weights, expected, counts).ok_or_else(not_told)
}

/// Torque constants that were not given, so that the joints agree on the bodies that they share: bodies and constants are identified in
/// turn. How large all of them are, the masses of the URDF say where no constant is given.
fn agree(system: &mut System, expected: &Expected, constants: &mut [Option<TorqueConstant>]) -> Result<()> {
    let is_open = |constant: &Option<TorqueConstant>| constant.is_some_and(|constant| constant.ci95.is_some());
    let open: Vec<usize> = (0..constants.len()).filter(|joint| is_open(&constants[*joint])).collect();
    for _ in 0..if open.is_empty() { 0 } else { TURNS } {
        let solution = solved(system, expected, &|_| true)?;
        let bodies = &solution.as_slice()[..expected.values.len()];
        let share = |joint: &usize| system.share_of(*joint, bodies).filter(|share| *share > 0.0);
        let mut factors: Vec<f64> = open.iter().map(|joint| share(joint).map_or(1.0, f64::recip)).collect();
        if open.len() == constants.len() {
            let mean = (factors.iter().map(|factor| factor.ln()).sum::<f64>() / factors.len() as f64).exp();
            factors.iter_mut().for_each(|factor| *factor /= mean);
        }
        for (&joint, factor) in open.iter().zip(&factors) {
            system.scale(joint, *factor);
            if let Some(constant) = &mut constants[joint] {
                constant.value *= factor;
                constant.ci95 = constant.ci95.map(|interval| interval.map(|end| end * factor));
            }
        }
        if factors.iter().all(|factor| (factor - 1.0).abs() < AGREED) {
            break;
        }
    }
    Ok(())
}

/// Sum of the logarithms of what is left of the recorded torque of each joint, identified on other blocks than those that count.
fn cross_fitted(system: &System, expected: &Expected) -> Result<f64> {
    let mut left = vec![0.0; system.joints()];
    for held in 0..2 {
        let solution = solved(system, expected, &|block| block % 2 != held)?;
        let scored = system.left(&solution, &|block| block % 2 == held, true);
        left.iter_mut().zip(scored).for_each(|(sum, square)| *sum += square);
    }
    Ok(left.into_iter().filter(|left| *left > 0.0).map(f64::ln).sum())
}

/// Torque constants of the joints that report a current: as given, or else by the bodies of the URDF, friction identified along with them.
fn constants(
    chain: &Chain,
    nominal: &[f64],
    motion: &Motion,
    columns: &Columns,
    given: &[Option<f64>],
) -> Result<Vec<Option<TorqueConstant>>> {
    let of = |joint: usize| {
        let samples = &motion.joints[joint];
        if samples.actuator_unit != "A" {
            return Ok(None);
        }
        if let Some(value) = given[joint] {
            return Ok(Some(TorqueConstant { value, ci95: None }));
        }
        let rows = moving_rows(samples);
        let pick = |column: &[f64]| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
        let velocity = pick(samples.velocity.as_deref().unwrap_or_default());
        let mut of_current = vec![pick(&torque_of(&columns[joint], nominal, |_| true))];
        of_current.extend(smooth_friction_columns(&velocity));
        let current = pick(samples.actuator.as_deref().unwrap_or_default());
        let fit = least_squares(&of_current, &current, &even_blocks(current.len(), ERROR_BLOCKS));
        let (per_torque, error) = (fit.coefficients[0], fit.standard_error(0));
        if per_torque <= CLEAR * error || per_torque <= 0.0 {
            let message = format!(
                "nothing tells the torque of an ampere of {}: the file of the arm has to give `torque_constant_Nm_A` under \
                 [joints.{}.drive], or the robot's description masses that its motion shows",
                chain.joints[joint].name, chain.joints[joint].name
            );
            return Err(Error::new(&codes::MISSING_PARAMETER, message));
        }
        let value = per_torque.recip();
        let half = NORMAL_95 * error * value * value;
        Ok(Some(TorqueConstant { value, ci95: Some([value - half, value + half]) }))
    };
    (0..chain.len()).map(of).collect()
}

/// The filter with which a known arm leaves least of a run, friction of each joint identified along.
///
/// # Errors
/// As [`Plan::of`].
pub(super) fn plan_prediction(
    chain: &Chain,
    base: &Base,
    run: &Run,
    values: &[f64],
    constants: &[Option<TorqueConstant>],
) -> Result<Preparation> {
    let all: Vec<&Recording> = run.joints.iter().collect();
    let runs = std::slice::from_ref(run);
    let candidates = Preparation::of_joints(&all)?;
    let tried = candidates.par_iter().map(|preparation| {
        let mut motion = Motion::of(runs, preparation, TRIED_SAMPLES).ok()?;
        motion.scale(constants);
        let columns = motion.columns(chain, base);
        let left = |joint: usize| {
            let samples = &motion.joints[joint];
            let rows = moving_rows(samples);
            let pick = |column: &[f64]| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
            let body = torque_of(&columns[joint], values, |_| true);
            let recorded = samples.recorded.as_deref().unwrap_or_default();
            let target: Vec<f64> = rows.iter().map(|&row| recorded[row] - body[row]).collect();
            let velocity = pick(samples.velocity.as_deref().unwrap_or_default());
            if velocity.is_empty() {
                return 0.0;
            }
            let fit = least_squares(&smooth_friction_columns(&velocity), &target, &[]);
            if fit.rmse > 0.0 { fit.rmse.ln() } else { 0.0 }
        };
        Some(((0..chain.len()).map(left).sum::<f64>(), *preparation))
    });
    let tried: Vec<(f64, Preparation)> = tried.collect::<Vec<_>>().into_iter().flatten().collect();
    let best = tried.into_iter().min_by(|(a, _), (b, _)| a.total_cmp(b));
    let still = || Error::new(&codes::NO_MOTION, "no joint moves in this recording").in_file(&run.label);
    best.map(|(_, preparation)| preparation).ok_or_else(still)
}
