//! What a form of a joint leaves in simulation: every candidate is simulated under a controller as MuJoCo would step it, and compared with
//! the joint as identified. Knows no file and no format.

mod identified;
mod run;
mod scheme;
#[cfg(test)]
mod tests;

pub(super) use self::identified::IdentifiedJoint;
use self::run::Command;
pub(super) use self::run::{Controller, Stepping};
use self::run::{MOTIONS, identified_torques, left_over};
pub(super) use self::scheme::{Bristles, Integrator, SimulatedJoint, Softness};
use super::form::WORTH_IT;
use crate::numerics::statistics::{mean, root_mean_square};
use rayon::prelude::*;

/// By how much a form may be worse than Coulomb and viscous friction in any trial, as a ratio: what is asked of a patched file beside the
/// true attributes.
pub(super) const MOST_WORSE: f64 = 1.05;

/// The motion and the time step of each trial, the step in units of the file's: every motion at that, and the steps that a user may
/// change to next.
const TRIALS: [(usize, f64); 5] = [(0, 1.0), (1, 1.0), (2, 1.0), (0, 0.5), (0, 2.0)];

/// A joint and how it is moved and stepped.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    pub(super) joint: IdentifiedJoint,
    /// Largest velocity of the motions, rad/s (m/s).
    pub(super) top: f64,
    pub(super) controllers: Vec<Controller>,
    pub(super) stepping: Stepping,
    /// Torque of gravity that the actuator has to give, N m: of the sine and the cosine of the position.
    pub(super) gravity: [f64; 2],
}

/// What forms leave under one controller at the step of the file, root mean squares in N m (N); infinite where it diverges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left {
    pub(super) controller: Controller,
    /// Torque of the controller with the joint as identified.
    pub(super) torque: f64,
    /// What Coulomb and viscous friction leave of it.
    pub(super) plain: f64,
    /// What the chosen form leaves of it.
    pub(super) chosen: f64,
}

/// A controller at one time step.
struct Case<'a> {
    command: Command,
    controller: &'a Controller,
    stepping: Stepping,
    wanted: Vec<f64>,
    /// What the best of the plain forms leaves.
    plain: f64,
}

impl Case<'_> {
    /// What a form leaves over what the best of the plain ones does. Where Coulomb and viscous friction diverge, so does everything: the
    /// controller is too stiff for the step.
    fn ratio(&self, left: f64) -> f64 {
        let ratio = left / self.plain;
        if ratio.is_nan() { 1.0 } else { ratio }
    }
}

impl Trial {
    /// The place of the form that leaves the least of those that are in no trial, at half and twice the time step included, worse than
    /// the best of the first `plain` ones, which are Coulomb and viscous friction, and on average worth its parameters; and what it leaves.
    pub(super) fn best(&self, forms: &[SimulatedJoint], plain: usize) -> (usize, Vec<Left>) {
        let cases: Vec<Case> = TRIALS
            .iter()
            .flat_map(|trial| self.controllers.iter().map(|controller| (*trial, controller)))
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|(trial, controller)| self.case(controller, trial, &forms[..plain]))
            .collect();
        let at_file_step = MOTIONS.len() * self.controllers.len();
        // Of what a form leaves, as far as it is in no case too much worse.
        let lefts = |(place, form): (usize, &SimulatedJoint)| -> Vec<f64> {
            let lefts = cases.iter().map(|case| (self.left(form, case), case));
            lefts
                .take_while(|(left, case)| place < plain || case.ratio(*left) <= MOST_WORSE)
                .map(|(left, _)| left)
                .collect()
        };
        let lefts: Vec<Vec<f64>> = forms.par_iter().enumerate().map(lefts).collect();
        let score = |place: &usize| {
            let ratios: Vec<f64> = lefts[*place].iter().zip(&cases).map(|(left, case)| case.ratio(*left)).collect();
            let score = if ratios.len() == cases.len() { mean(&ratios[..at_file_step]) } else { f64::INFINITY };
            if *place < plain || score < WORTH_IT { score } else { f64::INFINITY }
        };
        let place = (0..forms.len()).min_by(|a, b| score(a).total_cmp(&score(b))).unwrap_or(0);
        let left = |(index, controller): (usize, &Controller)| {
            let own = (0..MOTIONS.len()).map(|motion| motion * self.controllers.len() + index);
            let over = |of: &dyn Fn(usize) -> f64| root_mean_square(&own.clone().map(of).collect::<Vec<f64>>());
            Left {
                controller: *controller,
                torque: over(&|case| root_mean_square(&cases[case].wanted)),
                plain: over(&|case| cases[case].plain),
                chosen: over(&|case| lefts[place][case]),
            }
        };
        (place, self.controllers.iter().enumerate().map(left).collect())
    }

    fn case<'a>(&self, controller: &'a Controller, trial: (usize, f64), plain: &[SimulatedJoint]) -> Case<'a> {
        let (motion, share) = trial;
        let command = Command { top: self.top, motion };
        let stepping = Stepping { step: share * self.stepping.step, ..self.stepping };
        let wanted = identified_torques(&self.joint, (command, controller), &self.other(), stepping.step);
        let case = Case { command, controller, stepping, wanted, plain: 0.0 };
        Case { plain: plain.iter().map(|form| self.left(form, &case)).fold(f64::INFINITY, f64::min), ..case }
    }

    fn left(&self, form: &SimulatedJoint, case: &Case) -> f64 {
        let left = left_over(form, (case.command, case.controller), &self.other(), case.stepping, &case.wanted);
        left.unwrap_or(f64::INFINITY)
    }

    fn other(&self) -> impl Fn(f64) -> f64 {
        let [sine, cosine] = self.gravity;
        move |q: f64| -(sine * q.sin() + cosine * q.cos())
    }
}
