//! What was found and is no finding, in a sentence each.

use crate::diagnose::answer::outcome::Diagnosis;
use crate::figures::quantity;
use crate::physics::EffectId;
use crate::physics::names::plain_name;
use crate::physics::units::Units;

/// What was found beside the findings and accounts for little.
pub(super) fn minor(diagnosis: &Diagnosis) -> Option<String> {
    let named = |(effect, share): &(EffectId, f64)| {
        let percent = 100.0 * share;
        let percent = if percent < 0.1 { "under 0.1".to_string() } else { format!("{percent:.1}") };
        format!("{} ({percent} % of the removable error)", plain_name(*effect))
    };
    let names: Vec<String> = diagnosis.discarded.minor.iter().map(named).collect();
    (!names.is_empty()).then(|| format!("Minor beside it, and not modelled: {}.", names.join(", ")))
}

/// What was found and may be an error of the law that was learned from the simulation.
pub(super) fn doubtful(diagnosis: &Diagnosis, units: Units) -> Option<String> {
    (!diagnosis.discarded.doubtful.is_empty()).then(|| {
        format!(
            "No larger than the errors of the law that was learned from the simulation, and so not taken for physics: {}. \
             A simulation of the whole recorded motion would decide.",
            explaining(&diagnosis.discarded.doubtful, units)
        )
    })
}

/// What was found and is below the least effect.
pub(super) fn negligible(diagnosis: &Diagnosis, units: Units) -> Option<String> {
    (!diagnosis.discarded.negligible.is_empty()).then(|| {
        format!("Below the least effect, and not modelled: {}.", explaining(&diagnosis.discarded.negligible, units))
    })
}

/// Effects with the root mean square of what each explains.
fn explaining(effects: &[(EffectId, f64)], units: Units) -> String {
    let named = |(effect, explained): &(EffectId, f64)| {
        format!("{} ({})", plain_name(*effect), quantity(*explained, units.actuator))
    };
    effects.iter().map(named).collect::<Vec<_>>().join(", ")
}

/// What became of effects, with their names; `None` without any.
pub(super) fn listed(what: &str, effects: &[EffectId]) -> Option<String> {
    let names: Vec<&str> = effects.iter().map(|effect| plain_name(*effect)).collect();
    (!names.is_empty()).then(|| format!("{what}: {}.", names.join(", ")))
}
