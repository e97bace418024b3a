//! One law for all joints of a kind.

use super::measured::{FittedLaw, Measured};

/// The law that describes all of these best: the smallest sum of information criteria, of the laws that every one of them has.
pub(super) fn common_law<'a>(members: &[&'a Measured]) -> Option<&'a str> {
    let first = members.first()?;
    let total = |law: &FittedLaw| -> Option<f64> {
        let of = |member: &&Measured| named(member, &law.name).map(|law| law.bic).filter(|bic| bic.is_finite());
        members.iter().map(of).sum()
    };
    let totals = first.laws.iter().filter_map(|law| Some((total(law)?, law.name.as_str())));
    totals.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name)
}

/// A joint's fit of the law of that name.
pub(super) fn named<'a>(member: &'a Measured, name: &str) -> Option<&'a FittedLaw> {
    member.laws.iter().find(|law| law.name == name)
}
