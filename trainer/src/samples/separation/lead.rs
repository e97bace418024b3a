//! Friction that turns over before the velocity does, as solvers of constraints have it.
//!
//! A constraint opposes the velocity that the joint is about to have, so that its friction has the sign of `v + t_r a`. MuJoCo's
//! `frictionloss` asks for the acceleration `-b v` with `b = 2 / (dmax timeconst)` of `solref` and `solimp` (MuJoCo documentation,
//! "Computation", solver parameters), which is `t_r = 1 / b`, 9.5 ms by default; constraints of velocities at the end of a step have the step.

use crate::numerics::averages::Averages;
use crate::numerics::between_samples::mean_clamped;
use crate::numerics::jackknife::{ERROR_BLOCKS, even_blocks};
use crate::numerics::least_squares::{explained_up_to, orthonormal, project_out};
use crate::numerics::pattern_search::{Movable, climb};
use crate::numerics::regression::least_squares;
use crate::samples::states::States;
use crate::samples::top_speed;

/// Leads that are tried, s: from a short step of a simulation to a soft constraint; each is twice the one before.
pub(crate) const TRIED_S: [f64; 8] = [0.0005, 0.001, 0.002, 0.004, 0.008, 0.016, 0.032, 0.064];

/// Log likelihood (nats) by which a lead has to show, which solvers have and no contact has: odds of 150, very strong evidence by Kass and
/// Raftery (1995).
pub(crate) const SHOWN_NATS: f64 = 5.0;

/// Widths of its turn that are tried, over the top speed. A constraint is as soft as its regularisation, so that it gives its full torque
/// only from `w = (1 - d) C t_r / (d J)` on, with the impedance `d` of `solimp`, the Coulomb torque `C` and the inertia `J`.
const TRIED_WIDTH_SHARES: [f64; 4] = [0.001, 0.004, 0.016, 0.064];

/// Most rows among which lead and width are looked for; what is found is judged on all.
const MOST_ROWS: usize = 4000;

/// How friction turns over before the velocity: by a time, s, and within a velocity.
#[derive(Clone, Copy, Debug)]
struct Lead {
    time_s: f64,
    width: f64,
}

/// What is known at the states: the rows that average over them, and of each its velocity, the range of velocities that it stands for, and
/// the acceleration.
struct Motion {
    averages: Averages,
    states: Vec<[f64; 3]>,
}

impl Motion {
    /// Of some rows of the states, which have these accelerations.
    fn of(states: &States, acceleration: &[f64], rows: &[usize]) -> Self {
        let (averages, kept) = states.averages.select(rows);
        let of_state = |i: usize| [states.velocity[i], states.span[i], acceleration[states.nearest[i]]];
        Self { averages, states: kept.into_iter().map(of_state).collect() }
    }

    /// What a lead adds to friction for each unit of Coulomb torque at the rows.
    fn added(&self, Lead { time_s, width }: Lead) -> Vec<f64> {
        let added = self.states.iter().map(|&[velocity, span, acceleration]| {
            let mean = |middle: f64, width: f64| mean_clamped(middle - 0.5 * span, middle + 0.5 * span, width);
            mean(velocity + time_s * acceleration, width) - mean(velocity, 0.0)
        });
        self.averages.over(&added.collect::<Vec<f64>>())
    }
}

