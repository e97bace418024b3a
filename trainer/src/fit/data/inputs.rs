//! Which channels the friction model reads, and what each of them is called in model and law.

use frikan_shared::model::MAX_INPUTS;
use frikan_shared::units::{Quantity, Unit};

use super::gather::Material;
use crate::error::{Error, Result, codes};
use crate::law::ChannelRole;
use crate::recording::Axis;
use crate::samples::relevance::{Relevance, picked_inputs, relevance};

/// An input with its values at the rows that are learnt from.
#[derive(Clone, Debug)]
pub(in crate::fit) struct ChosenInput {
    pub(in crate::fit) name: String,
    pub(in crate::fit) role: ChannelRole,
    pub(in crate::fit) quantity: Quantity,
    pub(in crate::fit) unit: Unit,
    pub(in crate::fit) values: Vec<f64>,
    pub(in crate::fit) low: f64,
    pub(in crate::fit) high: f64,
}

/// Picks inputs by relevance unless they are asked for.
pub(in crate::fit) fn choose(
    material: &Material,
    asked: Option<&[String]>,
) -> Result<(Vec<ChosenInput>, Vec<Relevance>)> {
    let mut table = relevance(&material.samples, &material.friction)?;
    let names = match asked {
        Some(names) => names.to_vec(),
        None => {
            // Over a motion that repeats itself the position only says at which phase of it a row stands.
            let is_label = |name: &String| name == "position" && material.repeats.is_some();
            picked_inputs(&table).into_iter().filter(|name| !is_label(name)).take(MAX_INPUTS).collect()
        }
    };
    if !names.iter().any(|name| name == "velocity") {
        let message = "a friction law needs `velocity` among its inputs";
        return Err(Error::new(&codes::UNKNOWN_INPUT, message).with_value(names.join(",")));
    }
    if names.len() > MAX_INPUTS {
        let message = format!("a model has at most {MAX_INPUTS} inputs");
        return Err(Error::new(&codes::USAGE, message).with_value(names.join(",")));
    }
    // Velocity first, whatever the order of the request.
    let rest = names.iter().filter(|name| *name != "velocity");
    let ordered: Vec<&str> = std::iter::once("velocity").chain(rest.map(String::as_str)).collect();
    let inputs = ordered.iter().map(|name| chosen(material, name)).collect::<Result<Vec<_>>>()?;
    for (index, input) in inputs.iter().enumerate() {
        if inputs[..index].iter().any(|earlier| earlier.quantity == input.quantity) {
            let message = format!("`{}` is given twice among the inputs", input.name);
            return Err(Error::new(&codes::USAGE, message).with_value(names.join(",")));
        }
    }
    for row in &mut table {
        row.picked = inputs.iter().zip(&ordered).any(|(input, asked)| row.input == input.name || row.input == *asked);
    }
    Ok((inputs, table))
}

fn chosen(material: &Material, asked: &str) -> Result<ChosenInput> {
    let samples = &material.samples;
    let rotary = samples.axis == Axis::Rotary;
    let column = match asked {
        // Without a measured load the rigid-body torque is what the gear carries.
        "load" if samples.input("load").is_none() => samples.require_input("rigid_body_torque")?,
        name => samples.require_input(name)?,
    };
    let values = material.pick(column);
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if low >= high {
        let message = format!("the input `{asked}` does not change over the recordings");
        return Err(Error::new(&codes::NOT_IDENTIFIABLE, message).in_column(asked).with_value(low.to_string()));
    }
    let by_axis = |radian: Unit, metre: Unit| if rotary { radian } else { metre };
    let (name, role, quantity, unit) = match asked {
        "velocity" => (
            "velocity",
            ChannelRole::Velocity,
            Quantity::Velocity,
            by_axis(Unit::RadianPerSecond, Unit::MetrePerSecond),
        ),
        "position" => ("position", ChannelRole::Position, Quantity::Position, by_axis(Unit::Radian, Unit::Metre)),
        "acceleration" => (
            "acceleration",
            ChannelRole::Other,
            Quantity::Acceleration,
            by_axis(Unit::RadianPerSecondSquared, Unit::MetrePerSecondSquared),
        ),
        "load" | "load_torque" | "rigid_body_torque" => {
            ("load", ChannelRole::Load, Quantity::Load, output_unit(samples.actuator_unit))
        }
        "temperature" => ("temperature", ChannelRole::Temperature, Quantity::Temperature, Unit::Celsius),
        other => (other, ChannelRole::Other, Quantity::Other(channel_name(other)?), Unit::One),
    };
    Ok(ChosenInput { name: name.to_owned(), role, quantity, unit, values, low, high })
}

fn channel_name<const N: usize>(name: &str) -> Result<heapless::String<N>> {
    heapless::String::try_from(name).map_err(|_| {
        let message = format!("the name of an input has at most {N} bytes; map it to a shorter one under [columns]");
        Error::new(&codes::UNKNOWN_INPUT, message).with_value(name)
    })
}

/// The unit of actuator and model output from its suffix in recordings.
pub(in crate::fit) fn output_unit(suffix: &str) -> Unit {
    match suffix {
        "N" => Unit::Newton,
        "A" => Unit::Ampere,
        _ => Unit::NewtonMetre,
    }
}

/// Symbol of an input in formulas.
pub(in crate::fit) fn symbol(input: &str) -> &str {
    match input {
        "velocity" => "v",
        "position" => "q",
        "acceleration" => "a",
        "load" => "τ",
        "temperature" => "T",
        other => other,
    }
}
