//! The joints of a fleet as columns: CSV and Parquet.

use std::collections::HashMap;

use super::gathered::{Fitted, Gathered, Unfitted, reasons};
use crate::error::{Error, Result, codes};
use crate::fleet::{Member, Quantity};
use crate::law::significant;

/// Significant digits of a number in CSV.
const DIGITS: usize = 9;

/// A column of the table, a cell a joint, then one a task that left no fit.
pub(super) struct Column {
    name: String,
    cells: Cells,
}

enum Cells {
    Texts(Vec<Option<String>>),
    Numbers(Vec<Option<f64>>),
}

/// A row: a joint with the task of its newest recording, or a task that left no fit.
enum Row<'a> {
    Joint(&'a Member, &'a Fitted<'a>),
    Unfitted(&'a Unfitted<'a>),
}

/// The whole table.
pub(super) fn table(gathered: &Gathered<'_>) -> Vec<Column> {
    let survey = &gathered.survey;
    let newest = newest(gathered);
    let joints = survey.members.iter();
    let joints = joints.filter_map(|member| Some(Row::Joint(member, newest.get(member.joint.as_str())?)));
    let rows: Vec<Row<'_>> = joints.chain(gathered.unfitted.iter().map(Row::Unfitted)).collect();
    let texts = |name: &str, of: &dyn Fn(&Row<'_>) -> Option<String>| Column {
        name: name.to_owned(),
        cells: Cells::Texts(rows.iter().map(of).collect()),
    };
    let numbers = |name: String, of: &dyn Fn(&Member) -> Option<f64>| {
        let cell = |row: &Row<'_>| match row {
            Row::Joint(member, ..) => of(member).filter(|value| value.is_finite()),
            Row::Unfitted(_) => None,
        };
        Column { name, cells: Cells::Numbers(rows.iter().map(cell).collect()) }
    };
    let task = |row: &Row<'_>| match row {
        Row::Joint(_, fitted) => fitted.task.clone(),
        Row::Unfitted(unfitted) => unfitted.task.clone(),
    };
    let mut columns = vec![
        texts("joint", &|row| Some(task(row).joint)),
        texts("kind", &|row| Some(task(row).kind)),
        texts("recording", &|row| Some(task(row).recording)),
        texts("date", &|row| task(row).date),
        texts("status", &|row| Some(status(row).to_owned())),
        texts("code", &code),
        texts("message", &message),
        texts("health", &health),
        texts("law", &|row| match row {
            Row::Joint(member, ..) => survey.kinds[member.kind].law.clone(),
            Row::Unfitted(_) => None,
        }),
        texts("outlier_by", &|row| match row {
            Row::Joint(member, ..) => Some(reasons(member).join(" ")),
            Row::Unfitted(_) => None,
        }),
        numbers("recordings".into(), &|member| Some(member.recordings as f64)),
        numbers("outlier".into(), &|member| Some(f64::from(u8::from(member.is_outlier)))),
        numbers("false_share".into(), &|member| Some(member.adjusted)),
    ];
    for kind in 0..survey.kinds.len() {
        let of_kind = |member: &Member| member.kind == kind;
        let unit = suffix(&survey.kinds[kind].unit);
        for (k, quantity) in Quantity::ALL.iter().enumerate() {
            let unit = if *quantity == Quantity::Trend { "per_year" } else { &unit };
            let value = |member: &Member| member.compared[k].value.filter(|_| of_kind(member)).map(|value| value.value);
            merge(&mut columns, numbers(format!("{}_{unit}", quantity.name()), &value));
            let deviations =
                |member: &Member| member.compared[k].departure.filter(|_| of_kind(member)).map(|d| d.deviations);
            merge(&mut columns, numbers(format!("{}_deviations", quantity.name()), &deviations));
        }
        for (name, unit, _) in &survey.kinds[kind].constants {
            let of = |member: &Member, what: fn(&(crate::parameter::Parameter, crate::fleet::Estimate)) -> f64| {
                member.constants.iter().find(|(own, _)| of_kind(member) && own.name == *name).map(what)
            };
            let unit = suffix(unit);
            let named = |what: &str| format!("{name}{what}_{unit}");
            merge(&mut columns, numbers(named(""), &|member| of(member, |(own, _)| own.value)));
            merge(&mut columns, numbers(named("_low"), &|member| of(member, |(own, _)| own.ci95[0])));
            merge(&mut columns, numbers(named("_high"), &|member| of(member, |(own, _)| own.ci95[1])));
            merge(&mut columns, numbers(named("_expected"), &|member| of(member, |(_, expected)| expected.value)));
        }
    }
    columns
}

/// Adds a column, or fills the cells of one of the same name, which another kind of joints has.
fn merge(columns: &mut Vec<Column>, next: Column) {
    match columns.iter_mut().find(|column| column.name == next.name) {
        Some(Column { cells: Cells::Numbers(there), .. }) => {
            if let Cells::Numbers(cells) = next.cells {
                there.iter_mut().zip(cells).for_each(|(there, cell)| *there = there.or(cell));
            }
        }
        _ => columns.push(next),
    }
}

