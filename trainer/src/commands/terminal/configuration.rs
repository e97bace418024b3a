//! Options that a command line leaves open: those of the environment, then those of `trainer.toml`, then defaults.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command};
use serde_json::{Map, Value, json};
use toml::Table;

use crate::did_you_mean::hint;
use crate::error::{Error, Result, codes};
use crate::files::read_text;

/// File of options in the folder of the work, where `FRIKAN_CONFIG` names no other.
const FILE: &str = "trainer.toml";
/// Largest file of options that is read, in bytes.
const FILE_LIMIT_BYTES: u64 = 1 << 20;

/// Options as they are in force, each with where it comes from: one command line a process.
static RESOLVED: OnceLock<Value> = OnceLock::new();

/// A command line with what environment and file add.
#[derive(Clone, Debug, Default)]
pub struct Completed {
    /// All words.
    pub words: Vec<OsString>,
    added: Vec<(String, &'static str)>,
}

/// Options in force, for the JSON of a result; `None` where no command line was completed.
pub(crate) fn resolved() -> Option<&'static Value> {
    RESOLVED.get()
}

/// The words of a command line with the options that environment (`FRIKAN_COMMAND_OPTION`) and file add to its command.
///
/// # Errors
/// `FRK-U001` with the file for what no command has, `FRK-I...` where the file cannot be read.
pub fn complete(words: Vec<OsString>, program: &Command) -> Result<Completed> {
    let Some(command) = words.get(1).and_then(|word| program.find_subcommand(word)) else {
        return Ok(Completed { words, added: Vec::new() });
    };
    let file = File::load(program)?;
    let given: Vec<&Arg> = command.get_arguments().filter(|option| is_given(option, &words[2..])).collect();
    let (mut options, mut added) = (Vec::new(), Vec::new());
    for option in command.get_arguments() {
        let Some(name) = option.get_long().filter(|name| !["help", "version"].contains(name)) else { continue };
        let excludes = |one: &&Arg| {
            one.get_id() == option.get_id()
                || command.get_arg_conflicts_with(one).iter().any(|other| other.get_id() == option.get_id())
        };
        if given.iter().any(excludes) {
            continue;
        }
        let variable = format!("FRIKAN_{}_{name}", command.get_name()).to_uppercase().replace('-', "_");
        let (values, source) = match std::env::var(&variable) {
            Ok(value) => (as_words(option, name, &toml::Value::String(value), &variable)?, "environment"),
            Err(_) => match file.option(command.get_name(), name) {
                Some(value) => (as_words(option, name, value, &file.name)?, "file"),
                None => continue,
            },
        };
        options.extend(values);
        added.push((option.get_id().to_string(), source));
    }
    let (before, after) = words.split_at(2);
    Ok(Completed { words: [before, &options, after].concat(), added })
}

impl Completed {
    /// Keeps what is in force of a command, for its JSON.
    pub fn keep(&self, command: &Command, matches: &ArgMatches) {
        let mut options = Map::new();
        for option in command.get_arguments() {
            let id = option.get_id().as_str();
            let Some(source) = matches.value_source(id) else { continue };
            let added = self.added.iter().find(|(added, _)| added == id).map(|(_, source)| *source);
            let from = added.unwrap_or(if source == ValueSource::DefaultValue { "default" } else { "command line" });
            let words = matches.get_raw(id).into_iter().flatten().map(|word| word.to_string_lossy().into_owned());
            let words: Vec<String> = words.collect();
            let value = match (option.get_action(), words.as_slice()) {
                (ArgAction::SetTrue, _) => json!(matches.get_flag(id)),
                (ArgAction::Set, [one]) => json!(one),
                _ => json!(words),
            };
            options.insert(id.to_owned(), json!({ "value": value, "from": from }));
        }
        // A second command line of one process is a test's.
        let _ = RESOLVED.set(Value::Object(options));
    }
}

/// Whether the words give an option.
fn is_given(option: &Arg, words: &[OsString]) -> bool {
    let words = words.iter().map(|word| word.to_string_lossy()).take_while(|word| word != "--");
    let is_it = |word: &str| {
        let long = option.get_long().is_some_and(|name| {
            word.strip_prefix("--")
                .is_some_and(|rest| rest == name || rest.strip_prefix(name).is_some_and(|rest| rest.starts_with('=')))
        });
        let short = |name| word.strip_prefix('-').is_some_and(|rest| rest.starts_with(name));
        long || option.get_short().is_some_and(short)
    };
    words.into_iter().any(|word| is_it(&word))
}

/// An option with a value of the environment or the file as words; `place` is where it stands.
fn as_words(option: &Arg, name: &str, value: &toml::Value, place: &str) -> Result<Vec<OsString>> {
    let refused =
        |rule: &str| Err(Error::new(&codes::USAGE, rule).in_file(place).in_column(name).with_value(value.to_string()));
    let word = |value: &toml::Value| match value {
        toml::Value::String(text) => Some(text.clone()),
        toml::Value::Integer(_) | toml::Value::Float(_) => Some(value.to_string()),
        _ => None,
    };
    if matches!(option.get_action(), ArgAction::SetTrue) {
        return match value {
            toml::Value::Boolean(true) => Ok(vec![format!("--{name}").into()]),
            toml::Value::Boolean(false) => Ok(Vec::new()),
            toml::Value::String(text) if ["1", "true"].contains(&text.as_str()) => Ok(vec![format!("--{name}").into()]),
            toml::Value::String(text) if ["", "0", "false"].contains(&text.as_str()) => Ok(Vec::new()),
            _ => refused("true or false is expected"),
        };
    }
    let one = std::slice::from_ref(value);
    let words: Option<Vec<String>> = value.as_array().map_or(one, Vec::as_slice).iter().map(word).collect();
    match words {
        Some(words) => Ok(words.into_iter().map(|word| format!("--{name}={word}").into()).collect()),
        None => refused("a text, a number or a list of them is expected"),
    }
}

