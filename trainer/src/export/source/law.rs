//! The static law and the step of a model as statements.

use frikan_shared::model::{Input, Law, Model};
use frikan_shared::table::Table;
use frikan_shared::units::Quantity;

use super::effects::statements_of_effect;
use super::language::Language;
use super::lookup::lookup;
use super::network;
use super::program;
use crate::error::{Error, Result, codes};
use crate::fit::CELLS;
use frikan_shared::effect::Effect;

/// Names of the parameters of the law.
pub(in crate::export) fn parameters(model: &Model<CELLS>) -> Vec<String> {
    model.inputs.iter().map(parameter).collect()
}

/// The name of a channel as a parameter.
fn parameter(input: &Input) -> String {
    match &input.quantity {
        Quantity::Other(name) => format!("channel_{}", identifier(name)),
        quantity => quantity.name().to_owned(),
    }
}

/// A name as every language takes it.
pub(in crate::export) fn identifier(name: &str) -> String {
    let mut identifier: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if identifier.starts_with(|c: char| c.is_ascii_digit()) || identifier.is_empty() {
        identifier.insert(0, '_');
    }
    identifier
}

/// Where the law is 0 whatever the model says. A law alone is all that a drive evaluates: as its step, it gives nothing for an input that is not finite
/// and at rest, where friction is what holds the joint.
pub(super) fn no_law(model: &Model<CELLS>) -> &'static str {
    match (model.effects.is_empty(), velocity(model).is_some()) {
        (true, true) => "an input is not finite or the velocity is 0",
        (true, false) => "an input is not finite",
        (false, _) => "an input is NaN",
    }
}

/// The name of the velocity as a parameter, where it is one.
fn velocity(model: &Model<CELLS>) -> Option<String> {
    model.inputs.iter().find(|input| input.quantity == Quantity::Velocity).map(parameter)
}

/// The condition of [`no_law`].
fn is_no_law(language: Language, model: &Model<CELLS>) -> String {
    let is_nan = |name: String| match language {
        Language::C => format!("{name} != {name}"),
        Language::Rust => format!("{name}.is_nan()"),
        Language::Python => format!("math.isnan({name})"),
    };
    let names = parameters(model).into_iter();
    if !model.effects.is_empty() {
        // A table reads its first input alone.
        let reads_all = matches!(model.law, Law::Expression(_) | Law::Network(_));
        let read = if reads_all { model.inputs.len() } else { 1 };
        return language.any(&names.take(read).map(is_nan).collect::<Vec<_>>());
    }
    let not_finite = names.map(|name| language.not(&format!("is_finite({name})")));
    let at_rest = velocity(model).map(|velocity| format!("{velocity} == {}", language.number(0.0)));
    language.any(&not_finite.chain(at_rest).collect::<Vec<_>>())
}

/// Statements of the static law, the last of which returns it.
///
/// # Errors
/// `FRK-U005` for integer tables, which [`super::integers`] has in C.
pub(super) fn law(language: Language, model: &Model<CELLS>) -> Result<Vec<String>> {
    let names = parameters(model);
    let nothing = language.return_where(&is_no_law(language, model), 0.0);
    let refusal = |reason: &str| Err(Error::new(&codes::UNSUITABLE_FORM, reason));
    let of_table = |table: Table| {
        let unread = if model.effects.is_empty() { &[][..] } else { &names[1..] };
        let ignored = unread.iter().filter_map(|name| language.ignored(name));
        ignored.chain([nothing.clone(), language.last(&lookup(language, &table, &names[0]))]).collect()
    };
    match &model.law {
        Law::Geometric(layout) => Ok(of_table(Table::Geometric(*layout))),
        Law::Uniform(layout) => Ok(of_table(Table::Uniform(*layout))),
        Law::Expression(program) => {
            let mut statements = vec![nothing.clone()];
            let reads = |index: usize| program.operations.iter().any(|operation| program::reads(operation, index));
            for (index, (input, name)) in model.inputs.iter().zip(&names).enumerate().filter(|(index, _)| reads(*index))
            {
                statements.push(language.constant(&format!("x{index}"), &held(language, input, name)));
            }
            let result = program::statements(&mut statements, language, program);
            let limit = language.number(model.output_limit);
            statements.push(language.last(&format!("limited({result}, {limit})")));
            Ok(statements)
        }
        Law::Network(network) => Ok([vec![nothing], network::statements(language, network, &names)].concat()),
        Law::IntegerTable(_) => refusal(
            "an integer table has no such form: `trainer export --to c` writes it in counts, or take the library",
        ),
    }
}

fn held(language: Language, input: &Input, name: &str) -> String {
    format!("held({name}, {}, {})", language.number(input.low), language.number(input.high))
}

/// Statements of the step of a model with effects, between the sample `m` and the return of the friction; `friction` is the name of the
/// static law. They set the sums `torque` and `place`.
pub(super) fn step(language: Language, model: &Model<CELLS>, friction: &str) -> Vec<String> {
    let names = parameters(model);
    let mut statements = vec![language.statement("m.dt = dt")];
    for (input, name) in model.inputs.iter().zip(&names) {
        let field = match input.quantity {
            Quantity::Velocity => "velocity",
            Quantity::Position => "position",
            Quantity::Load => "load",
            Quantity::Temperature => "temperature",
            Quantity::Acceleration | Quantity::Other(_) => continue,
        };
        statements.push(language.statement(&format!("m.{field} = {}", held(language, input, name))));
    }
    if reads_position(model) {
        statements.push(language.statement("m.angle = position"));
        statements.push(language.statement(&format!("m.travel = travelled({}, position)", language.field("travel"))));
    } else {
        statements.push(language.statement("m.travel = m.velocity * dt"));
    }
    let mut arguments = names;
    if let Some(Effect::FrictionalLag { time_constant }) = model.effects.first() {
        let (motion, memory) = (language.motion(), language.field("memory[0]"));
        let lagged = format!("lagged({motion}, {memory}, {})", language.number(*time_constant));
        statements.push(language.constant("lagged_velocity", &lagged));
        let velocities = arguments.iter_mut().filter(|name| *name == "velocity");
        velocities.for_each(|name| "lagged_velocity".clone_into(name));
    }
    statements.push(language.statement(&format!("m.law = {friction}({})", arguments.join(", "))));
    statements.push(language.statement("torque = m.law"));
    for (index, effect) in model.effects.iter().enumerate() {
        statements.extend(statements_of_effect(language, effect, index));
    }
    statements
}

/// The condition under which a sample is of no use.
pub(super) fn unusable(language: Language, model: &Model<CELLS>) -> String {
    let finite = parameters(model).into_iter().map(|name| format!("is_finite({name})"));
    let conditions = std::iter::once("is_period(dt)".to_owned()).chain(finite);
    language.any(&conditions.map(|condition| language.not(&condition)).collect::<Vec<_>>())
}

pub(super) fn reads_position(model: &Model<CELLS>) -> bool {
    model.inputs.iter().any(|input| input.quantity == Quantity::Position)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers() {
        assert_eq!(identifier("elbow-2"), "elbow_2");
        assert_eq!(identifier("2nd joint"), "_2nd_joint");
        assert_eq!(Language::C.number(-0.5), "(-0.5f)");
        assert_eq!(Language::C.number(1.0e-7), "1e-7f");
    }
}
