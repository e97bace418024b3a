//! The classical friction laws, fitted as they stand.

use rayon::prelude::*;

use crate::law::fitting::problem::{Effort, Fit, Held, Problem};
use crate::law::judge::choice::{held_out_mean_square, is_itself};
use crate::law::judge::criterion::{Evidence, correlation_length};
use crate::law::judge::description::{Law, NuisanceCoefficient, describe, nuisance_coefficients};
use crate::law::judge::rounding::rounded;
use crate::law::judge::uncertainty::{Interval, Uncertainty, analyse};
use crate::law::judge::undetermined::fix_smoothing;
use crate::law::model::data::{LawData, LawError};
use crate::law::model::ranges::Extents;
use crate::law::model::structure::{Nonlinear, Shape, SignForm, Structure, Term};

/// Parts into which the blocks are grouped for holding out.
const FOLDS: usize = 5;
/// Places of a grid that are gone on from.
const GRID_STARTS: usize = 3;

/// A friction law of the literature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum KnownForm {
    /// Coulomb (1785).
    Coulomb,
    /// Coulomb with static friction below a breakaway velocity.
    CoulombStatic,
    /// Coulomb and viscous friction.
    CoulombViscous,
    /// Stribeck effect (Tustin 1947) without viscous friction.
    StribeckDry,
    /// Bengisu & Akay (1994).
    BengisuAkay,
    /// Awrejcewicz, Grzelczyk & Pyryev (2008), as its envelope over velocity.
    Awrejcewicz,
    /// Stribeck effect with exponential decline and viscous friction: the reference law.
    Stribeck,
    /// Stribeck effect with Gaussian decline and viscous friction (Armstrong-Hélouvry 1991).
    StribeckGaussian,
    /// Stribeck effect with a free exponent and viscous friction (Bo & Pavelescu 1982).
    StribeckExponent,
    /// Coulomb and viscous friction that differ between the directions.
    AsymmetricCoulombViscous,
    /// Coulomb friction and a power of the speed.
    PowerLaw,
    /// Coulomb friction smoothed by the arc tangent, with viscous friction.
    ArctanCoulombViscous,
}

impl KnownForm {
    /// All of them, the paper's six first.
    pub const ALL: [Self; 12] = [
        Self::Coulomb,
        Self::CoulombStatic,
        Self::CoulombViscous,
        Self::StribeckDry,
        Self::BengisuAkay,
        Self::Awrejcewicz,
        Self::Stribeck,
        Self::StribeckGaussian,
        Self::StribeckExponent,
        Self::AsymmetricCoulombViscous,
        Self::PowerLaw,
        Self::ArctanCoulombViscous,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Coulomb => "Coulomb",
            Self::CoulombStatic => "Coulomb with static friction",
            Self::CoulombViscous => "Coulomb and viscous",
            Self::StribeckDry => "Stribeck without viscous",
            Self::BengisuAkay => "Bengisu-Akay",
            Self::Awrejcewicz => "Awrejcewicz",
            Self::Stribeck => "Stribeck",
            Self::StribeckGaussian => "Stribeck, Gaussian",
            Self::StribeckExponent => "Stribeck, free exponent",
            Self::AsymmetricCoulombViscous => "asymmetric Coulomb and viscous",
            Self::PowerLaw => "Coulomb and power law",
            Self::ArctanCoulombViscous => "arctangent Coulomb and viscous",
        }
    }

    /// Its name on the command line.
    pub fn key(self) -> &'static str {
        match self {
            Self::Coulomb => "coulomb",
            Self::CoulombStatic => "coulomb-static",
            Self::CoulombViscous => "coulomb-viscous",
            Self::StribeckDry => "stribeck-dry",
            Self::BengisuAkay => "bengisu-akay",
            Self::Awrejcewicz => "awrejcewicz",
            Self::Stribeck => "stribeck",
            Self::StribeckGaussian => "stribeck-gaussian",
            Self::StribeckExponent => "stribeck-exponent",
            Self::AsymmetricCoulombViscous => "asymmetric",
            Self::PowerLaw => "power-law",
            Self::ArctanCoulombViscous => "arctangent",
        }
    }

    /// The form of such a name.
    pub fn named(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|form| form.key() == key)
    }

    /// Its structure.
    pub fn structure(self) -> Structure {
        use Shape::{
            AbsSign, AbsViscous, Breakaway, Sign, SignPower, StribeckExponential, StribeckGaussian, StribeckPower,
            Viscous,
        };
        let (sign, shapes): (SignForm, &[Shape]) = match self {
            Self::Coulomb => (SignForm::Tanh, &[Sign]),
            Self::CoulombStatic => (SignForm::Tanh, &[Sign, Breakaway]),
            Self::CoulombViscous => (SignForm::Tanh, &[Sign, Viscous]),
            Self::StribeckDry => (SignForm::Tanh, &[Sign, StribeckExponential]),
            Self::BengisuAkay => (SignForm::Parabolic, &[Sign, StribeckExponential]),
            Self::Awrejcewicz => (SignForm::Cubic, &[Sign, StribeckExponential]),
            Self::Stribeck => (SignForm::Tanh, &[Sign, StribeckExponential, Viscous]),
            Self::StribeckGaussian => (SignForm::Tanh, &[Sign, StribeckGaussian, Viscous]),
            Self::StribeckExponent => (SignForm::Tanh, &[Sign, StribeckPower, Viscous]),
            Self::AsymmetricCoulombViscous => (SignForm::Tanh, &[Sign, Viscous, AbsSign, AbsViscous]),
            Self::PowerLaw => (SignForm::Tanh, &[Sign, SignPower]),
            Self::ArctanCoulombViscous => (SignForm::Arctan, &[Sign, Viscous]),
        };
        Structure::new(sign, shapes.iter().copied().map(Term::plain))
    }
}

