//! The improved model of a diagnosis, as an image.

use frikan_shared::image::Image;
use frikan_shared::model::RigidBody;
use frikan_shared::units::Unit;

use super::compare::Compared;
use super::request::Request;
use super::sealed::sealed_score;
use crate::compile::cost::in_floats;
use crate::compile::improved::{Origin, improve};
use crate::diagnose::answer::outcome::Diagnosis;
use crate::diagnose::answer::sealed::SealedScore;
use crate::diagnose::comparison::reference::Comparison;
use crate::error::{Error, Result, codes};
use crate::fit;
use crate::joint::Joint;
use crate::recording::Recording;
use crate::workflow::recordings::units;

/// The improved model of a diagnosis.
#[derive(Clone, Debug)]
pub enum Improvement {
    /// It was made.
    Written(Written),
    /// It cannot be written as an image.
    Refused(Error),
    /// The measurement has to be put right first.
    Blocked,
}

impl Improvement {
    /// How much better the image is on rows that decided nothing.
    pub(super) fn sealed(&self) -> Option<&SealedScore> {
        match self {
            Self::Written(written) => written.sealed.as_ref(),
            Self::Refused(_) | Self::Blocked => None,
        }
    }
}

/// An improved image, what it holds in sentences, and how much better it is on rows that decided nothing.
#[derive(Clone, Debug)]
pub struct Written {
    /// The image.
    pub image: Vec<u8>,
    /// What it holds, in sentences.
    pub remarks: Vec<String>,
    /// Rigid body of the model compared with, where that is a model.
    pub compared_with: Option<RigidBody>,
    /// How much better it is on rows that decided nothing, where there are such.
    pub sealed: Option<SealedScore>,
}

/// Makes the improved image.
///
/// # Errors
/// `FRK-D020` where no image holds it.
pub(super) fn improved_image(
    request: &Request<'_>,
    (recordings, joint): (&[Recording], &Joint),
    diagnosis: &Diagnosis,
    comparison: &Comparison,
    compared: &Compared,
) -> Result<Written> {
    let mut provenance = fit::model::provenance(joint.name.as_deref().unwrap_or_default(), recordings, request.seed);
    let origin = match compared {
        Compared::Itself(body) => Origin::Recording(**body),
        Compared::Simulation(law, given, _) => Origin::Simulation(diagnosis.law.as_deref().unwrap_or(law), *given),
        Compared::Model(image) => {
            provenance.law_error = image.provenance.law_error;
            provenance.rigid_body_error = image.provenance.rigid_body_error;
            Origin::Model(&image.model)
        }
    };
    let unit = match units(&recordings[0]).actuator {
        "N" => Unit::Newton,
        "A" => Unit::Ampere,
        _ => Unit::NewtonMetre,
    };
    let mut improved = improve(diagnosis, comparison, origin, unit, request.target.unwrap_or_default())
        .map_err(|why| Error::new(&codes::BAD_IMAGE, why.to_string()))?;
    // Of a drive that nobody named there is nothing to say.
    improved.remarks.extend(request.target.and_then(|target| in_floats(target, &improved.model)));
    let image = fit::model::to_bytes(&Image { provenance, model: *improved.model })?;
    // What is scored is what a drive would decode.
    let after = fit::model::from_bytes(&image)?.model;
    let compared_with = improved.compared_with.as_ref().map(|before| before.rigid_body);
    let sealed = improved
        .compared_with
        .and_then(|before| sealed_score(&diagnosis.sealed_s, recordings, comparison.signals.period, [&before, &after]));
    Ok(Written { image, remarks: improved.remarks, compared_with, sealed })
}
