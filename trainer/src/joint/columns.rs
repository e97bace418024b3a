//! `[columns]` and `[simulation.columns]` of `joint.toml`: which column of a file holds which quantity.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// Columns that are not named `<quantity>_<unit>`, by quantity.
pub type Columns = BTreeMap<String, ColumnMapping>;

/// One entry of `[columns]`: a table, or the name of the column alone.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnMapping {
    /// Name of the column in the file.
    pub name: String,
    /// Unit of the column; SI when absent. `deg/s` and `deg_s` mean the same.
    pub unit: Option<String>,
    /// Side of the gear on which it is measured; joint side when absent.
    pub side: Side,
    /// `-1` for a column whose sign is opposite; any other factor is allowed.
    pub scale: f64,
    /// Whether a file without this column is read by its standard names instead of being refused; never read from `joint.toml`.
    pub may_be_absent: bool,
}

/// Side of the gear on which a quantity is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// After the gear.
    #[default]
    Joint,
    /// Before the gear: angles are divided and torques multiplied by `[drive] gear_ratio`.
    Motor,
}

/// `[simulation]`: what is particular to the file of `diagnose --simulation`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Simulation {
    /// Its columns; absent: those of the recording as far as it has them.
    pub columns: Option<Columns>,
    /// Whether that file is the one that is read.
    #[serde(skip)]
    pub is_read: bool,
}

/// The table that an entry may be.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    name: String,
    unit: Option<String>,
    #[serde(default)]
    side: Side,
    #[serde(default = "one")]
    scale: f64,
}

fn one() -> f64 {
    1.0
}

impl<'de> Deserialize<'de> for ColumnMapping {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NameOrTable)
    }
}

struct NameOrTable;

impl<'de> Visitor<'de> for NameOrTable {
    type Value = ColumnMapping;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("the name of a column or a table with `name`, `unit`, `side` and `scale`")
    }

    fn visit_str<E>(self, name: &str) -> Result<ColumnMapping, E> {
        let (unit, side) = (None, Side::Joint);
        Ok(ColumnMapping { name: name.to_owned(), unit, side, scale: 1.0, may_be_absent: false })
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ColumnMapping, A::Error> {
        let Table { name, unit, side, scale } = Table::deserialize(MapAccessDeserializer::new(map))?;
        Ok(ColumnMapping { name, unit, side, scale, may_be_absent: false })
    }
}
