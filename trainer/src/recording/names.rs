//! Names of columns as other tools write them, on top of `<quantity>_<unit>`: units in brackets or in a row of their own, ROS paths,
//! and names that are nearly known.

use std::sync::LazyLock;

use super::quantity::{ColumnName, Quantity, Unit, read_column_name};

/// Letters by which a name may differ from a known one and still be taken for a slip: one in short names, two in those from here on.
const TWO_SLIPS_FROM: usize = 10;

/// What a column is by its name, and by the cell under it in a row of units.
pub(super) fn read_name(name: &str, unit_below: &str) -> ColumnName {
    let known = read_column_name(name);
    let (base, unit) = match split_unit(name) {
        Some((base, unit)) => (base, unit),
        None if !unit_below.is_empty() && !matches!(known, ColumnName::Known(..)) => (name, unbracketed(unit_below)),
        None => return known,
    };
    match Quantity::from_name(&plain(base)) {
        None => ColumnName::Other,
        Some(quantity) => {
            quantity.unit(unit).map_or(ColumnName::UnknownUnit(quantity), |unit| ColumnName::Known(quantity, unit))
        }
    }
}

/// `Velocity (deg/s)` and `velocity [deg/s]` as name and unit; an index such as `position[1]` is none.
pub(super) fn split_unit(name: &str) -> Option<(&str, &str)> {
    let (open, inside) = match name.strip_suffix(')') {
        Some(rest) => ('(', rest),
        None => ('[', name.strip_suffix(']')?),
    };
    let (base, unit) = inside.rsplit_once(open)?;
    let (base, unit) = (base.trim(), unit.trim());
    let index = unit.bytes().all(|byte| byte.is_ascii_digit());
    (!base.is_empty() && !index).then_some((base, unit))
}

/// The unit in a cell of a row of units.
pub(super) fn unbracketed(cell: &str) -> &str {
    cell.trim_matches(['[', ']', '(', ')', ' '])
}

/// Whether some quantity has this unit.
pub(super) fn is_unit(cell: &str) -> bool {
    let unit = unbracketed(cell);
    Quantity::ALL.iter().any(|(quantity, _)| quantity.unit(unit).is_some())
}

/// Small letters, words joined by `_`.
pub(super) fn plain(name: &str) -> String {
    name.trim().to_lowercase().replace([' ', '-'], "_")
}

/// A column of a joint state as ROS and PlotJuggler name it: `/joint_states/elbow/position`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct JointState<'a> {
    /// Topic and joint: all before the last `/`.
    pub(super) source: &'a str,
    pub(super) quantity: Quantity,
    /// SI of a rotary joint, as ROS prescribes (REP 103).
    pub(super) unit: &'static Unit,
}

impl<'a> JointState<'a> {
    pub(super) fn of(name: &'a str) -> Option<Self> {
        let (source, field) = name.rsplit_once('/')?;
        let quantity = match field {
            "position" => Quantity::Position,
            "velocity" => Quantity::Velocity,
            "effort" => Quantity::Torque,
            _ => return None,
        };
        Some(Self { source, quantity, unit: &quantity.units()[0] })
    }

    /// Name of the joint: what is before the quantity.
    pub(super) fn joint(&self) -> &'a str {
        self.source.rsplit('/').next().unwrap_or(self.source)
    }
}

/// Every `<quantity>_<unit>` of the contract, beside it in small letters.
static KNOWN: LazyLock<Vec<(Quantity, String, String)>> = LazyLock::new(|| {
    let of = |(quantity, word): (Quantity, &str)| {
        let names = quantity.units().iter().map(|unit| format!("{word}_{}", unit.suffix));
        names.map(|name| (quantity, name.to_lowercase(), name)).collect::<Vec<_>>()
    };
    Quantity::ALL.into_iter().flat_map(of).collect()
});

/// The known name that a column nearly has, and the quantity of it.
pub(super) fn meant(name: &str) -> Option<(Quantity, &'static str)> {
    let plain = plain(name);
    let slips = if plain.len() < TWO_SLIPS_FROM { 1 } else { 2 };
    let near = |known: &str| {
        let close = known.len().abs_diff(plain.len()) <= slips;
        close.then(|| strsim::osa_distance(&plain, known)).filter(|distance| *distance <= slips)
    };
    let found = KNOWN.iter().filter(|(.., known)| known != name);
    let found = found.filter_map(|(quantity, small, known)| Some((near(small)?, *quantity, known.as_str())));
    found.min_by_key(|(distance, ..)| *distance).map(|(_, quantity, known)| (quantity, known))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_in_brackets_and_below_are_read() {
        for (name, below, quantity, suffix) in [
            ("Time (s)", "", Quantity::Time, "s"),
            ("Position (rad)", "", Quantity::Position, "rad"),
            ("velocity [deg/s]", "", Quantity::Velocity, "deg_s"),
            ("Link Position (°)", "", Quantity::LinkPosition, "deg"),
            ("Torque (N·m)", "", Quantity::Torque, "Nm"),
            ("Temperature [°C]", "", Quantity::Temperature, "C"),
            ("torque", "[mNm]", Quantity::Torque, "mNm"),
            ("velocity_rad_s", "", Quantity::Velocity, "rad_s"),
        ] {
            match read_name(name, below) {
                ColumnName::Known(found, unit) => assert_eq!((found, unit.suffix), (quantity, suffix), "{name}"),
                other => panic!("{name}: {other:?}"),
            }
        }
        assert_eq!(read_name("Torque (bananas)", ""), ColumnName::UnknownUnit(Quantity::Torque));
        for name in ["position[1]", "Goal (rad)", "(rad)"] {
            assert_eq!(read_name(name, ""), ColumnName::Other, "{name}");
        }
    }

    #[test]
    fn joint_states_are_read_from_their_path() {
        let state = JointState::of("/joint_states/elbow/effort").unwrap();
        assert_eq!((state.joint(), state.quantity, state.unit.suffix), ("elbow", Quantity::Torque, "Nm"));
        assert!(JointState::of("/joint_states/elbow/stamp").is_none() && JointState::of("position").is_none());
    }

    #[test]
    fn slips_are_seen_and_other_names_left_alone() {
        for (name, known) in [
            ("postion_rad", "position_rad"),
            ("Position_rad", "position_rad"),
            ("torque_nm", "torque_Nm"),
            ("veloctiy_rad_s", "velocity_rad_s"),
            ("tim_s", "time_s"),
        ] {
            assert_eq!(meant(name).unwrap().1, known);
        }
        for name in
            ["reference_m", "joint2_position_rad", "goal_position_rad", "kp", "pressure_bar", "duty", "load_register"]
        {
            assert_eq!(meant(name), None, "{name}");
        }
    }
}
