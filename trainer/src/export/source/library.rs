//! The functions that exported source may call, in each language: those that it does call are put in front of it.

use super::language::Language;

/// The functions of C and of Rust, each separated by a blank line from the next and after those that it calls itself.
const C: &str = include_str!("functions.c");
const RUST: &str = concat!(include_str!("functions_of_networks.rs"), "\n", include_str!("functions.rs"));

/// All functions of Python.
pub(super) const PYTHON: &str = include_str!("functions.py");

/// What of the functions `body` needs: those that it calls, and those that these call, in their order.
pub(super) fn needed(language: Language, body: &str) -> String {
    let functions = match language {
        Language::C => C,
        Language::Rust => RUST,
        Language::Python => return PYTHON.to_owned(),
    };
    let mut kept: Vec<&str> = Vec::new();
    for function in functions.trim_end().split("\n\n").collect::<Vec<_>>().into_iter().rev() {
        let use_of = use_of(function);
        if kept.iter().chain([&body]).any(|text| has_word(text, &use_of)) {
            kept.push(function);
        }
    }
    kept.iter().rev().map(|function| format!("{function}\n\n")).collect()
}

/// The name of the function or of the structure that a piece defines, comments aside.
fn defined_name(piece: &str) -> &str {
    let definition = piece.lines().find(|line| ["static ", "struct ", "fn "].iter().any(|word| line.starts_with(word)));
    let head = definition.unwrap_or("").split(['(', '{']).next().unwrap_or("");
    head.trim_end().rsplit(' ').next().unwrap_or("")
}

/// The text by which what a piece defines is used: the call of a function, the name of a structure.
fn use_of(piece: &str) -> String {
    let is_structure = piece.lines().any(|line| line.starts_with("struct "));
    format!("{}{}", defined_name(piece), if is_structure { "" } else { "(" })
}

/// Whether a text holds a use, and not only the end of a longer name.
fn has_word(text: &str, usage: &str) -> bool {
    text.match_indices(usage).any(|(at, _)| !text[..at].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_has_a_name_and_brings_what_it_calls() {
        for (language, text, word) in [(Language::C, C, "static float "), (Language::Rust, RUST, "fn ")] {
            let names: Vec<&str> = text.trim_end().split("\n\n").map(defined_name).collect();
            assert!(names.iter().all(|name| !name.is_empty()) && names.contains(&"f_square_root"), "{names:?}");
            let cosine = needed(language, "f_cos(x)");
            for name in ["at_most(", "sin_half_turn(", "less_half_turns("] {
                assert!(cosine.contains(&format!("{word}{name}")), "{name}");
            }
            assert!(
                !cosine.contains("f_sin(") && !cosine.contains("f_exp(") && !cosine.contains("at_least("),
                "{cosine}"
            );
            assert_eq!(needed(language, "x + 1.0f"), "");
        }
    }
}
