//! Supervision as C calls it: a supervisor beside a compensator that was started, with memory of its own.

use frikan_runtime::compensator::{Compensate, Compensation, Limits};
use frikan_runtime::measurement::Measurement;
use frikan_runtime::supervised::adaptation::Correction;
use frikan_runtime::supervised::adaptation_settings::AdaptationSettings;
use frikan_runtime::supervised::{Sample, Supervised, Supervision, Supervisor};

use crate::ffi::{FrikanCompensator, Inner};
use crate::memory::{self, Memory, content};
use crate::types::{FrikanMeasurement, FrikanStatus};

/// Words of a supervisor's memory.
pub const FRIKAN_SUPERVISOR_WORDS: usize = 40;

/// What watches a compensator. Its memory is the firmware's; its content is the library's. One that lies in zeroed memory gives no torque
/// until it is started.
#[repr(C)]
pub struct FrikanSupervisor {
    /// Whether there is a supervisor in the memory.
    started: u32,
    /// Its memory.
    storage: [u64; FRIKAN_SUPERVISOR_WORDS],
}

const _: () =
    assert!(size_of::<Supervisor>() <= 8 * FRIKAN_SUPERVISOR_WORDS && align_of::<Supervisor>() <= align_of::<u64>());

// SAFETY: both fields lie in the memory; size and alignment are asserted above.
unsafe impl Memory for FrikanSupervisor {
    type Content = Supervisor;
    const MARK: u32 = u32::from_le_bytes(*b"FRKS");

    fn parts(memory: *mut Self) -> (*mut u32, *mut Supervisor) {
        // SAFETY: places of fields, nothing is read.
        unsafe { (&raw mut (*memory).started, (&raw mut (*memory).storage).cast()) }
    }
}

/// A compensator to be supervised.
struct Started<'a> {
    inner: &'a mut Inner,
    starts: u32,
}

impl Compensate for Started<'_> {
    fn limits(&self) -> &Limits {
        self.inner.limits()
    }

    fn changes(&self) -> u32 {
        self.starts
    }

    fn step(&mut self, measurement: &Measurement, dt: f32) -> Compensation {
        self.inner.step(measurement, dt)
    }
}

/// The compensator in a memory, where it was started.
///
/// # Safety
/// As [`content`].
unsafe fn started<'a>(memory: *mut FrikanCompensator) -> Option<Started<'a>> {
    // SAFETY: the caller's word; the second is read where the memory was started.
    unsafe {
        let inner = content(memory)?;
        Some(Started { inner, starts: (&raw const (*memory).starts).read() })
    }
}

/// How far the compensation may follow a friction that changes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct FrikanAdaptation {
    /// Lowest ratio of the friction to that of the model, 0 to 1.
    pub lowest_level: f32,
    /// Highest ratio, 1 to 4.
    pub highest_level: f32,
    /// Largest viscous part that is added or taken away, N m s/rad; 0 for none.
    pub viscous: f32,
    /// Largest offset, N m; 0 for none.
    pub offset: f32,
    /// Time constant of forgetting, s of sliding; 0 for no adaptation at all.
    pub memory: f32,
    /// A residual of this size, N m, counts as much as a value at its bound: what is smaller is noise.
    pub trusted_torque: f32,
}