/// A fitted form.
#[derive(Clone, Debug)]
pub struct FormFit {
    /// The law with named constants and intervals.
    pub law: Law,
    /// Standard errors and identifiability in the order of the law's parameters.
    pub uncertainty: Uncertainty,
    /// Coefficients of the nuisance columns.
    pub nuisance: Vec<NuisanceCoefficient>,
    /// Root mean square of the residuals, unit of the target.
    pub rmse: f64,
    /// Bayesian information criterion (Schwarz 1978) with the effective number of samples; lower is better.
    pub bic: f64,
    /// Whether the optimiser ended at a minimum.
    pub converged: bool,
}

/// Fits one form by least squares from a grid of starts. `smoothing` fixes the constant of the smoothed sign (`k` of
/// `tanh(k v)`, unit 1/velocity) where it is known.
///
/// # Errors
/// When the data cannot be fitted at all, see [`LawError`].
pub fn fit_form(form: KnownForm, data: &LawData, smoothing: Option<f64>) -> Result<FormFit, LawError> {
    fit_structure(&form.structure(), data, smoothing)
}

/// [`fit_form`] for any structure.
///
/// # Errors
/// When the data cannot be fitted at all, see [`LawError`].
pub fn fit_structure(structure: &Structure, data: &LawData, smoothing: Option<f64>) -> Result<FormFit, LawError> {
    let extents = Extents::new(data)?;
    let problem = check(structure, data, &extents)?;
    let held: Vec<Nonlinear> = smoothing.map(|_| Nonlinear::Smoothing).into_iter().collect();
    let fit = from_grid(&problem, structure, smoothing, Effort::FINAL);
    Ok(described(&problem, &fit, &held, Interval::Profile))
}

/// Fits a structure from non-linear constants that other samples of the same joint gave it.
///
/// # Errors
/// When the data cannot be fitted at all, see [`LawError`].
pub fn refit_structure(
    structure: &Structure,
    constants: &[f64],
    data: &LawData,
    intervals: Interval,
) -> Result<FormFit, LawError> {
    let extents = Extents::new(data)?;
    let problem = check(structure, data, &extents)?;
    let fit = problem.fit_from(structure, constants, Held::default(), Effort::FINAL);
    Ok(described(&problem, &fit, &[], intervals))
}

/// What the best fit of a structure leaves.
#[derive(Clone, Debug)]
pub struct Remainder {
    /// Mean square, squared unit of the target.
    pub mean_square: f64,
    /// Samples over which it is correlated.
    pub correlation_length: f64,
    /// Whether the optimiser ended at a minimum where the law is itself: no constant at the end of its range, no negative Coulomb torque.
    pub converged: bool,
    /// The non-linear constants, in the order of [`Structure::nonlinear`].
    pub constants: Vec<f64>,
}

/// What a structure leaves of the data at its best, looked for from non-linear constants where they are given, else from a grid; nothing is said of
/// how well they are known.
///
/// # Errors
/// When the data cannot be fitted at all, see [`LawError`].
pub fn remainder(structure: &Structure, data: &LawData, constants: Option<&[f64]>) -> Result<Remainder, LawError> {
    let extents = Extents::new(data)?;
    let problem = check(structure, data, &extents)?;
    let fit = match constants {
        Some(constants) => problem.fit_from(structure, constants, Held::default(), Effort::COMPARISON),
        None => from_grid(&problem, structure, None, Effort::COMPARISON),
    };
    Ok(Remainder {
        mean_square: fit.rss / data.rows() as f64,
        correlation_length: correlation_length(&problem.residuals(&fit)),
        converged: fit.converged && is_itself(&problem, &fit),
        constants: fit.constants().to_vec(),
    })
}