/// The newest recording of each joint, in the order in which the survey takes them: of several on one date the last.
fn newest<'a>(gathered: &'a Gathered<'_>) -> HashMap<&'a str, &'a Fitted<'a>> {
    let mut newest: HashMap<&str, &Fitted<'_>> = HashMap::new();
    for fitted in &gathered.fitted {
        let entry = newest.entry(&fitted.task.joint).or_insert(fitted);
        if fitted.task.date >= entry.task.date {
            *entry = fitted;
        }
    }
    newest
}

fn status(row: &Row<'_>) -> &'static str {
    match row {
        Row::Joint(_, Fitted { doubt: Some(_), .. }) => "doubtful",
        Row::Joint(..) => "fitted",
        Row::Unfitted(Unfitted { failure: Some(_), .. }) => "failed",
        Row::Unfitted(_) => "missing",
    }
}

fn code(row: &Row<'_>) -> Option<String> {
    match row {
        Row::Joint(_, fitted) => fitted.doubt.as_ref().map(|failure| failure.code.clone()),
        Row::Unfitted(unfitted) => unfitted.failure.as_ref().map(|failure| failure.code.clone()),
    }
}

fn message(row: &Row<'_>) -> Option<String> {
    match row {
        Row::Joint(_, fitted) => fitted.doubt.as_ref().map(|failure| failure.message.clone()),
        Row::Unfitted(unfitted) => unfitted.failure.as_ref().map(|failure| failure.message.clone()),
    }
}

/// Codes of what the checks of a recording noticed.
fn health(row: &Row<'_>) -> Option<String> {
    match row {
        Row::Joint(_, fitted) => Some(fitted.warnings.join(" ")),
        Row::Unfitted(_) => None,
    }
}

/// A unit as the name of a column ends: `Nms_rad` for `N m s/rad`.
fn suffix(unit: &str) -> String {
    unit.replace(['/', '^'], "_").replace(' ', "")
}

/// The table as text.
///
/// # Errors
/// `FRK-I001` when it cannot be put together.
pub(super) fn csv(columns: &[Column]) -> Result<Vec<u8>> {
    let failed = |error: csv::Error| Error::new(&codes::INPUT_OUTPUT, error.to_string());
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns.iter().map(|column| column.name.as_str())).map_err(failed)?;
    for row in 0..columns.first().map_or(0, Column::len) {
        writer.write_record(columns.iter().map(|column| column.text(row))).map_err(failed)?;
    }
    writer.into_inner().map_err(|error| Error::new(&codes::INPUT_OUTPUT, error.to_string()))
}

impl Column {
    fn len(&self) -> usize {
        match &self.cells {
            Cells::Texts(cells) => cells.len(),
            Cells::Numbers(cells) => cells.len(),
        }
    }

    fn text(&self, row: usize) -> String {
        match &self.cells {
            Cells::Texts(cells) => cells[row].clone().unwrap_or_default(),
            Cells::Numbers(cells) => cells[row].map_or_else(String::new, |value| significant(value, DIGITS)),
        }
    }
}

/// The table as Apache Parquet, one group of rows.
///
/// # Errors
/// `FRK-I001` when it cannot be put together.
#[cfg(feature = "parquet")]
pub(super) fn parquet(columns: &[Column]) -> Result<Vec<u8>> {
    write_parquet(columns).map_err(|error| Error::new(&codes::INPUT_OUTPUT, error.to_string()))
}

#[cfg(feature = "parquet")]
fn write_parquet(columns: &[Column]) -> parquet::errors::Result<Vec<u8>> {
    use parquet::basic::{LogicalType, Repetition, Type as Physical};
    use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
    use parquet::file::properties::WriterProperties;
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::types::Type;
    use std::sync::Arc;

    let field = |column: &Column| {
        let (physical, logical) = match column.cells {
            Cells::Texts(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            Cells::Numbers(_) => (Physical::DOUBLE, None),
        };
        let builder = Type::primitive_type_builder(&column.name, physical).with_logical_type(logical);
        builder.with_repetition(Repetition::OPTIONAL).build().map(Arc::new)
    };
    let fields = columns.iter().map(field).collect::<parquet::errors::Result<Vec<_>>>()?;
    let schema = Arc::new(Type::group_type_builder("joints").with_fields(fields).build()?);
    // Without the name of a program, which the library would write: the same bytes for the same result.
    let properties = WriterProperties::builder().set_created_by("trainer".to_owned()).build();
    let mut bytes = Vec::new();
    let mut file = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties))?;
    let mut rows = file.next_row_group()?;
    for column in columns {
        let Some(mut writer) = rows.next_column()? else { break };
        match &column.cells {
            Cells::Texts(cells) => {
                let there: Vec<i16> = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
                let values: Vec<ByteArray> = cells.iter().flatten().map(|cell| cell.as_str().into()).collect();
                writer.typed::<ByteArrayType>().write_batch(&values, Some(&there), None)?;
            }
            Cells::Numbers(cells) => {
                let there: Vec<i16> = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
                let values: Vec<f64> = cells.iter().flatten().copied().collect();
                writer.typed::<DoubleType>().write_batch(&values, Some(&there), None)?;
            }
        }
        writer.close()?;
    }
    rows.close()?;
    file.close()?;
    Ok(bytes)
}
