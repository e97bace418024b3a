//! All joints of a fleet, kind by kind.

use std::collections::BTreeMap;

use super::common_law::{common_law, named};
use super::discoveries::{adjusted, of_any};
use super::level::Levels;
use super::measured::Measured;
use super::siblings::{Departure, Estimate, Siblings};
use super::trend::{Dated, Trend, trends};
use crate::numerics::statistics::NORMAL_95;
use crate::parameter::Parameter;

/// Days of a year.
const YEAR_DAYS: f64 = 365.25;

/// What is known of a fleet.
#[derive(Clone, Debug)]
pub struct Survey {
    /// Kinds of joints, by name.
    pub kinds: Vec<Kind>,
    /// Joints, by name.
    pub members: Vec<Member>,
    /// Share of the outliers that is expected to be healthy, at most.
    pub false_share: f64,
}

/// Joints that are compared with each other.
#[derive(Clone, Debug)]
pub struct Kind {
    /// Its name; may be empty.
    pub name: String,
    /// Unit of torque, force or current as printed.
    pub unit: String,
    /// How many joints there are.
    pub joints: usize,
    /// The law that describes all of them best.
    pub law: Option<String>,
    /// Its constants: name, unit, and what siblings have in common.
    pub constants: Vec<(String, String, Option<Siblings>)>,
    /// Speeds at which their friction is compared.
    pub levels: Levels,
    /// What siblings have in common of every quantity, in the order of [`Quantity::ALL`]: logarithms, the trend a share a year.
    pub common: Vec<Option<Siblings>>,
}

/// One joint, by its newest recording.
#[derive(Clone, Debug)]
pub struct Member {
    /// Its name.
    pub joint: String,
    /// Its kind, an index of [`Survey::kinds`].
    pub kind: usize,
    /// How many recordings there are of it.
    pub recordings: usize,
    /// Day of the newest, where it is known.
    pub day: Option<f64>,
    /// Constants of the law that its siblings share, as fitted to this joint, each with what is expected of it given the siblings.
    pub constants: Vec<(Parameter, Estimate)>,
    /// Its quantities beside those of its siblings, in the order of [`Quantity::ALL`].
    pub compared: Vec<Comparison>,
    /// Radians of phase per unit of position of its strongest ripple.
    pub ripple_order: Option<f64>,
    /// Smallest share of false alarms at which it is an outlier.
    pub adjusted: f64,
    /// Whether it differs from its siblings.
    pub is_outlier: bool,
}

/// A quantity of one joint.
#[derive(Clone, Copy, Debug)]
pub struct Comparison {
    /// Which.
    pub quantity: Quantity,
    /// Value in the unit of the actuator, the trend as a share a year; `None` where it is not known.
    pub value: Option<Estimate>,
    /// How far it is from the siblings.
    pub departure: Option<Departure>,
    /// Whether it is one of the reasons why the joint is an outlier.
    pub stands_out: bool,
}

/// What siblings are compared by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Friction at the slow, medium or fast speed (0, 1, 2).
    Friction(usize),
    /// Amplitude of the strongest wave over position.
    Ripple,
    /// What the model leaves.
    Residual,
    /// Change of the friction, a share a year.
    Trend,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Friction(0), Self::Friction(1), Self::Friction(2), Self::Ripple, Self::Residual, Self::Trend];

    /// Name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Friction(level) => Levels::NAMES[level],
            Self::Ripple => "ripple",
            Self::Residual => "residual",
            Self::Trend => "friction_trend",
        }
    }
}

/// Compares joints with their siblings; of the outliers a share of at most `false_share` (0 to 1) is expected to be healthy.
#[must_use]
pub fn survey(measured: &[Measured], false_share: f64) -> Survey {
    let mut kinds: BTreeMap<&str, BTreeMap<&str, Vec<&Measured>>> = BTreeMap::new();
    for recording in measured {
        kinds.entry(&recording.kind).or_default().entry(&recording.joint).or_default().push(recording);
    }
    let mut survey = Survey { kinds: Vec::new(), members: Vec::new(), false_share };
    for (index, (name, joints)) in kinds.into_iter().enumerate() {
        let joints: Vec<Vec<&Measured>> = joints.into_values().map(by_day).collect();
        let (kind, members) = of_kind(name, index, &joints);
        survey.kinds.push(kind);
        survey.members.extend(members);
    }
    judge(&mut survey.members, false_share);
    survey.members.sort_by(|a, b| a.joint.cmp(&b.joint));
    survey
}

/// Recordings of a joint, the newest last; those without a date come before all others.
fn by_day(mut recordings: Vec<&Measured>) -> Vec<&Measured> {
    let day = |recording: &Measured| recording.day.unwrap_or(f64::NEG_INFINITY);
    recordings.sort_by(|a, b| day(a).total_cmp(&day(b)));
    recordings
}

