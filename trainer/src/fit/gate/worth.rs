//! Whether a law is worth more, on rows that it has not seen, than what says nothing of friction: a constant torque, a spring, and less than
//! all of it, Coulomb friction alone.

use crate::fit::choice::choose::Trial;
use crate::fit::data::gather::Material;
use crate::fit::data::turns::open;
use crate::numerics::regression::least_squares;

/// Why a law is worth nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::fit) enum Worthless {
    /// A constant torque does as well.
    Constant,
    /// A spring alone does better.
    Spring,
    /// Coulomb friction alone does better.
    Coulomb,
}

impl Worthless {
    pub(in crate::fit) fn sentence(self) -> &'static str {
        match self {
            Self::Constant => {
                "the law predicts rows that it has not seen no better than a constant torque does: the joint does not slide, or this is not its \
                 torque; record it sliding, both ways, at several speeds"
            }
            Self::Spring => {
                "a spring alone predicts rows that it has not seen better than the law does: the joint bends and does not slide, or a spring acts \
                 on it; record it sliding, both ways, at several speeds"
            }
            Self::Coulomb => {
                "Coulomb friction alone predicts rows that it has not seen better than the law does: record more, so that the law is determined"
            }
        }
    }
}

/// Why a law is worth nothing; `None` where it is worth something. `trial` holds its errors.
pub(in crate::fit) fn worthless(material: &Material, trial: &Trial) -> Option<Worthless> {
    let velocity = material.samples.velocity.as_deref().unwrap_or_default();
    let ones = vec![1.0; velocity.len()];
    let constant = baseline(material, std::slice::from_ref(&ones));
    if constant.is_some_and(|constant| !constant.is_clearly_beaten_in_blocks_by(trial)) {
        return Some(Worthless::Constant);
    }
    if let Some(position) = &material.samples.position {
        let spring = baseline(material, &[ones, position.clone()]);
        if spring.is_some_and(|spring| trial.is_clearly_beaten_by(&spring)) {
            return Some(Worthless::Spring);
        }
    }
    let sign = velocity.iter().map(|v| v.signum()).collect();
    let rigid = material.columns.iter().map(|column| column.values.clone());
    let coulomb = baseline(material, &std::iter::once(sign).chain(rigid).collect::<Vec<_>>());
    coulomb.is_some_and(|coulomb| trial.is_clearly_beaten_by(&coulomb)).then_some(Worthless::Coulomb)
}

/// Errors of a linear model beside the given rigid body, fitted to what each turn leaves open; `None` where that does not determine it.
fn baseline(material: &Material, columns: &[Vec<f64>]) -> Option<Trial> {
    let mut trial = Trial::default();
    let total = material.samples.friction.as_deref().or(material.samples.actuator.as_deref()).unwrap_or_default();
    for split in &material.turns {
        let rows: Vec<usize> = open(split).into_iter().map(|position| material.rows[position]).collect();
        let pick = |column: &[f64]| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
        let own: Vec<Vec<f64>> = columns.iter().map(|column| pick(column)).collect();
        let fit = least_squares(&own, &pick(&material.target), &[0..rows.len()]);
        if fit.rank_deficiency > 0 {
            return None;
        }
        let predicted = |row: usize| {
            let given = total[row] - material.target[row] + material.bend[row];
            given + columns.iter().zip(&fit.coefficients).map(|(column, c)| c * column[row]).sum::<f64>()
        };
        trial.add_predicted(&(0..total.len()).map(predicted).collect::<Vec<_>>(), material, split);
    }
    Some(trial)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::data::gather::gather;
    use crate::joint::Joint;
    use crate::recording::parse;
    use crate::samples::Request;
    use std::fmt::Write;

    /// A minute at 100 Hz of position and torque over time (s); `None` where nothing of it moves long enough for a fit.
    fn recorded(row: impl Fn(f64) -> [f64; 2]) -> Option<Material> {
        let mut text = String::from("time_s,position_rad,torque_Nm\n");
        for index in 0..6000 {
            let time = 0.01 * f64::from(index);
            let [position, torque] = row(time);
            writeln!(text, "{time},{position},{}", torque + 0.02 * (31.0 * time * time).sin()).unwrap();
        }
        let recording = parse("joint.csv", text.as_bytes(), &Joint::default()).unwrap();
        gather(&[recording], &Joint::default(), &Request::default()).ok()
    }

    /// What is said of Coulomb and viscous friction beside rigid body and offset.
    fn said(material: &Material) -> Option<&'static str> {
        let velocity = material.samples.velocity.clone().unwrap();
        let mut columns = vec![velocity.iter().map(|v| v.signum()).collect(), velocity];
        columns.extend(material.columns.iter().map(|column| column.values.clone()));
        worthless(material, &baseline(material, &columns).unwrap()).map(Worthless::sentence)
    }

    fn drive(time: f64) -> f64 {
        (0.7 * time).sin() + 0.4 * (1.61 * time).sin()
    }

    /// A sweep that begins with a hundred times the acceleration that it ends with: the constant leaves most in its first second.
    #[test]
    fn a_law_is_worth_something_where_one_block_moves_with_most_of_the_torque() {
        let speed = |t: f64| (2.0 + 10.0 * (-0.1 * t).exp(), 6.0 * (-0.05 * t).exp());
        let position = |t: f64| {
            let (rate, size) = speed(t);
            0.3 * size * (rate * t).sin() / rate
        };
        let near = |t: f64, shift: f64| position(t + shift);
        let swept = recorded(|t| {
            let velocity = (near(t, 1e-4) - near(t, -1e-4)) / 2e-4;
            let acceleration = (near(t, 1e-3) - 2.0 * near(t, 0.0) + near(t, -1e-3)) / 1e-6;
            [position(t), 0.8 * (velocity / 0.01).tanh() + 0.3 * velocity + 2.0 * acceleration]
        });
        assert_eq!(said(&swept.unwrap()), None);
    }

    #[test]
    fn a_joint_that_slides_is_told_from_one_that_sticks_or_bends() {
        let speed = |time: f64| 0.7 * (0.7 * time).cos() + 0.644 * (1.61 * time).cos();
        let slides = recorded(|t| [drive(t), 0.8 * (speed(t) / 0.01).tanh() + 0.3 * speed(t)]);
        assert_eq!(said(&slides.unwrap()), None);
        let is_refused = |material: Option<Material>, reasons: &[&str]| {
            material.is_none_or(|m| said(&m).is_some_and(|why| reasons.iter().any(|reason| why.contains(reason))))
        };
        let flickers = |t: f64| 1e-3 * f64::from(u8::from((997.0 * t * t).sin() > 0.97));
        assert!(is_refused(recorded(|t| [flickers(t), 2.0 * drive(t)]), &["constant"]));
        let bends = recorded(|t| [(2.5e-4 * drive(t) / 1e-6).round() * 1e-6, 2.0 * drive(t)]);
        assert!(is_refused(bends, &["spring", "constant"]));
    }
}
