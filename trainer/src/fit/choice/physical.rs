//! What no joint can do: a negative inertia, and friction that drives.

use crate::fit::data::gather::Material;
use crate::fit::model::HostModel;
use crate::fit::predict::predict;
use crate::samples::rigid_body::TermKind;

/// Friction along the motion counts from this share of the largest friction on.
const TOLERATED_SHARE: f64 = 0.05;
/// Bins of equal width over the velocity in which the mean friction is looked at, each way.
const BINS: usize = 12;
/// Rows that a bin needs.
const LEAST_ROWS: usize = 5;

/// What a model claims that no joint can do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::fit) struct Violation {
    /// Its inertia, where that is negative.
    inertia: Option<f64>,
    /// Velocity at which friction drives most.
    drives_at: Option<f64>,
    /// Mean power that friction takes out of the joint over the recording is negative.
    feeds: bool,
    /// Whether the whole inertia was identified.
    identified: bool,
}

impl Violation {
    /// Looks at a model along the samples that it was fitted to.
    pub(in crate::fit) fn of(model: &HostModel, material: &Material) -> Self {
        let identified = material.columns.iter().any(|column| column.kind == TermKind::Inertia);
        let inertia = Some(f64::from(model.rigid_body.inertia)).filter(|inertia| identified && *inertia < 0.0);
        let mut violation = Self { inertia, identified, ..Self::default() };
        let (Some(velocity), Ok(prediction)) = (&material.samples.velocity, predict(model, &material.samples)) else {
            return violation;
        };
        let (velocity, friction) = (material.pick(velocity), material.pick(&prediction.friction));
        violation.feeds = velocity.iter().zip(&friction).map(|(v, f)| v * f).sum::<f64>() < 0.0;
        violation.drives_at = driving(&velocity, &friction);
        violation
    }

    pub(in crate::fit) fn is_any(self) -> bool {
        self.inertia.is_some() || self.drives_at.is_some() || self.feeds
    }

    /// Whether the model is that of a torque of the wrong sign: friction feeds the joint, and its inertia, where one was
    /// identified, is negative too.
    fn is_reversed(self) -> bool {
        self.feeds && (self.inertia.is_some() || !self.identified)
    }

    /// In a sentence, with the unit of the actuator.
    pub(in crate::fit) fn sentence(self) -> Option<String> {
        let mut parts = Vec::new();
        parts.extend(self.inertia.map(|inertia| format!("the inertia is negative ({inertia:.3e})")));
        match self.drives_at {
            _ if self.feeds => parts.push("friction feeds energy into the joint over the whole recording".to_owned()),
            Some(velocity) => parts.push(format!("friction drives the joint at a velocity of {velocity:.3}")),
            None => {}
        }
        if parts.is_empty() {
            return None;
        }
        let cause = if self.is_reversed() {
            "the torque has the wrong sign, or is no torque of this joint"
        } else {
            "something else acts on the joint (a spring, another joint, an outer force), or a column is not what it is taken for"
        };
        Some(format!("{}: {cause}", parts.join(" and ")))
    }
}

/// The velocity, as the middle of a bin, at which the mean friction drives most; `None` where it does so nowhere by more than is
/// tolerated.
fn driving(velocity: &[f64], friction: &[f64]) -> Option<f64> {
    let top = velocity.iter().fold(0.0_f64, |peak, v| peak.max(v.abs()));
    let width = top / BINS as f64;
    let mut sums = [(0.0, 0usize); 2 * BINS];
    for (v, f) in velocity.iter().zip(friction) {
        let bin = ((v.abs() / width) as usize).min(BINS - 1) + if *v < 0.0 { BINS } else { 0 };
        sums[bin].0 += f * v.signum();
        sums[bin].1 += 1;
    }
    let means = sums.iter().enumerate().filter(|(_, (_, rows))| *rows >= LEAST_ROWS);
    let means: Vec<(usize, f64)> = means.map(|(bin, (sum, rows))| (bin, sum / *rows as f64)).collect();
    let largest = means.iter().fold(0.0_f64, |peak, (_, mean)| peak.max(mean.abs()));
    let (bin, least) = means.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let middle = ((bin % BINS) as f64 + 0.5) * width;
    (least < -TOLERATED_SHARE * largest).then_some(if bin < BINS { middle } else { -middle })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_that_falls_below_zero_is_found_where_it_does() {
        let velocity: Vec<f64> = (-500..500).map(|i| f64::from(i) * 0.002 + 0.001).collect();
        let law = |f: fn(f64) -> f64| velocity.iter().map(|v| f(*v)).collect::<Vec<f64>>();
        assert_eq!(driving(&velocity, &law(|v| v.signum() + 0.5 * v)), None);
        assert_eq!(driving(&velocity, &law(|v| v.signum() - 0.5 * v)), None);
        let found = driving(&velocity, &law(|v| v.signum() - 2.0 * v)).unwrap();
        assert!(found.abs() > 0.9, "{found}");
    }
}
