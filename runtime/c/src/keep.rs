//! What outlives a loss of power where the firmware keeps it: warmth and what was learnt.

#[cfg(feature = "models")]
use frikan_runtime::friction::Warmth;
#[cfg(feature = "supervised")]
use frikan_runtime::supervised::adaptation::Learnt;

#[cfg(feature = "models")]
use crate::ffi::FrikanCompensator;
use crate::memory::content;
#[cfg(feature = "supervised")]
use crate::supervised::FrikanSupervisor;

/// Effects of a model.
#[cfg(feature = "models")]
pub const FRIKAN_EFFECTS: usize = 8;

#[cfg(feature = "models")]
const _: () = assert!(FRIKAN_EFFECTS == frikan_runtime::shared::effect::MAX_EFFECTS);

/// How warm a joint is that has no temperature sensor: numbers to be kept anywhere, with the checksum of the image that they belong to.
#[cfg(feature = "models")]
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrikanWarmth {
    /// Filtered dissipated power by the place of the effect, W.
    pub power: [f32; FRIKAN_EFFECTS],
}

/// The warmth of a joint; cold where there is no model.
///
/// # Safety
/// The pointer is null or good.
#[cfg(feature = "models")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_warmth(compensator: *mut FrikanCompensator) -> FrikanWarmth {
    // SAFETY: the caller's word.
    let warmth = unsafe { content(compensator) }.and_then(|compensator| compensator.source()?.warmth());
    warmth.map_or_else(FrikanWarmth::default, |Warmth { power }| FrikanWarmth { power })
}

/// As frikan_reset, and as warm as `warmth` is after a rest of so many seconds; of a rest that nobody measured, 0 is the safe guess. Damaged numbers do
/// no harm.
///
/// # Safety
/// Pointers are null or good.
#[cfg(feature = "models")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_restore(compensator: *mut FrikanCompensator, warmth: *const FrikanWarmth, rest: f32) {
    // SAFETY: the caller's word.
    if let (Some(compensator), Some(warmth)) = unsafe { (content(compensator), warmth.as_ref()) } {
        compensator.reset_by(|model| model.restore(&Warmth { power: warmth.power }, rest));
    }
}

/// What the adaptation of a supervisor has learnt: numbers to be kept anywhere, with the checksum of the image that they belong to.
#[cfg(feature = "supervised")]
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrikanLearnt {
    /// Mean products, (N m)^2.
    pub means: [f32; 9],
}

/// What a supervisor has learnt.
///
/// # Safety
/// The pointer is null or good.
#[cfg(feature = "supervised")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_learnt(supervisor: *mut FrikanSupervisor) -> FrikanLearnt {
    // SAFETY: the caller's word.
    let learnt = unsafe { content(supervisor) }.map(|supervisor| supervisor.learnt());
    learnt.map_or_else(FrikanLearnt::default, |Learnt { means }| FrikanLearnt { means })
}

/// Goes on with what was learnt on the same image, after frikan_supervise and before the first step. Damaged numbers do no harm.
///
/// # Safety
/// Pointers are null or good.
#[cfg(feature = "supervised")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_restore_learnt(supervisor: *mut FrikanSupervisor, learnt: *const FrikanLearnt) {
    // SAFETY: the caller's word.
    if let (Some(supervisor), Some(learnt)) = unsafe { (content(supervisor), learnt.as_ref()) } {
        supervisor.restore(&Learnt { means: learnt.means });
    }
}
