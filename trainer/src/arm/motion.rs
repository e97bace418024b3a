//! Recordings of all joints on one clock, filtered alike, and what the bodies of the chain make of their motion.

use super::base::Base;
use super::chain::Chain;
use super::dynamics::{NUMBERS, State, regressor};
use crate::error::{Error, Result, codes};
use crate::recording::{MINIMUM_ROWS, Omission, Quantity, Recording};
use crate::samples::{Preparation, Samples, prepare, prepare_every_row};

/// One recording of the arm, joint by joint in the order of the chain, all on the same rows.
#[derive(Clone, Debug)]
pub struct Run {
    /// Name of the file.
    pub label: String,
    /// What each joint did.
    pub joints: Vec<Recording>,
}

/// Samples of every joint at the same instants, in the order of the chain.
#[derive(Clone, Debug)]
pub struct Motion {
    /// One set a joint, all of one length.
    pub joints: Vec<Samples>,
    /// How they were prepared.
    pub preparation: Preparation,
}

/// Torque of a joint per ampere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueConstant {
    /// N m/A, at the joint.
    pub value: f64,
    /// 95 % interval; `None` where it was given.
    pub ci95: Option<[f64; 2]>,
}

/// Torque of each joint per unit of each base parameter, one value a sample; `None` where the joint does not carry what it belongs to.
pub type Columns = Vec<Vec<Option<Vec<f64>>>>;

impl Motion {
    /// Filtered samples of all runs, thinned to no more than `most` of all together.
    ///
    /// # Errors
    /// As [`prepare`] and [`Samples::join`]; `FRK-D018` when the joints of a run are not on one clock.
    pub fn of(runs: &[Run], preparation: &Preparation, most: f64) -> Result<Self> {
        let seconds: f64 = runs.iter().filter_map(|run| run.seconds()).sum();
        let most = most / seconds.max(f64::MIN_POSITIVE);
        let rate_hz = Some(preparation.rate_hz.map_or(most, |rate| rate.min(most)));
        let thinned = Preparation { rate_hz, ..*preparation };
        let joints = runs.first().map_or(0, |run| run.joints.len());
        let of = |joint: usize| {
            let parts = runs.iter().map(|run| prepare(&run.joints[joint], &thinned)).collect::<Result<Vec<_>>>()?;
            Samples::join(parts)
        };
        Self { joints: (0..joints).map(of).collect::<Result<_>>()?, preparation: thinned }.checked()
    }

    /// One sample for every row of a run.
    ///
    /// # Errors
    /// As [`prepare_every_row`].
    pub fn every_row(run: &Run, preparation: &Preparation) -> Result<Self> {
        let joints = run.joints.iter().map(|recording| prepare_every_row(recording, preparation));
        Self { joints: joints.collect::<Result<_>>()?, preparation: *preparation }.checked()
    }

    fn checked(self) -> Result<Self> {
        let rows = self.len();
        for samples in &self.joints {
            samples.require_velocity()?;
            if samples.len() != rows || samples.position.is_none() || samples.acceleration.is_none() {
                let message = "all joints need a position at the same instants";
                return Err(Error::new(&codes::RECORDINGS_DISAGREE, message));
            }
        }
        Ok(self)
    }

    /// Takes the currents of joints with a torque constant for the torques that they stand for.
    pub(super) fn scale(&mut self, constants: &[Option<TorqueConstant>]) {
        for (samples, constant) in self.joints.iter_mut().zip(constants) {
            let Some(constant) = constant else { continue };
            for column in [&mut samples.actuator, &mut samples.recorded].into_iter().flatten() {
                column.iter_mut().for_each(|value| *value *= constant.value);
            }
        }
    }

