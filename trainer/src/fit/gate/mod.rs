//! Before an image: whether the motion tells the constants of friction apart, and whether the law is worth anything on rows that it has
//! not seen. Knows the material and the errors of a law, not the law.

pub(super) mod bending;
pub(super) mod confounded;
mod speeds;
pub(super) mod worth;

use super::choice::choose::Trial;
use super::data::gather::{Material, gather};
use super::outcome::Soundness;
use crate::error::Result;
use crate::joint::Joint;
use crate::parameter::Parameter;
use crate::recording::Recording;
use crate::samples::Request;
use bending::{Bending, bending};
use confounded::{Constant, Identified};
use worth::{Worthless, worthless};

/// What is fixed where a joint goes one way only.
const ONE_WAY: &str = "In one direction friction and offset are one constant: the offset is fixed at 0, and the law holds in \
                                  the direction that was recorded.";

/// What is fixed where nothing accelerates.
const UNACCELERATED: &str = "The joint accelerates by no more than the noise, as in strokes of constant speed: nothing tells its inertia, which is \
                             left at 0.";

/// What is fixed at a stated value because nothing tells it, and what strokes of constant speed tell, in sentences.
pub(super) fn fixed(material: &Material, identified: &Identified) -> Vec<String> {
    let one_way = identified.is_one_way().then_some(ONE_WAY);
    let still = (material.is_without_acceleration && material.separation.is_some()).then_some(UNACCELERATED);
    one_way.into_iter().chain(still).map(str::to_owned).chain(speeds::left_out(material)).collect()
}

/// What recordings of one joint can tell of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Identifiable {
    /// Constants of the simple law, then effects that a recording may show, with the share of the friction (root mean square) from which on they show;
    /// one and above where nothing can be said of them.
    pub shares: Vec<(String, f64)>,
    /// What has to be recorded for those of which nothing can be said, each once.
    pub record_next: Vec<&'static str>,
}

/// Looks at the motion of recordings, and at what the simple law leaves of their torque.
///
/// # Errors
/// As [`fit`](super::fit), where nothing can be learnt at all.
pub fn identifiable(recordings: &[Recording], joint: &Joint) -> Result<Identifiable> {
    let material = gather(recordings, joint, &Request::default())?;
    let identified = Identified::by(&material);
    let unknown = identified.unknown();
    // What makes up for Coulomb friction says what has to be recorded.
    let own = unknown.iter().filter(|constant| unknown.len() == 1 || **constant != Constant::Coulomb);
    let mut record_next: Vec<&str> = own.map(|constant| constant.asks_for()).collect();
    let mut shares: Vec<(String, f64)> =
        identified.constants.iter().map(|(constant, share)| (constant.to_string(), *share)).collect();
    for (effect, share) in confounded::effects(&material) {
        record_next.extend((share >= 1.0).then(|| effect.asks_for()));
        shares.push((effect.to_string(), share));
    }
    let mut seen = Vec::new();
    record_next.retain(|text| {
        let is_new = !seen.contains(text);
        seen.push(*text);
        is_new
    });
    Ok(Identifiable { shares, record_next })
}

/// How the joint bends, where that is what it does in place of sliding, which a law that is not sound may be due to.
pub(super) fn bends(material: &Material, trial: Option<&Trial>) -> Option<Bending> {
    let is_spring = trial.and_then(|trial| worthless(material, trial)) == Some(Worthless::Spring);
    is_spring.then(|| bending(material)).flatten()
}

fn is_asymmetry(parameter: &Parameter) -> bool {
    parameter.name.contains("asymmetry")
}

/// A constant of friction that is below zero with 95 % in one direction at least, with its value there. An asymmetry has the sign of the axis, which is
/// anybody's choice: it counts only against what it takes from.
fn negative(parameters: &[Parameter], of: Constant) -> Option<(&Parameter, f64)> {
    let named = || parameters.iter().filter(|parameter| of.is_named(&parameter.name));
    let taken = named().filter(|parameter| is_asymmetry(parameter));
    let taken = taken.map(|asymmetry| {
        let [low, high] = asymmetry.ci95;
        let least = if low < 0.0 && high > 0.0 { 0.0 } else { low.abs().min(high.abs()) };
        (asymmetry.value.abs(), least)
    });
    let (taken, least_taken) = taken.fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
    let mut symmetric = named().filter(|parameter| !is_asymmetry(parameter));
    let found = symmetric.find(|parameter| parameter.ci95[1] - least_taken < 0.0)?;
    Some((found, found.value - taken))
}

/// What keeps a law that converged from going into an image.
pub(super) fn withheld(
    material: &Material,
    identified: &Identified,
    trial: Option<&Trial>,
    parameters: &[Parameter],
    uncertain_share: f64,
) -> Soundness {
    let of_friction = [Constant::Coulomb, Constant::Viscous];
    if let Some((Parameter { name, unit, .. }, value)) = of_friction.iter().find_map(|of| negative(parameters, *of)) {
        return Soundness::NotPhysical(format!(
            "the {name} is negative ({value:.3e} {unit}): the torque is late, a column is not what it is taken for, or something else acts on the \
             joint"
        ));
    }
    if let Some(why) = trial.and_then(|trial| worthless(material, trial)) {
        return Soundness::NotIdentifiable(why.sentence().to_owned());
    }
    let unknown = identified.unknown();
    if let Some(first) =
        unknown.iter().rev().find(|constant| of_friction.contains(constant)).filter(|_| !identified.is_one_way())
    {
        let names: Vec<String> = unknown.iter().map(ToString::to_string).collect();
        return Soundness::NotIdentifiable(format!(
            "this motion does not tell {} apart: each may be nothing or all of the friction; record {}",
            names.join(" and "),
            first.asks_for()
        ));
    }
    if uncertain_share >= 1.0 {
        let why = "by its 95 % band the friction may be nothing at any speed, so that its gain is 0; record it sliding, both ways, for longer";
        return Soundness::NotIdentifiable(why.to_owned());
    }
    Soundness::Sound
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameter(name: &str, value: f64, half: f64) -> Parameter {
        let [symbol, unit] = ["F", "N s/m"].map(str::to_owned);
        Parameter { name: name.to_owned(), symbol, value, unit, ci95: [value - half, value + half] }
    }

    #[test]
    fn an_asymmetry_may_have_either_sign_and_not_exceed_what_it_takes_from() {
        for sign in [1.0, -1.0] {
            let of = |viscous: f64, asymmetry: f64| {
                [
                    parameter("viscous_coefficient", viscous, 3.0),
                    parameter("viscous_asymmetry_coefficient", sign * asymmetry, 2.0),
                ]
            };
            assert_eq!(negative(&of(185.0, 37.0), Constant::Viscous), None);
            assert_eq!(negative(&of(30.0, 34.0), Constant::Viscous), None);
            let too_much = of(30.0, 40.0);
            assert_eq!(negative(&too_much, Constant::Viscous), Some((&too_much[0], -10.0)));
        }
        let below = [parameter("viscous_coefficient", -5.0, 1.0)];
        assert_eq!(negative(&below, Constant::Viscous), Some((&below[0], -5.0)));
    }
}
