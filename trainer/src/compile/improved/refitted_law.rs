//! The base law after a refit: its friction over velocity, and the form in which an image holds it.

use super::moved_formula::{MovedFormula, moved_formula};
use super::origin::{Friction, Origin};
use crate::compile::host_model::HostModel;
use crate::diagnose::comparison::columns::{BaseKind, friction_basis};
use crate::diagnose::comparison::from_model::{Movement, hats, is_odd, law_at, mean_measurement, movement};
use crate::diagnose::proof::refit::Refit;
use crate::physics::JointState;
use frikan_shared::effect::Effect;

/// A base law after a refit.
pub(super) struct RefittedLaw<'a> {
    /// Its friction over velocity.
    pub(super) friction: Friction<'a>,
    /// How an image holds it; `None` where it is no model: then the friction is that before the refit.
    pub(super) form: Option<Form>,
}

/// How an image holds a law.
pub(super) enum Form {
    /// As a table of the friction over velocity.
    Table,
    /// As a formula or a network, with the Coulomb and viscous friction that stands beside it.
    Model(Box<HostModel>, Option<Effect>),
}

/// The base of a diagnosis after a refit; `places` are those of a formula's constants that move.
pub(super) fn refitted_law<'a>(
    base: BaseKind,
    refit: &'a Refit,
    (origin, places): (Origin<'a>, &[usize]),
    state: &JointState,
) -> RefittedLaw<'a> {
    let (eps, top) = (state.sign_velocity, state.top_speed());
    let sign = move |velocity: f64| (velocity / eps).tanh();
    let sum = |basis: Vec<f64>| -> f64 { basis.iter().zip(&refit.base).map(|(b, c)| b * c).sum() };
    let law = |friction: Friction<'a>, form| RefittedLaw { friction, form };
    let table = |friction| law(friction, Some(Form::Table));
    let model = match origin {
        Origin::Recording(_) => return table(Box::new(move |v| sum(friction_basis(base, v, sign(v), top)))),
        Origin::Simulation(law, _) => return table(Box::new(move |v| law.friction(v) + sum(vec![sign(v), v]))),
        Origin::Model(model) => model,
    };
    let mean = mean_measurement(state);
    match movement(model) {
        Movement::Constants => match moved_formula(model, places, &refit.base, state) {
            Some(MovedFormula::Formula(moved)) => {
                let form = Form::Model(moved.clone(), None);
                law(Box::new(move |v| law_at(&moved, &mean, v)), Some(form))
            }
            Some(MovedFormula::Curve(tangent)) => table(Box::new(move |v| tangent.at(v))),
            None => law(Box::new(move |v| law_at(model, &mean, v)), None),
        },
        Movement::Curve => {
            let is_odd = is_odd(&model.law);
            table(Box::new(move |v| law_at(model, &mean, v) + sum(hats(v, eps, top, is_odd))))
        }
        Movement::Beside => {
            let moved = |place: usize| refit.base.get(place).copied().unwrap_or(0.0) as f32;
            let beside = Effect::Coulomb { coulomb: moved(0), viscous: moved(1), smoothing_velocity: eps as f32 };
            let form = Form::Model(Box::new(model.clone()), Some(beside));
            law(Box::new(move |v| law_at(model, &mean, v) + sum(vec![sign(v), v])), Some(form))
        }
    }
}