    /// Number of instants.
    #[must_use]
    pub fn len(&self) -> usize {
        self.joints.first().map_or(0, Samples::len)
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Calls `with` for every instant with the torques of all joints per unit of each number of the chain, as [`regressor`] writes them.
    /// `moved` is added to velocity and acceleration.
    fn for_each(&self, chain: &Chain, moved: impl Fn(usize, usize) -> [f64; 2], mut with: impl FnMut(usize, &[f64])) {
        let joints = chain.len();
        let column = |of: fn(&Samples) -> Option<&Vec<f64>>| -> Vec<&[f64]> {
            self.joints.iter().map(|samples| of(samples).map_or(&[][..], Vec::as_slice)).collect()
        };
        let motion =
            [column(|s| s.position.as_ref()), column(|s| s.velocity.as_ref()), column(|s| s.acceleration.as_ref())];
        let mut rows = vec![0.0; joints * joints * NUMBERS];
        let mut now = [vec![0.0; joints], vec![0.0; joints], vec![0.0; joints]];
        for row in 0..self.len() {
            for joint in 0..joints {
                let [velocity, acceleration] = moved(row, joint);
                for (order, by) in [0.0, velocity, acceleration].into_iter().enumerate() {
                    now[order][joint] = motion[order][joint][row] + by;
                }
            }
            regressor(chain, &State { position: &now[0], velocity: &now[1], acceleration: &now[2] }, &mut rows);
            with(row, &rows);
        }
    }

    /// Torques per unit of the base parameters.
    #[must_use]
    pub fn columns(&self, chain: &Chain, base: &Base) -> Columns {
        self.columns_moved(chain, base, |_, _| [0.0, 0.0])
    }

    /// The same with something added to velocity and acceleration of each joint at each sample.
    pub(super) fn columns_moved(
        &self,
        chain: &Chain,
        base: &Base,
        moved: impl Fn(usize, usize) -> [f64; 2],
    ) -> Columns {
        let carries = |joint: usize, link: usize| {
            std::iter::successors(Some(link), |at| chain.joints[*at].parent).any(|at| at == joint)
        };
        let empty = |joint: usize| {
            let of = |parameter: &super::base::BaseParameter| {
                let link = parameter.terms[0].0 / NUMBERS;
                let felt = if parameter.rotor().is_some() { joint == link } else { carries(joint, link) };
                felt.then(|| vec![0.0; self.len()])
            };
            base.parameters.iter().map(of).collect::<Vec<_>>()
        };
        let mut columns: Columns = (0..chain.len()).map(empty).collect();
        let width = NUMBERS * chain.len();
        self.for_each(chain, moved, |row, torques| {
            for (joint, columns) in columns.iter_mut().enumerate() {
                for (column, parameter) in columns.iter_mut().zip(&base.parameters) {
                    if let Some(column) = column {
                        column[row] = torques[joint * width + parameter.terms[0].0];
                    }
                }
            }
        });
        columns
    }
}

/// Torque of one joint by values of the base parameters, those that `counts` leaves out left out.
#[must_use]
pub fn torque_of(columns: &[Option<Vec<f64>>], values: &[f64], counts: impl Fn(usize) -> bool) -> Vec<f64> {
    let rows = columns.iter().flatten().map(Vec::len).max().unwrap_or(0);
    let mut sum = vec![0.0; rows];
    for (index, (column, value)) in columns.iter().zip(values).enumerate() {
        if let Some(column) = column.as_ref().filter(|_| counts(index)) {
            sum.iter_mut().zip(column).for_each(|(sum, x)| *sum += value * x);
        }
    }
    sum
}

impl Run {
    /// Recordings of all joints as one run: on the rows that all of them have, interrupted where one of them is.
    ///
    /// # Errors
    /// `FRK-D018` when they have hardly a row in common.
    pub fn of(label: &str, joints: Vec<Recording>) -> Result<Self> {
        let time = |recording: &Recording| recording.values(Quantity::Time).unwrap_or_default().to_vec();
        let times: Vec<Vec<f64>> = joints.iter().map(time).collect();
        let in_all = |t: &f64| times.iter().all(|times| times.binary_search_by(|other| other.total_cmp(t)).is_ok());
        let common: Vec<f64> = times.first().into_iter().flatten().copied().filter(in_all).collect();
        if common.len() < MINIMUM_ROWS {
            let message = "the joints of this recording have hardly a row in common";
            return Err(Error::new(&codes::RECORDINGS_DISAGREE, message).in_file(label));
        }
        let on_common = |(recording, times): (Recording, &Vec<f64>)| {
            let kept: Vec<usize> =
                (0..times.len()).filter(|row| common.binary_search_by(|t| t.total_cmp(&times[*row])).is_ok()).collect();
            recording.with_rows(&kept, Omission::Bridged)
        };
        let joints: Vec<Recording> = joints.into_iter().zip(&times).map(on_common).collect();
        let interrupted: Vec<usize> =
            joints.iter().flat_map(|recording| recording.health.interruptions.iter().copied()).collect();
        let joints = joints.into_iter().map(|recording| recording.with_interruptions(&interrupted)).collect();
        Ok(Self { label: label.to_owned(), joints })
    }

    /// Length of the run, s.
    fn seconds(&self) -> Option<f64> {
        let time = self.joints.first()?.values(Quantity::Time)?;
        Some(time.last()? - time.first()?)
    }
}