/// Settings of the supervision, from frikan_supervision. Inertia, count and turn are from 0 to 1e9, the others from 1e-9 to 1e9.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FrikanSupervision {
    /// Inertia of the joint, kg m^2; the largest where frikan_set_inertia tells another.
    pub inertia: f32,
    /// Angle of a count of the encoder, rad; 0 where the position is not made of counts.
    pub count: f32,
    /// Speed of the reference up to which friction is compensated at it, rad/s, and below which the torque is held where it stands still.
    pub rest_velocity: f32,
    /// Speed below which nothing is said of friction: the joint may as well stand still, rad/s.
    pub standstill: f32,
    /// Way after a reversal in which the contact is elastic, rad.
    pub presliding: f32,
    /// Delay of the low-pass behind which the net friction is observed, s; that of a coarse encoder is longer.
    pub observer_time: f32,
    /// Time in which the gain falls from full to none where all friction is over-compensated once more, s.
    pub fall_time: f32,
    /// Time in which it rises again where nothing is compensated, s.
    pub rise_time: f32,
    /// Friction below which no ratios are taken, N m.
    pub least_friction: f32,
    /// How long velocity and position may contradict each other, s.
    pub implausible_time: f32,
    /// How long the torque of a joint at rest is held, s; it falls to 0 within the same time again.
    pub hold_time: f32,
    /// Angle after which the position begins anew, rad; 0 where it never does.
    pub turn: f32,
    /// Whether and how far the compensation follows a friction that changes.
    pub adaptation: FrikanAdaptation,
}

/// One sample.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FrikanSample {
    /// The joint, velocity as measured; the position has to be filled, and without jumps but that of a turn.
    pub measurement: FrikanMeasurement,
    /// Velocity of the reference, rad/s; NaN while no position or velocity loop is closed, as in hand guiding.
    pub reference_velocity: f32,
    /// Torque that acted on the joint since the sample before, N m, without compensation and without the torque for gravity.
    pub loop_torque: f32,
}

/// The answer to a sample.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrikanSupervised {
    /// Torque to add, in the unit of the model's output.
    pub torque: f32,
    /// What the model says of the link's position against the motor's, rad, within the limit.
    pub position: f32,
    /// Share of the gain that the monitor leaves, 0 to 1.
    pub gain_share: f32,
    /// Ratio of the friction to that of the model, as far as it was learnt.
    pub level: f32,
    /// Viscous part beside it, N m s/rad.
    pub viscous: f32,
    /// Offset beside it, N m.
    pub offset: f32,
    /// Whether it is a compensation.
    pub status: FrikanStatus,
}

impl FrikanSupervised {
    const NOT_STARTED: Self = Self {
        torque: 0.0,
        position: 0.0,
        gain_share: 0.0,
        level: 1.0,
        viscous: 0.0,
        offset: 0.0,
        status: FrikanStatus::NotStarted,
    };
}

/// The supervision of a settings struct of C; none where a setting of the adaptation is out of range.
fn supervision(settings: &FrikanSupervision) -> Option<Supervision> {
    let FrikanAdaptation { lowest_level, highest_level, viscous, offset, memory, trusted_torque } = settings.adaptation;
    let adaptation = if memory == 0.0 {
        None
    } else {
        Some(AdaptationSettings::new([lowest_level, highest_level], [viscous, offset], memory, trusted_torque).ok()?)
    };
    Some(Supervision {
        rest_velocity: settings.rest_velocity,
        standstill: settings.standstill,
        presliding: settings.presliding,
        observer_time: settings.observer_time,
        fall_time: settings.fall_time,
        rise_time: settings.rise_time,
        least_friction: settings.least_friction,
        implausible_time: settings.implausible_time,
        hold_time: settings.hold_time,
        turn: settings.turn,
        adaptation,
        ..Supervision::new(settings.inertia, settings.least_friction, settings.count)
    })
}

/// Settings for a revolute joint of `inertia` kg m^2 with a friction of about `friction` N m, whose encoder has counts of `count` rad (2 pi over
/// the counts of a turn, 0 where the position is not made of counts), without adaptation.
#[unsafe(no_mangle)]
pub extern "C" fn frikan_supervision(inertia: f32, friction: f32, count: f32) -> FrikanSupervision {
    let defaults = Supervision::new(inertia, friction, count);
    FrikanSupervision {
        inertia: defaults.inertia,
        count: defaults.count,
        rest_velocity: defaults.rest_velocity,
        standstill: defaults.standstill,
        presliding: defaults.presliding,
        observer_time: defaults.observer_time,
        fall_time: defaults.fall_time,
        rise_time: defaults.rise_time,
        least_friction: defaults.least_friction,
        implausible_time: defaults.implausible_time,
        hold_time: defaults.hold_time,
        turn: defaults.turn,
        adaptation: FrikanAdaptation::default(),
    }
}

