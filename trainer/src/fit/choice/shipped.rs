//! The law that was chosen, refitted to all rows.

use super::choose::Trial;
use super::physical::Violation;
use super::rivals::no_image;
use super::turn::Turn;
use crate::error::Result;
use crate::fit::data::gather::Material;
use crate::fit::laws::builder::Builder;
use crate::fit::laws::learn::TrainedNetwork;
use crate::fit::laws::simple::{Simple, simple};
use crate::fit::model::HostModel;
use crate::fit::options::Options;
use crate::fit::outcome::Form;
use crate::law::{FormFit, LawData};
use crate::samples::blocks::Split;

/// The law refitted to all rows may leave this much more of them, as a ratio of mean squares, than the one that was compared.
const WORSE_SHARE: f64 = 1.05;
/// The law that goes into the image, with the formula that is told of it.
pub(in crate::fit) struct Shipped {
    pub(in crate::fit) model: Box<HostModel>,
    pub(in crate::fit) fit: FormFit,
}

/// Refits the chosen form to all rows. Where that does worse on the recorded rows than what the choice was made by, or breaks
/// physics where the other did not, the latter is taken.
pub(in crate::fit) fn shipped(
    builder: &Builder<'_>,
    form: Form,
    first: &Turn,
    found: FormFit,
    learnt: &TrainedNetwork,
    data: &LawData,
    options: &Options,
) -> Result<Shipped> {
    let of = |fit: FormFit| builder.expression(&fit).map(|model| Shipped { model, fit });
    let (last, compared_fit) = match form {
        Form::Network => (builder.table(learnt).map(|model| Shipped { model, fit: found.clone() }), Some(found)),
        Form::Found => (of(found), Some(first.found.open.clone())),
        Form::Simple | Form::SimpleAsFitted => {
            let (sound, free) = simple(data);
            let pick = |sound: Option<Simple>, free: Option<Simple>| {
                let chosen = if form == Form::Simple { sound } else { free.or(sound) };
                chosen.map(|simple| simple.fit)
            };
            let [held_sound, held_free] = first.simple.clone();
            (pick(sound, free).and_then(of), pick(held_sound, held_free))
        }
    };
    let compared = first.models[form.place()].clone().zip(compared_fit).map(|(model, fit)| Shipped { model, fit });
    let material = builder.material;
    let is_better = |held: &Shipped, last: &Shipped| {
        let breaks = |shipped: &Shipped| Violation::of(&shipped.model, material).is_any();
        on_all_rows(&last.model, material) > WORSE_SHARE * on_all_rows(&held.model, material)
            || breaks(last) && !breaks(held)
    };
    let allowed = last.filter(|last| options.budget.allows(&last.model));
    let kept = allowed.filter(|last| compared.as_ref().is_none_or(|held| !is_better(held, last)));
    kept.or(compared).ok_or_else(no_image)
}

/// Mean square of what a model leaves of the recorded torque.
pub(in crate::fit) fn on_all_rows(model: &HostModel, material: &Material) -> f64 {
    let mut trial = Trial::default();
    match trial.add(model, material, &Split::default()) {
        Ok(()) => trial.mean_square(),
        Err(_) => f64::INFINITY,
    }
}
