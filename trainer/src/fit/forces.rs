//! Known other forces, such as a pressure, a spring or a hydraulic: columns in proportion to which something else acts on the joint. Their factors are
//! identified together with the rigid body and a friction law that is free to bend, and the torque that follows is taken off before anything is
//! fitted or diagnosed.

use crate::error::{Error, Result, codes};
use crate::fit::data::gather::REST_SHARE;
use crate::fit::data::rigid::printed;
use crate::joint::Joint;
use crate::numerics::jackknife::{ERROR_BLOCKS, even_blocks};
use crate::numerics::regression::least_squares;
use crate::numerics::statistics::NORMAL_95;
use crate::parameter::Parameter;
use crate::recording::Recording;
use crate::samples::rigid_body::{TermKind, given_torque, terms};
use crate::samples::{BendingLaw, Preparation, Request, Samples, prepare, top_speed};

/// Share of the square of a column that body and friction have to leave: less and it cannot be told from an offset or from friction.
const LEAST_OWN_SHARE: f64 = 1e-4;

/// The known other forces of recordings.
#[derive(Clone, Debug, Default)]
pub struct OtherForces {
    /// The factor of each column, in the unit of the actuator per unit of the column.
    pub factors: Vec<Parameter>,
    /// What the recordings do not tell, in sentences.
    pub remarks: Vec<String>,
}

impl OtherForces {
    /// Identifies the factors of `forces` of joint.toml from recordings of one joint.
    ///
    /// # Errors
    /// `FRK-D009` where a recording has no such column, and whatever preparing a recording reports.
    pub fn of(recordings: &[Recording], joint: &Joint) -> Result<Self> {
        if joint.forces.is_empty() {
            return Ok(Self::default());
        }
        for recording in recordings {
            for column in &joint.forces {
                named(recording, column)?;
            }
        }
        let borrowed: Vec<&Recording> = recordings.iter().collect();
        let preparation = Preparation::plan(&borrowed, joint, &Request::default())?;
        let parts = recordings.iter().map(|recording| prepare(recording, &preparation)).collect::<Result<Vec<_>>>()?;
        identified(&Samples::join(parts)?, joint)
    }

    /// A recording without the other forces.
    ///
    /// # Errors
    /// `FRK-D009` where it has no such column.
    pub fn taken_off(&self, mut recording: Recording) -> Result<Recording> {
        for factor in &self.factors {
            let column = named(&recording, &factor.name)?.to_vec();
            let quantity = recording.actuator().and_then(|channel| channel.quantity);
            let actuator = recording.channels.iter_mut().find(|channel| channel.quantity == quantity);
            if let Some(actuator) = actuator.filter(|_| quantity.is_some()) {
                actuator.values.iter_mut().zip(&column).for_each(|(torque, value)| *torque -= factor.value * value);
            }
            recording.channels.retain(|channel| channel.name != factor.name);
        }
        Ok(recording)
    }
}

fn named<'r>(recording: &'r Recording, column: &str) -> Result<&'r [f64]> {
    recording.named(column).map(|channel| channel.values.as_slice()).ok_or_else(|| {
        let message = "`forces` of joint.toml names this column, and the recording has none of that name";
        Error::new(&codes::MISSING_COLUMN, message).in_file(recording.file()).in_column(column)
    })
}

fn identified(samples: &Samples, joint: &Joint) -> Result<OtherForces> {
    let velocity = samples.require_velocity()?;
    let least = REST_SHARE * top_speed(velocity);
    let moving: Vec<usize> = (0..velocity.len()).filter(|&row| velocity[row].abs() > least).collect();
    let pick = |column: &[f64]| moving.iter().map(|&row| column[row]).collect::<Vec<f64>>();
    let law = BendingLaw::over(&pick(velocity))?;
    let known = given_torque(samples, joint)?;
    let actuator = samples.actuator.as_deref().unwrap_or_default();
    let target: Vec<f64> = moving.iter().map(|&row| actuator[row] - known[row]).collect();
    // The law holds the offset.
    let body = terms(samples, joint).into_iter().filter(|term| term.kind != TermKind::TorqueOffset);
    let mut beside: Vec<Vec<f64>> = body.map(|term| pick(&term.column)).collect();
    beside.extend(law.columns(&pick(velocity)));
    let blocks = even_blocks(target.len(), ERROR_BLOCKS);
    let (mut columns, mut names, mut untold) = (Vec::new(), Vec::<&str>::new(), Vec::<&str>::new());
    for name in &joint.forces {
        let column = pick(samples.require_input(name)?);
        let power = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
        let others: Vec<Vec<f64>> = columns.iter().chain(&beside).cloned().collect();
        if power(&least_squares(&others, &column, &blocks).residuals) < LEAST_OWN_SHARE * power(&column) {
            untold.push(name);
        } else {
            columns.push(column);
            names.push(name);
        }
    }
    let fit = loop {
        let all: Vec<Vec<f64>> = columns.iter().chain(&beside).cloned().collect();
        let fit = least_squares(&all, &target, &blocks);
        let deviations = |index: &usize| fit.coefficients[*index].abs() / fit.standard_error(*index);
        let least = (0..columns.len()).min_by(|a, b| deviations(a).total_cmp(&deviations(b)));
        match least.filter(|index| deviations(index) < NORMAL_95) {
            Some(index) => {
                columns.remove(index);
                untold.push(names.remove(index));
            }
            None => break fit,
        }
    };
    let unit = printed(samples.actuator_unit);
    let factor = |(index, name): (usize, &&str)| {
        let (value, error) = (fit.coefficients[index], NORMAL_95 * fit.standard_error(index));
        Parameter {
            name: (*name).to_owned(),
            symbol: format!("k_{}", index + 1),
            value,
            unit: format!("{unit} per {name}"),
            ci95: [value - error, value + error],
        }
    };
    let factors = names.iter().enumerate().map(factor).collect();
    let remarks = (!untold.is_empty()).then(|| {
        format!(
            "Nothing tells the force of {} from offset and friction: it is a part of them; record it at other values.",
            untold.join(", ")
        )
    });
    Ok(OtherForces { factors, remarks: remarks.into_iter().collect() })
}