/// Starts a supervisor. BadSupervision leaves the memory as it was.
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_supervise(
    supervisor: *mut FrikanSupervisor,
    settings: *const FrikanSupervision,
) -> FrikanStatus {
    // SAFETY: the caller's word.
    let settings = (unsafe { settings.as_ref() }).and_then(supervision);
    let Some(started) = settings.and_then(|settings| Supervisor::new(settings).ok()) else {
        return FrikanStatus::BadSupervision;
    };
    // SAFETY: the caller's word.
    if unsafe { memory::start(supervisor, started) } { FrikanStatus::Active } else { FrikanStatus::NotStarted }
}

/// The compensation under supervision after a sample period of `dt` seconds, in place of frikan_step. Call it at a fixed rate.
///
/// # Safety
/// Pointers are null or good for what their names say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_supervised_step(
    supervisor: *mut FrikanSupervisor,
    compensator: *mut FrikanCompensator,
    sample: *const FrikanSample,
    dt: f32,
) -> FrikanSupervised {
    // SAFETY: the caller's word.
    let (Some(supervisor), Some(mut compensator), Some(sample)) =
        (unsafe { (content(supervisor), started(compensator), sample.as_ref()) })
    else {
        return FrikanSupervised::NOT_STARTED;
    };
    let reference = sample.reference_velocity;
    let sample = Sample {
        measurement: (&sample.measurement).into(),
        reference_velocity: (!reference.is_nan()).then_some(reference),
        loop_torque: sample.loop_torque,
    };
    let answer = supervisor.step(&mut compensator, &sample, dt);
    let Correction { level, viscous, offset } = answer.correction;
    let status = match answer.status {
        Supervised::Compensator(status) => status.into(),
        Supervised::Degraded => FrikanStatus::Degraded,
        Supervised::Implausible => FrikanStatus::Implausible,
    };
    let (torque, position, gain_share) = (answer.torque, answer.position, answer.gain_share);
    FrikanSupervised { torque, position, gain_share, level, viscous, offset, status }
}

/// Another inertia of the joint from now on, kg m^2: of the pose or the payload, in each sample if need be. The torque of an inertia that changes,
/// dJ/dt v / 2, belongs to the loop torque. BadSupervision, where it is not from 0 to 1e9, leaves the one before in force.
///
/// # Safety
/// The pointer is null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_set_inertia(supervisor: *mut FrikanSupervisor, inertia: f32) -> FrikanStatus {
    // SAFETY: the caller's word.
    match unsafe { content(supervisor) }.map(|supervisor| supervisor.set_inertia(inertia)) {
        None => FrikanStatus::NotStarted,
        Some(Err(_)) => FrikanStatus::BadSupervision,
        Some(Ok(())) => FrikanStatus::Active,
    }
}

/// Forgets what the adaptation has learnt, for a joint that was idle for long or has another gear or grease. What was learnt before a compensator was
/// started again is forgotten anyway.
///
/// # Safety
/// The pointer is null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_forget(supervisor: *mut FrikanSupervisor) {
    // SAFETY: the caller's word.
    if let Some(supervisor) = unsafe { content(supervisor) } {
        supervisor.forget();
    }
}

/// Compensates again after FRIKAN_STATUS_IMPLAUSIBLE: for whoever has found out why velocity and position contradicted each other.
///
/// # Safety
/// The pointer is null or good.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frikan_clear_fault(supervisor: *mut FrikanSupervisor) {
    // SAFETY: the caller's word.
    if let Some(supervisor) = unsafe { content(supervisor) } {
        supervisor.clear_fault();
    }
}
