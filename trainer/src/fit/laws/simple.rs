//! The simple model, which is always fitted: rigid body, Coulomb and viscous friction, offset. Any other law has to beat it.

use super::formula::thinned;
use crate::fit::data::rigid;
use crate::law::{FormFit, LawData, Shape, SignForm, Structure, Term, fit_structure};
use crate::samples::top_speed;

/// Most samples that its constants are fitted to.
const MOST_SAMPLES: usize = 12_000;
/// Where the smoothed sign has three quarters of its height, as a share of the top speed, unless the data say.
const SIGN_WIDTH: f64 = 0.02;

/// Which terms the simple model has; fewer where more would have the wrong sign.
#[derive(Clone, Debug)]
pub(in crate::fit) struct SimpleForm {
    structure: Structure,
    with_inertia: bool,
    smoothing: Option<f64>,
}

/// The simple model fitted to some of the rows.
#[derive(Clone, Debug)]
pub(in crate::fit) struct Simple {
    pub(in crate::fit) form: SimpleForm,
    pub(in crate::fit) fit: FormFit,
}

impl SimpleForm {
    /// Every form: Coulomb and viscous, then only one of them; with and without inertia; the sign as smooth as usual, and as
    /// smooth as the data say.
    fn all(top_speed: f64) -> Vec<Self> {
        let structures: [&[Shape]; 3] = [&[Shape::Sign, Shape::Viscous], &[Shape::Sign], &[Shape::Viscous]];
        let usual = Some(1.0 / (SIGN_WIDTH * top_speed).max(f64::MIN_POSITIVE));
        let mut all = Vec::new();
        for shapes in structures {
            let structure = Structure::new(SignForm::Tanh, shapes.iter().copied().map(Term::plain));
            let smooth: &[Option<f64>] = if shapes[0] == Shape::Sign { &[usual, None] } else { &[None] };
            for with_inertia in [true, false] {
                let form = |smoothing: &Option<f64>| Self {
                    structure: structure.clone(),
                    with_inertia,
                    smoothing: *smoothing,
                };
                all.extend(smooth.iter().map(form));
            }
        }
        all
    }

    /// Fits this form to `data`, whose first channel is the velocity; `None` where it cannot be fitted.
    pub(in crate::fit) fn fit(&self, data: &LawData) -> Option<Simple> {
        let mut own = thinned(data, MOST_SAMPLES);
        own.channels.truncate(1);
        let place = own.nuisance.iter().position(|column| rigid::is_inertia(&column.name));
        let left_out = place.filter(|_| !self.with_inertia);
        if let Some(place) = left_out {
            own.nuisance.remove(place);
        }
        let mut fit = fit_structure(&self.structure, &own, self.smoothing).ok()?;
        if let Some(place) = left_out {
            fit.uncertainty.nuisance.insert(place, (0.0, 0.0));
        }
        Some(Simple { form: self.clone(), fit })
    }
}

/// The best simple model of those in which no sign is wrong, and the best of all where a sign of that one is wrong. They differ by
/// one or two constants, so that the error on the rows themselves decides.
pub(in crate::fit) fn simple(data: &LawData) -> (Option<Simple>, Option<Simple>) {
    let velocity = data.channels.first().map(|channel| channel.values.as_slice()).unwrap_or_default();
    let top_speed = top_speed(velocity);
    let has_inertia = data.nuisance.iter().any(|column| rigid::is_inertia(&column.name));
    let forms = SimpleForm::all(top_speed).into_iter().filter(|form| form.with_inertia || has_inertia);
    let mut free: Option<Simple> = None;
    let mut sound: Option<Simple> = None;
    for form in forms {
        let full = form.structure.terms().len() == 2 && (form.with_inertia || !has_inertia);
        // Fewer terms are only looked at where more have the wrong sign.
        if !full && sound.is_some() && free.as_ref().is_some_and(|free| free.has_right_signs(data)) {
            break;
        }
        let Some(candidate) = form.fit(data) else { continue };
        let better = |held: &Option<Simple>| held.as_ref().is_none_or(|held| candidate.fit.rmse < held.fit.rmse);
        if candidate.has_right_signs(data) && better(&sound) {
            sound = Some(candidate.clone());
        }
        if full && better(&free) {
            free = Some(candidate);
        }
    }
    let free = free.filter(|free| !free.has_right_signs(data));
    (sound, free)
}

impl Simple {
    /// Whether inertia, Coulomb and viscous friction are all zero or above.
    fn has_right_signs(&self, data: &LawData) -> bool {
        let inertia = data.nuisance.iter().position(|column| rigid::is_inertia(&column.name));
        let inertia = inertia.and_then(|index| self.fit.uncertainty.nuisance.get(index)).map_or(0.0, |pair| pair.0);
        let linear = &self.fit.law.parameters[self.form.structure.nonlinear().len()..];
        inertia >= 0.0 && linear.iter().all(|parameter| parameter.value >= 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::{Channel, ChannelRole, Nuisance};
    use crate::samples::rigid_body::TermKind;

    fn data(inertia: f64, viscous: f64) -> LawData {
        let n = 3000;
        let at = |i: usize| i as f64 * 0.01;
        let velocity: Vec<f64> = (0..n).map(|i| at(i).sin() + 0.4 * (2.7 * at(i)).sin()).collect();
        let acceleration: Vec<f64> = (0..n).map(|i| at(i).cos() + 1.08 * (2.7 * at(i)).cos()).collect();
        let noise = |i: usize| 0.05 * ((i * i) as f64 * 0.7).sin();
        let torque =
            |i: usize| (velocity[i] / 0.02).tanh() + viscous * velocity[i] + inertia * acceleration[i] + noise(i);
        LawData {
            target: (0..n).map(torque).collect(),
            channels: vec![Channel {
                name: "velocity".into(),
                unit: "rad/s".into(),
                role: ChannelRole::Velocity,
                values: velocity,
            }],
            target_unit: "N m".into(),
            nuisance: vec![Nuisance {
                name: TermKind::Inertia.name().into(),
                unit: "kg m²".into(),
                values: acceleration,
            }],
            states: None,
            blocks: (0..n).map(|i| i / 100).collect(),
        }
    }

    #[test]
    fn the_simple_model_comes_back_and_nothing_else_is_offered() {
        let (sound, free) = simple(&data(0.5, 0.7));
        let sound = sound.unwrap();
        assert!(free.is_none());
        assert!((sound.fit.uncertainty.nuisance[0].0 / 0.5 - 1.0).abs() < 0.01);
        let viscous = sound.fit.law.parameters.last().unwrap();
        assert!((viscous.value / 0.7 - 1.0).abs() < 0.05, "{viscous:?}");
    }

    #[test]
    fn wrong_signs_are_offered_beside_the_best_model_that_has_none() {
        let (sound, free) = simple(&data(-0.5, 0.7));
        let (sound, free) = (sound.unwrap(), free.unwrap());
        assert_eq!(sound.fit.uncertainty.nuisance, [(0.0, 0.0)]);
        assert!((free.fit.uncertainty.nuisance[0].0 / -0.5 - 1.0).abs() < 0.01);
        assert!(free.fit.rmse < 0.5 * sound.fit.rmse);
    }
}
