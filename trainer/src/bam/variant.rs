//! The six friction models of BAM, M1 to M6 (Duclusaud et al. 2024), and the parameters of each.

/// A friction model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// Coulomb and viscous friction.
    M1,
    /// With a Stribeck peak.
    M2,
    /// With friction of the torque that the gear carries.
    M3,
    /// With both, the peak growing with that torque.
    M4,
    /// With shares of their own for the motor's torque and that from outside.
    M5,
    /// With what grows with the square of the smaller of the two, where they oppose each other.
    M6,
}

/// Friction of the torques at the gear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadFriction {
    /// Of `|external - motor|`.
    Gear,
    /// Of `|load_friction_external external - load_friction_motor motor|`.
    Directional,
}

impl Variant {
    /// Every model.
    pub const ALL: [Self; 6] = [Self::M1, Self::M2, Self::M3, Self::M4, Self::M5, Self::M6];

    /// Its name in a file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::M1 => "m1",
            Self::M2 => "m2",
            Self::M3 => "m3",
            Self::M4 => "m4",
            Self::M5 => "m5",
            Self::M6 => "m6",
        }
    }

    /// Whether friction is larger at rest.
    #[must_use]
    pub fn has_peak(self) -> bool {
        !matches!(self, Self::M1 | Self::M3)
    }

    /// Its friction of torques.
    #[must_use]
    pub fn load(self) -> Option<LoadFriction> {
        match self {
            Self::M1 | Self::M2 => None,
            Self::M3 | Self::M4 => Some(LoadFriction::Gear),
            Self::M5 | Self::M6 => Some(LoadFriction::Directional),
        }
    }

    /// The parameters of its friction.
    #[must_use]
    pub fn keys(self) -> Vec<&'static str> {
        let mut keys = vec!["friction_base", "friction_viscous"];
        if self.has_peak() {
            keys.extend(["friction_stribeck", "dtheta_stribeck", "alpha"]);
        }
        match self.load() {
            None => {}
            Some(LoadFriction::Gear) => keys.push("load_friction_base"),
            Some(LoadFriction::Directional) => keys.extend([
                "load_friction_motor",
                "load_friction_external",
                "load_friction_motor_stribeck",
                "load_friction_external_stribeck",
            ]),
        }
        match self {
            Self::M4 => keys.push("load_friction_stribeck"),
            Self::M6 => keys.extend(["load_friction_motor_quad", "load_friction_external_quad"]),
            _ => {}
        }
        keys
    }
}
