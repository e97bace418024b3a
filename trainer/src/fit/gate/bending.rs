//! A joint that bends and does not slide: stiffness and micro-slip of the contact, from torque ramps below break-away.
//!
//! Dahl's friction (Dahl 1968) with exponent 1, dT/dq = sigma (1 - T sign(dq) / T_s), solved for the position: from one reversal of the torque to
//! the next q changes by -s T_s / sigma ln(1 - s T / T_s), s being the sign of the torque's change. What does not come back is micro-slip.

use crate::fit::data::gather::Material;
use crate::fit::data::rigid;
use crate::law::significant;
use crate::numerics::jackknife::Jackknife;
use crate::numerics::regression::least_squares;
use crate::numerics::statistics::NORMAL_95;
use crate::parameter::Parameter;
use crate::recording::Axis;
use std::ops::Range;

/// Reversals of the torque by less than this share of all that it spans are taken for its noise.
const REVERSAL_SHARE: f64 = 0.05;
/// Curvatures 1/T_s that are tried, as shares of the one at which the largest torque would slide: none, which is a spring, and up to nearly all.
const CURVATURES: usize = 200;
const MOST_CURVED: f64 = 0.995;
/// Digits of figures in a sentence.
const DIGITS: usize = 3;

/// What a contact that does not slide does under torque.
pub(in crate::fit) struct Bending {
    /// Stiffness, and the torque of the micro-slip where there is any.
    pub(in crate::fit) parameters: Vec<Parameter>,
    /// The same in a sentence.
    pub(in crate::fit) sentence: String,
}

/// Fits the position to the torque beyond the given rigid body; `None` where there is no position, or it does not follow the torque.
pub(in crate::fit) fn bending(material: &Material) -> Option<Bending> {
    let samples = &material.samples;
    let position = samples.position.as_deref()?;
    let (torque, segments) = (material.target.as_slice(), samples.segments.as_slice());
    let largest = torque.iter().fold(0.0_f64, |peak, torque| peak.max(torque.abs()));
    let legs: Vec<(Range<usize>, f64)> = segments.iter().flat_map(|segment| legs(torque, segment)).collect();
    // Each way of the torque begins where it begins: the turn itself is known to the noise of the torque only.
    let position = &centred(position, &legs);
    let columns = |curvature: f64| vec![centred(&given_way(torque, &legs, curvature), &legs)];
    let left = |curvature: f64| {
        let fit = least_squares(&columns(curvature), position, segments);
        (fit.rank_deficiency == 0).then(|| (fit.residuals.iter().map(|e| e * e).sum::<f64>(), fit.coefficients[0]))
    };
    let step = MOST_CURVED / largest / CURVATURES as f64;
    let tried = (0..=CURVATURES).filter_map(|k| left(k as f64 * step).map(|(square, _)| (square, k as f64 * step)));
    let (_, curvature) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
    // What both constants do to the position, to first order: the step of Gauss and Newton from the best that was tried, and the errors.
    let (beside, compliance) = (columns(curvature + 0.5 * step), left(curvature)?.1);
    let mut sensitive = columns(curvature);
    let slope = beside[0].iter().zip(&sensitive[0]).map(|(more, now)| compliance * (more - now) / (0.5 * step));
    sensitive.push(slope.collect());
    let moved = least_squares(&sensitive, position, segments).coefficients.last().copied().unwrap_or(0.0);
    let curvature = (curvature + moved).clamp(0.0, MOST_CURVED / largest);
    let (_, compliance) = left(curvature).filter(|(_, compliance)| *compliance > 0.0)?;
    let errors = Jackknife::new(&sensitive, position).errors();
    let half = |index: usize| NORMAL_95 * errors.iter().map(|error| error[index].powi(2)).sum::<f64>().sqrt();
    let (of_compliance, of_curvature) = (half(0), half(sensitive.len() - 1));
    // An interval of a reciprocal; without an upper end where it may be nothing.
    let reciprocal = |value: f64, half: f64| {
        let most = if value > half { (value - half).recip() } else { f64::INFINITY };
        [(value + half).recip(), most]
    };
    let unit = rigid::printed(samples.actuator_unit);
    let way = if samples.axis == Axis::Rotary { "rad" } else { "m" };
    let mut parameters = vec![Parameter {
        name: "presliding_stiffness".to_owned(),
        symbol: "sigma".to_owned(),
        value: compliance.recip(),
        unit: format!("{unit}/{way}"),
        ci95: reciprocal(compliance, of_compliance),
    }];
    if curvature > of_curvature {
        parameters.push(Parameter {
            name: "micro_slip_torque".to_owned(),
            symbol: "T_s".to_owned(),
            value: curvature.recip(),
            unit: unit.to_owned(),
            ci95: reciprocal(curvature, of_curvature),
        });
    }
    let sentence = sentence(&parameters, largest);
    Some(Bending { parameters, sentence })
}