fn of_kind(name: &str, index: usize, joints: &[Vec<&Measured>]) -> (Kind, Vec<Member>) {
    let newest: Vec<&Measured> = joints.iter().filter_map(|recordings| recordings.last().copied()).collect();
    let levels = Levels::shared(&newest);
    let law = common_law(&newest);
    let own: Vec<Vec<Parameter>> = newest
        .iter()
        .map(|member| law.and_then(|law| named(member, law)).map_or_else(Vec::new, |law| law.parameters.clone()))
        .collect();
    let constants = constants(&own);
    let trends = trends(&joints.iter().map(|recordings| dated(&levels, recordings)).collect::<Vec<_>>());
    let values: Vec<[Option<Estimate>; 6]> =
        newest.iter().zip(&trends).map(|(member, trend)| values(&levels, member, *trend)).collect();
    let common: Vec<Option<Siblings>> = (0..Quantity::ALL.len())
        .map(|quantity| {
            let known = values.iter().filter_map(|values| comparable(Quantity::ALL[quantity], values[quantity]));
            Siblings::of(&known.collect::<Vec<_>>())
        })
        .collect();
    let members = newest.iter().enumerate().map(|(row, member)| {
        let compared = (0..Quantity::ALL.len()).map(|k| {
            let (quantity, value) = (Quantity::ALL[k], values[row][k]);
            let departure = common[k].and_then(|siblings| siblings.departure(&comparable(quantity, value)?));
            Comparison { quantity, value, departure, stands_out: false }
        });
        let expected = |parameter: &Parameter| {
            let siblings =
                constants.iter().find(|(name, ..)| *name == parameter.name).and_then(|(.., siblings)| *siblings);
            siblings.map_or_else(|| estimate(parameter), |siblings| siblings.shrunk(&estimate(parameter)))
        };
        Member {
            joint: member.joint.clone(),
            kind: index,
            recordings: joints[row].len(),
            day: member.day,
            constants: own[row].iter().map(|parameter| (parameter.clone(), expected(parameter))).collect(),
            compared: compared.collect(),
            ripple_order: member.ripple.map(|ripple| ripple.order),
            adjusted: 1.0,
            is_outlier: false,
        }
    });
    let members = members.collect();
    let unit = newest.first().map_or_else(String::new, |member| member.unit.clone());
    let kind = Kind {
        name: name.to_owned(),
        unit,
        joints: newest.len(),
        law: law.map(str::to_owned),
        constants,
        levels,
        common,
    };
    (kind, members)
}

/// What siblings have in common of each constant, in the order of the first that has it.
fn constants(own: &[Vec<Parameter>]) -> Vec<(String, String, Option<Siblings>)> {
    let mut names: Vec<(String, String)> = Vec::new();
    for parameter in own.iter().flatten() {
        if !names.iter().any(|(name, _)| *name == parameter.name) {
            names.push((parameter.name.clone(), parameter.unit.clone()));
        }
    }
    let common = |name: &str| {
        let of_name = own.iter().flatten().filter(|parameter| parameter.name == name);
        Siblings::of(&of_name.map(estimate).filter(|e| e.value.is_finite() && e.error.is_finite()).collect::<Vec<_>>())
    };
    names.into_iter().map(|(name, unit)| (name.clone(), unit, common(&name))).collect()
}

/// A constant with its standard error.
fn estimate(parameter: &Parameter) -> Estimate {
    let [low, high] = parameter.ci95;
    Estimate { value: parameter.value, error: 0.5 * (high - low).abs() / NORMAL_95 }
}

/// The quantities of a joint, in the order of [`Quantity::ALL`].
fn values(levels: &Levels, member: &Measured, trend: Option<Trend>) -> [Option<Estimate>; 6] {
    let [slow, medium, fast] = levels.of(member);
    // How well a residual or a ripple is known is part of their spread among siblings.
    let exact = |value: f64| Estimate { value, error: 0.0 };
    let a_year = |slope: Estimate| Estimate { value: YEAR_DAYS * slope.value, error: YEAR_DAYS * slope.error };
    let ripple = member.ripple.map(|ripple| exact(ripple.amplitude));
    [slow, medium, fast, ripple, Some(exact(member.residual)), trend.map(|trend| a_year(trend.slope))]
}

/// A quantity on the scale on which siblings scatter alike to both sides: logarithms of what is above zero by nature.
fn comparable(quantity: Quantity, value: Option<Estimate>) -> Option<Estimate> {
    let value = value?;
    match quantity {
        Quantity::Trend => Some(value),
        _ if value.value > 0.0 => Some(Estimate { value: value.value.ln(), error: value.error / value.value }),
        _ => None,
    }
}

/// The friction of a joint over its dates, as a logarithm: the mean of its levels.
fn dated(levels: &Levels, recordings: &[&Measured]) -> Vec<Dated> {
    let of = |recording: &&Measured| {
        let logarithms = levels.of(recording).map(|level| comparable(Quantity::Friction(0), level).map(|e| e.value));
        let [slow, medium, fast] = logarithms;
        Some(Dated { day: recording.day?, value: (slow? + medium? + fast?) / 3.0 })
    };
    recordings.iter().filter_map(of).collect()
}

/// Says which joints are outliers, and by what.
fn judge(members: &mut [Member], false_share: f64) {
    let of_member =
        |member: &Member| member.compared.iter().filter_map(|c| c.departure.map(|d| d.p)).collect::<Vec<_>>();
    let probabilities: Vec<f64> = members.iter().map(|member| of_any(of_member(member).into_iter())).collect();
    let adjusted = adjusted(&probabilities);
    let is_found = |share: f64| share <= false_share;
    let found = adjusted.iter().filter(|share| is_found(**share)).count() as f64;
    // The probability up to which so many discoveries among so many joints hold the share (Benjamini and Hochberg's critical value).
    let critical = false_share * found / members.len() as f64;
    for (member, share) in members.iter_mut().zip(adjusted) {
        member.adjusted = share;
        member.is_outlier = is_found(share);
        let tests = member.compared.iter().filter(|c| c.departure.is_some()).count() as f64;
        for compared in &mut member.compared {
            compared.stands_out =
                member.is_outlier && compared.departure.is_some_and(|departure| departure.p * tests <= critical);
        }
    }
}