/// What friction that turns over before the velocity, and softly, adds for each unit of Coulomb torque at the rows of the states. `None` where a
/// lead does not show beside `columns` of `target` and friction that is only soft: by more than noise that is coloured within blocks, with friction that opposes
/// the motion, and not up to the longest lead that is tried. `acceleration` is that of the rows.
pub(super) fn added_by_lead(
    columns: &[Vec<f64>],
    target: &[f64],
    (states, acceleration): (&States, &[f64]),
) -> Option<Vec<f64>> {
    let every = target.len().div_ceil(MOST_ROWS).max(1);
    let rows: Vec<usize> = (0..target.len()).step_by(every).collect();
    let few = |column: &[f64]| rows.iter().map(|&row| column[row]).collect::<Vec<f64>>();
    let all = [0..rows.len()];
    let basis = orthonormal(&columns.iter().map(|column| few(column)).collect::<Vec<_>>(), &all);
    let mut left = few(target);
    project_out(&mut left, &basis, &all);
    let motion = Motion::of(states, acceleration, &rows);
    let explained = |lead: Lead| {
        let mut own = motion.added(lead);
        project_out(&mut own, &basis, &all);
        explained_up_to(f64::INFINITY, &own, &left, &all)
    };
    let top = top_speed(&states.velocity);
    let widths = TRIED_WIDTH_SHARES.map(|share| share * top);
    let tried = TRIED_S.into_iter().flat_map(|time_s| widths.map(|width| Lead { time_s, width }));
    let (nearest, _) = tried.filter_map(|lead| Some((lead, explained(lead)?))).max_by(|a, b| a.1.total_cmp(&b.1))?;
    let longest = TRIED_S[TRIED_S.len() - 1].ln();
    let free = [
        Movable { index: 0, step: 0.2, low: TRIED_S[0].ln(), high: longest },
        Movable { index: 1, step: 0.5, low: widths[0].ln(), high: widths[widths.len() - 1].ln() },
    ];
    let of = |at: &[f64]| Lead { time_s: at[0].exp(), width: at[1].exp() };
    let found = climb(&[nearest.time_s.ln(), nearest.width.ln()], &free, |at| explained(of(at)));
    let all_rows: Vec<usize> = (0..target.len()).collect();
    let motion = Motion::of(states, acceleration, &all_rows);
    let lead = of(&found);
    let (softly, added) = (motion.added(Lead { time_s: 0.0, ..lead }), motion.added(lead));
    let before: Vec<f64> = added.iter().zip(&softly).map(|(added, softly)| added - softly).collect();
    let fit = least_squares(&[columns, &[softly, before]].concat(), target, &even_blocks(target.len(), ERROR_BLOCKS));
    let deviations = fit.coefficients.last()? / fit.standard_error(columns.len() + 1);
    (deviations > (2.0 * SHOWN_NATS).sqrt() && found[0] < longest).then_some(added)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::Joint;
    use crate::samples::rigid_body::{Separation, separate_averaged};
    use crate::samples::states::states;
    use crate::samples::{Preparation, Request, prepare};

    /// A body of 0.5 kg m2 with Coulomb torque of 2 N m and viscous friction, for a minute at 250 Hz, whose friction has the sign that the velocity is
    /// about to have after a time (s), within a velocity.
    fn separated(lead_s: f64, width: f64) -> Separation {
        let tones = [(0.8, 2.3), (0.3, 5.1), (0.05, 11.0)];
        let sum = |t: f64, of: fn(f64, f64, f64) -> f64| tones.iter().map(|(a, w)| of(*a, *w, t)).sum::<f64>();
        let mut text = String::from("time_s,position_rad,torque_Nm\n");
        for i in 0..15_000 {
            let t = 0.004 * f64::from(i);
            let velocity = |t: f64| sum(t, |a, w, t| a * w * (w * t).cos());
            let acceleration = |t: f64| sum(t, |a, w, t| -a * w * w * (w * t).sin());
            let torque = |t: f64| {
                let led = velocity(t) + lead_s * acceleration(t);
                2.0 * mean_clamped(led, led, width) + 0.3 * velocity(t) + 0.5 * acceleration(t)
            };
            // A torque is the mean over the sample around its instant.
            let mean = (0..20).map(|k| torque(t + 0.004 * ((f64::from(k) + 0.5) / 20.0 - 0.5))).sum::<f64>() / 20.0;
            let noise = 0.02 * (31.0 * t * t).sin();
            text += &format!("{t},{},{}\n", sum(t, |a, w, t| a * (w * t).sin()), mean + noise);
        }
        let recording = crate::recording::parse("joint.csv", text.as_bytes(), &Joint::default()).unwrap();
        let preparation = Preparation::plan(&[&recording], &Joint::default(), &Request::default()).unwrap();
        let samples = prepare(&recording, &preparation).unwrap();
        let rows: Vec<usize> = (0..samples.len()).collect();
        let states = states(&[recording], &preparation, &samples, &rows).unwrap().unwrap();
        separate_averaged(&samples, &Joint::default(), &states).unwrap()
    }

    #[test]
    fn friction_that_turns_over_before_the_velocity_takes_nothing_of_the_inertia() {
        for (lead_s, width) in [(0.0095, 0.02), (0.004, 1e-6)] {
            let separation = separated(lead_s, width);
            assert!(separation.lead.iter().any(|torque| *torque != 0.0), "{lead_s}");
            assert!((separation.inertia() / 0.5 - 1.0).abs() < 0.003, "{}", separation.inertia());
        }
    }

    #[test]
    fn friction_that_is_only_soft_or_a_jump_has_no_lead() {
        for width in [1e-6, 0.03, 0.1] {
            assert!(separated(0.0, width).lead.iter().all(|torque| *torque == 0.0), "{width}");
        }
    }
}