/// Stretches of a segment in which the torque goes one way, with its sign.
fn legs(torque: &[f64], segment: &Range<usize>) -> Vec<(Range<usize>, f64)> {
    let own = &torque[segment.clone()];
    let (low, high) = own.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), t| (l.min(*t), h.max(*t)));
    let noise = REVERSAL_SHARE * (high - low);
    let mut legs = Vec::new();
    let (mut start, mut farthest) = (segment.start, segment.start);
    let mut sign = 0.0;
    for row in segment.clone() {
        let back = torque[farthest] - torque[row];
        if sign == 0.0 {
            let gone = torque[row] - torque[start];
            if gone.abs() > noise {
                (sign, farthest) = (gone.signum(), row);
            }
        } else if sign * back <= 0.0 {
            farthest = row;
        } else if sign * back > noise {
            legs.push((start..farthest, sign));
            (start, farthest, sign) = (farthest, row, -sign);
        }
    }
    legs.push((start..segment.end, sign));
    legs
}

/// How far a contact of unit stiffness has given way, on each way of the torque from some point on.
fn given_way(torque: &[f64], legs: &[(Range<usize>, f64)], curvature: f64) -> Vec<f64> {
    let mut position = vec![0.0; torque.len()];
    for (leg, sign) in legs {
        let way = |row: usize| match sign * curvature {
            0.0 => torque[row],
            bend => -(1.0 - bend * torque[row]).ln() / bend,
        };
        leg.clone().for_each(|row| position[row] = way(row));
    }
    position
}

/// Values less their mean over each leg.
fn centred(values: &[f64], legs: &[(Range<usize>, f64)]) -> Vec<f64> {
    let mut centred = vec![0.0; values.len()];
    for (leg, _) in legs.iter().filter(|(leg, _)| !leg.is_empty()) {
        let mean = values[leg.clone()].iter().sum::<f64>() / leg.len() as f64;
        leg.clone().for_each(|row| centred[row] = values[row] - mean);
    }
    centred
}

fn sentence(parameters: &[Parameter], largest: f64) -> String {
    let figure = |value: f64| significant(value, DIGITS);
    let told = |p: &Parameter| {
        format!("{} {} (95 % in [{}, {}])", figure(p.value), p.unit, figure(p.ci95[0]), figure(p.ci95[1]))
    };
    let slip = match parameters.get(1) {
        Some(slip) => format!("and slips a little at each turn, as of friction that would slide at {}", told(slip)),
        None => "and comes back as a spring does".to_owned(),
    };
    let (stiffness, unit) = (&parameters[0], parameters[0].unit.split('/').next().unwrap_or_default());
    format!(
        "the joint bends and does not slide under torques up to {} {unit}: its contact has a stiffness of {}, {slip}; record it sliding, both ways, \
         at several speeds",
        figure(largest),
        told(stiffness)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::data::gather::gather;
    use crate::joint::Joint;
    use crate::numerics::random::normal;
    use crate::recording::parse;
    use crate::samples::Request;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use std::fmt::Write;

    /// A contact of 8000 N m/rad under torques up to 2 N m, `curvature` (1/(N m)) of its Dahl friction, behind an encoder of 24 urad.
    fn recorded(curvature: f64, seed: u64) -> Bending {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let (mut text, mut position, mut before) = (String::from("time_s,position_rad,torque_Nm\n"), 0.0, 0.0);
        for row in 0..20_000_u32 {
            let time = 0.002 * f64::from(row);
            let torque = 2.0 * (1.57 * time).sin() * (0.9 + 0.1 * (0.31 * time).cos());
            let change = torque - before;
            position += change / (8000.0 * (1.0 - curvature * torque * change.signum()));
            before = torque;
            let noise = 0.01 * normal(&mut random);
            writeln!(text, "{time},{},{}", (position / 2.4e-5).round() * 2.4e-5, torque + noise).unwrap();
        }
        let recording = parse("stuck.csv", text.as_bytes(), &Joint::default()).unwrap();
        bending(&gather(&[recording], &Joint::default(), &Request::default()).unwrap()).unwrap()
    }

    #[test]
    fn stiffness_and_micro_slip_are_those_of_the_contact() {
        let within = |p: &Parameter, truth: f64| {
            assert!((p.value / truth - 1.0).abs() < 0.05, "{p:?}");
            assert!(p.ci95[0] < p.value && p.value < p.ci95[1] && p.ci95[1] < 1.3 * truth, "{p:?}");
        };
        let Bending { parameters, sentence } = recorded(1.0 / 6.0, 0);
        let [stiffness, slip] = &parameters[..] else { panic!("{parameters:?}") };
        within(stiffness, 8000.0);
        within(slip, 6.0);
        let mut held = 0;
        for seed in 1..=20 {
            let drawn = recorded(1.0 / 6.0, seed).parameters;
            let holds = |p: &Parameter, truth: f64| usize::from(p.ci95[0] <= truth && truth <= p.ci95[1]);
            println!("{drawn:?}");
            held += holds(&drawn[0], 8000.0) + holds(&drawn[1], 6.0);
        }
        assert!(held >= 34, "{held} of 40 intervals hold the truth");
        assert_eq!((stiffness.unit.as_str(), slip.unit.as_str()), ("N m/rad", "N m"));
        assert!(
            sentence.contains("does not slide under torques up to 1.9") && sentence.contains("N m/rad"),
            "{sentence}"
        );
        let spring = recorded(0.0, 0);
        within(&spring.parameters[0], 8000.0);
        assert!(spring.parameters.get(1).is_none_or(|slip| slip.value > 60.0), "{:?}", spring.parameters);
    }
}
