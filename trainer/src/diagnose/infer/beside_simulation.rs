//! The simulation that stands beside a recording in one model.

use crate::diagnose::comparison::base::Base;
use crate::diagnose::comparison::columns::BaseKind;
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::comparison::simulation::InverseLaw;
use crate::diagnose::infer::inferred::Inferred;
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::preparation::states::Prepared;

/// The law of the simulation with the effects that it shows beside its static law; `None` where it shows none.
pub(crate) fn whole_law(comparison: &Comparison, law: Option<&InverseLaw>, inferred: &Inferred) -> Option<InverseLaw> {
    let simulation = comparison.simulation.as_deref()?;
    law?.holding(inferred.shown_by_simulation(), &simulation.signals, inferred.least)
}

/// The simulation behind the filter of the recording, with its base.
pub(crate) fn of_simulation(real: &Prepared, comparison: &Comparison) -> Option<(Prepared, Base)> {
    let simulation = comparison.simulation.as_deref()?;
    let cut_off = real.filter.cut_off_hz;
    let mut prepared = Prepared::at_cut_off(&simulation.signals, cut_off, simulation.known(), Lock::Nothing);
    prepared.state.turn_over_at(real.state.sign_lead_s, real.state.sign_velocity);
    let base = Base::fit(&mut prepared, simulation, BaseKind::Reference)?;
    Some((prepared, base))
}

/// Friction of the joint turns over as softly as that of its simulation, which has no noise: where this is Coulomb and viscous friction
/// with a smoothed sign, the width of the sign is the joint's own and that of every effect of friction.
pub(crate) fn turn_over_as_simulated(real: &mut Prepared, comparison: &Comparison) {
    if let (Some(law), Some(_)) = (&comparison.reference, &comparison.simulation) {
        real.state.turn_over_at(law.sign_lead_s, law.sign_width.max(real.state.sign_velocity));
    }
}