/// Fits a structure from non-linear constants that other samples of the same joint gave it, with the smoothing of the sign fixed where the data
/// cannot tell it from a step, and what is to be said of that.
///
/// # Errors
/// When the data cannot be fitted at all, see [`LawError`].
pub fn settle(
    structure: &Structure,
    constants: &[f64],
    data: &LawData,
    intervals: Interval,
) -> Result<(FormFit, Vec<String>), LawError> {
    let extents = Extents::new(data)?;
    let problem = check(structure, data, &extents)?;
    let free = problem.fit_from(structure, constants, Held::default(), Effort::FINAL);
    let evidence = Evidence::of(&problem, correlation_length(&problem.residuals(&free)));
    let mut remarks = Vec::new();
    let (fit, held) = fix_smoothing(&problem, free, evidence, &mut remarks);
    Ok((described(&problem, &fit, &held, intervals), remarks))
}

/// The problem, where the data are enough for the structure.
fn check<'a>(structure: &Structure, data: &'a LawData, extents: &'a Extents) -> Result<Problem<'a>, LawError> {
    let needed = structure.constants() + data.nuisance.len() + 1;
    if data.rows() < needed {
        return Err(LawError::TooFewSamples { samples: data.rows(), constants: needed });
    }
    Ok(Problem::new(data, extents))
}

/// The best fit from a grid of starts.
fn from_grid(problem: &Problem<'_>, structure: &Structure, smoothing: Option<f64>, effort: Effort) -> Fit {
    let known: Vec<(Nonlinear, f64)> = smoothing.map(|k| (Nonlinear::Smoothing, k)).into_iter().collect();
    let held: Vec<Nonlinear> = known.iter().map(|(n, _)| *n).collect();
    let holding = Held { nonlinear: &held, coefficient: None };
    let rough = problem.fit_grid(structure, &known, holding, GRID_STARTS, Effort::SEARCH);
    problem.fit_from(structure, rough.constants(), holding, effort)
}

/// A fit with names, intervals and scores, constants in `held` being given.
fn described(problem: &Problem<'_>, fit: &Fit, held: &[Nonlinear], intervals: Interval) -> FormFit {
    let rows = problem.rows() as f64;
    let uncertainty = analyse(problem, fit, held, intervals);
    let fit = rounded(problem, fit, &uncertainty);
    let effective = rows / uncertainty.correlation_length;
    let free = fit.structure.constants() - held.len() + problem.data().nuisance.len();
    let mean_square = fit.rss / rows;
    FormFit {
        law: describe(problem, &fit, &uncertainty, held),
        nuisance: nuisance_coefficients(problem, &fit, &uncertainty),
        rmse: mean_square.sqrt(),
        bic: effective * libm::log(mean_square.max(f64::MIN_POSITIVE)) + libm::log(effective) * free as f64,
        converged: fit.converged,
        uncertainty,
    }
}

/// Fits every form and ranks them by held-out likelihood, each constant paying what the Bayesian criterion asks of it beyond
/// what holding out has already cost; best first.
///
/// # Errors
/// When the data cannot be fitted at all, see [`LawError`].
pub fn rank_forms(data: &LawData) -> Result<Vec<(KnownForm, FormFit)>, LawError> {
    let extents = Extents::new(data)?;
    let fitted = |form: &KnownForm| {
        let problem = check(&form.structure(), data, &extents)?;
        let fit = from_grid(&problem, &form.structure(), None, Effort::FINAL);
        let held_out = held_out_mean_square(&problem, &fit, Held::default(), FOLDS);
        Ok((*form, described(&problem, &fit, &[], Interval::Profile), held_out))
    };
    let fits: Vec<(KnownForm, FormFit, f64)> =
        KnownForm::ALL.par_iter().map(fitted).collect::<Result<_, LawError>>()?;
    let length = fits.iter().map(|(_, fit, _)| fit.uncertainty.correlation_length).fold(f64::INFINITY, f64::min);
    let effective = data.rows() as f64 / length;
    let each = (0.5 * libm::log(effective) - 1.0).max(0.0);
    let score = |form: KnownForm, held_out: f64| {
        0.5 * effective * libm::log(held_out.max(f64::MIN_POSITIVE)) + each * form.structure().constants() as f64
    };
    let mut ranked: Vec<(f64, (KnownForm, FormFit))> =
        fits.into_iter().map(|(form, fit, held_out)| (score(form, held_out), (form, fit))).collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(ranked.into_iter().map(|(_, f)| f).collect())
}
