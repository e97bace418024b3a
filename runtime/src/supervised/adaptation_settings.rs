//! How far and how fast an adaptation may go: set by the firmware.

/// Largest bound of the level.
const HIGHEST_LEVEL: f32 = 4.0;
/// Largest bound of the viscous part, N m s/rad, and of the offset, N m, and largest trusted torque, N m: beyond any drive's, and its square is
/// far from overflow.
const LARGEST: f32 = 1.0e6;
/// Smallest trusted torque, N m: its square is far from the smallest number.
const SMALLEST: f32 = 1.0e-6;
/// Longest memory, s.
const LONGEST_MEMORY: f32 = 1.0e6;

/// How far the firmware lets the friction differ from the model, and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptationSettings {
    /// Lowest and highest ratio of the friction to that of the model.
    pub(super) level: [f32; 2],
    /// Largest viscous part that is added or taken away, N m s/rad.
    pub(super) viscous: f32,
    /// Largest offset, N m.
    pub(super) offset: f32,
    /// Time constant of forgetting, s of sliding.
    memory: f32,
    /// A residual of this size counts as much as an unknown at its bound, N m.
    pub(super) trusted_torque: f32,
}

/// Which setting of an adaptation cannot be kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum AdaptationError {
    /// The bounds of the level are not `0 <= low <= 1 <= high <= 4`.
    Level,
    /// The bound of the viscous part or of the offset is not between 0 and 1e6.
    Bound,
    /// The memory is not above 0 s and at most 1e6 s.
    Memory,
    /// The trusted torque is not between 1e-6 and 1e6 N m.
    TrustedTorque,
}

impl AdaptationSettings {
    /// `level`: lowest and highest ratio of the friction to that of the model, around 1; `viscous`, N m s/rad, and `offset`, N m: the
    /// largest that is added or taken away, 0 for none; `memory`: time constant of forgetting, s of sliding, a change is followed to a tenth in
    /// three of it; `trusted_torque`: a residual of this size, N m, counts as much as an unknown at its bound: what is smaller is noise.
    ///
    /// # Errors
    /// [`AdaptationError`] where a setting lies outside of its range.
    pub fn new(
        level: [f32; 2],
        [viscous, offset]: [f32; 2],
        memory: f32,
        trusted_torque: f32,
    ) -> Result<Self, AdaptationError> {
        let [low, high] = level;
        if !((0.0..=1.0).contains(&low) && (1.0..=HIGHEST_LEVEL).contains(&high)) {
            return Err(AdaptationError::Level);
        }
        if ![viscous, offset].iter().all(|bound| (0.0..=LARGEST).contains(bound)) {
            return Err(AdaptationError::Bound);
        }
        if !(memory > 0.0 && memory <= LONGEST_MEMORY) {
            return Err(AdaptationError::Memory);
        }
        if !(SMALLEST..=LARGEST).contains(&trusted_torque) {
            return Err(AdaptationError::TrustedTorque);
        }
        Ok(Self { level, viscous, offset, memory, trusted_torque })
    }

    /// Lowest and highest ratio of the friction to that of the model.
    #[must_use]
    pub fn level(&self) -> [f32; 2] {
        self.level
    }

    /// Largest viscous part, N m s/rad, and largest offset, N m.
    #[must_use]
    pub fn bounds(&self) -> [f32; 2] {
        [self.viscous, self.offset]
    }

    /// Time constant of forgetting, s of sliding.
    #[must_use]
    pub fn memory(&self) -> f32 {
        self.memory
    }

    /// The residual that counts as much as an unknown at its bound, N m.
    #[must_use]
    pub fn trusted_torque(&self) -> f32 {
        self.trusted_torque
    }

    /// Largest distance of the level from that of the model.
    pub(super) fn reach(&self) -> f32 {
        let [down, up] = [1.0 - self.level[0], self.level[1] - 1.0];
        if down > up { down } else { up }
    }
}