/// What a file of options says.
#[derive(Default)]
struct File {
    name: String,
    table: Table,
}

impl File {
    fn load(program: &Command) -> Result<Self> {
        let named = std::env::var_os("FRIKAN_CONFIG").map(PathBuf::from);
        let path = named.clone().unwrap_or_else(|| FILE.into());
        if named.is_none() && !path.is_file() {
            return Ok(Self::default());
        }
        Self::parse(&read_text(&path, FILE_LIMIT_BYTES)?, &path, program)
    }

    fn parse(text: &str, path: &Path, program: &Command) -> Result<Self> {
        let name = path.display().to_string();
        let table: Table = toml::from_str(text).map_err(|error: toml::de::Error| {
            let row = error.span().map_or(1, |span| 1 + text[..span.start].matches('\n').count() as u64);
            Error::new(&codes::USAGE, error.message().replace('\n', "; ")).in_file(&name).at_row(row)
        })?;
        let unknown = |key: &str, known: Vec<&str>, what: &str| {
            Err(Error::new(&codes::USAGE, format!("there is no {what} of this name{}", hint(key, known)))
                .in_file(&name)
                .in_column(key))
        };
        let options = |command: &Command| {
            command.get_arguments().filter_map(Arg::get_long).map(str::to_owned).collect::<Vec<_>>()
        };
        for (key, value) in &table {
            let command = program.get_subcommands().find(|command| command.get_name() == key);
            match (value, command) {
                (toml::Value::Table(of_command), Some(command)) => {
                    let known = options(command);
                    if let Some(key) = of_command.keys().find(|key| !known.contains(key)) {
                        return unknown(key, known.iter().map(String::as_str).collect(), "option");
                    }
                }
                (toml::Value::Table(_), None) => {
                    return unknown(key, program.get_subcommands().map(Command::get_name).collect(), "command");
                }
                _ => {
                    let known: Vec<String> = program.get_subcommands().flat_map(options).collect();
                    if !known.contains(key) {
                        return unknown(key, known.iter().map(String::as_str).collect(), "option");
                    }
                }
            }
        }
        Ok(Self { name, table })
    }

    /// What the file says of an option: for its command, else for all commands.
    fn option(&self, command: &str, name: &str) -> Option<&toml::Value> {
        let of_command = self.table.get(command).and_then(|of| of.as_table()).and_then(|of| of.get(name));
        of_command.or_else(|| self.table.get(name).filter(|value| !value.is_table()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn program() -> Command {
        let fit = Command::new("fit")
            .arg(Arg::new("seed").long("seed"))
            .arg(Arg::new("inputs").long("inputs").action(ArgAction::Append))
            .arg(Arg::new("quiet").long("quiet").action(ArgAction::SetTrue));
        Command::new("trainer").subcommand(fit)
    }

    fn refusal(text: &str) -> String {
        File::parse(text, Path::new(FILE), &program()).map(drop).unwrap_err().to_string()
    }

    #[test]
    fn an_option_of_a_command_goes_before_that_of_all() {
        let file = File::parse("seed = 1\n[fit]\nseed = 2\n", Path::new(FILE), &program()).unwrap();
        assert_eq!(file.option("fit", "seed").and_then(toml::Value::as_integer), Some(2));
        assert_eq!(file.option("diagnose", "seed").and_then(toml::Value::as_integer), Some(1));
        assert!(file.option("fit", "quiet").is_none());
    }

    #[test]
    fn what_no_command_has_is_refused_with_what_may_have_been_meant() {
        assert!(refusal("[fit]\nsede = 2\n").contains("did you mean `seed`"), "{}", refusal("[fit]\nsede = 2\n"));
        assert!(refusal("[fid]\nseed = 2\n").contains("did you mean `fit`"));
        assert!(refusal("quite = true\n").contains("did you mean `quiet`"));
        assert!(refusal("[fit]\nseed = \n").starts_with("trainer.toml:2:"), "{}", refusal("[fit]\nseed = \n"));
    }

    #[test]
    fn values_become_words_of_a_command_line() {
        let program = program();
        let fit = program.find_subcommand("fit").unwrap();
        let words = |name: &str, text: &str| {
            let option = fit.get_arguments().find(|option| option.get_long() == Some(name)).unwrap();
            let table: Table = toml::from_str(&format!("value = {text}")).unwrap();
            as_words(option, name, &table["value"], FILE)
        };
        assert_eq!(words("seed", "3").unwrap(), ["--seed=3"]);
        assert_eq!(words("inputs", "[\"velocity\", \"load\"]").unwrap(), ["--inputs=velocity", "--inputs=load"]);
        assert_eq!(words("quiet", "true").unwrap(), ["--quiet"]);
        assert!(words("quiet", "false").unwrap().is_empty() && words("quiet", "3").is_err());
        assert!(words("seed", "{ a = 1 }").is_err());
    }
}
