//! How the three languages write the same statements.

/// A language of source code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Language {
    C,
    Rust,
    Python,
}

impl Language {
    /// A finite number that reads back to the same bits; in C a negative one in brackets.
    pub(super) fn number(self, x: f32) -> String {
        let plain = match self {
            Self::C => format!("{x:?}f"),
            Self::Rust => format!("{x:?}_f32"),
            Self::Python => format!("{:?}", f64::from(x)),
        };
        if self == Self::C && x.is_sign_negative() { format!("({plain})") } else { plain }
    }

    /// An array of numbers.
    pub(super) fn row(self, values: &[f32]) -> String {
        let values: Vec<String> = values.iter().map(|value| self.number(*value)).collect();
        self.array("float", "[]", &values)
    }

    /// An array of rows of numbers, in C with its length behind it.
    pub(super) fn rows<const N: usize>(self, rows: &[[f32; N]]) -> String {
        let rows: Vec<String> = rows
            .iter()
            .map(|row| self.inner(&row.iter().map(|value| self.number(*value)).collect::<Vec<_>>()))
            .collect();
        let array = self.array("float", &format!("[][{N}]"), &rows);
        if self == Self::C { format!("{array}, {}", rows.len()) } else { array }
    }

    /// An array of words.
    pub(super) fn words(self, words: &[u32]) -> String {
        self.array("uint32_t", "[]", &words.iter().map(|word| self.word(*word)).collect::<Vec<_>>())
    }

    /// An array of four words each.
    pub(super) fn fours_of_words(self, rows: &[[u32; 4]]) -> String {
        let rows: Vec<String> = rows.iter().map(|row| self.inner(&row.map(|word| self.word(word)))).collect();
        self.array("uint32_t", "[][4]", &rows)
    }

    fn word(self, word: u32) -> String {
        if self == Self::C { format!("{word:#x}u") } else { format!("{word:#x}") }
    }

    /// A constant of rows of four numbers, whose type is called so in C and in Rust.
    pub(super) fn fours(self, name: &str, [of_c, of_rust]: [&str; 2], rows: &[String]) -> String {
        let (count, constant) = (rows.len(), name.to_ascii_uppercase());
        let (head, foot) = match self {
            Self::C => (format!("static const {of_c} {name}[{count}][4] = {{"), "};\n\n"),
            Self::Rust => (format!("const {constant}: [[{of_rust}; 4]; {count}] = ["), "];\n\n"),
            Self::Python => (format!("\n\n{constant} = ["), "]\n"),
        };
        let rows: String = rows.iter().map(|row| format!("    {row},\n")).collect();
        format!("{head}\n{rows}{foot}")
    }

    /// A number without a sign.
    pub(super) fn unsigned(self, number: u32) -> String {
        match self {
            Self::C => format!("{number}u"),
            Self::Rust => format!("{number}_u32"),
            Self::Python => number.to_string(),
        }
    }

    /// The array inside of an array.
    pub(super) fn inner(self, items: &[String]) -> String {
        if self == Self::C { format!("{{{}}}", items.join(", ")) } else { format!("[{}]", items.join(", ")) }
    }

    fn array(self, of: &str, dimensions: &str, items: &[String]) -> String {
        let inner = self.inner(items);
        match self {
            Self::C => format!("(const {of}{dimensions}){inner}"),
            Self::Rust => format!("&{inner}"),
            Self::Python => inner,
        }
    }

    /// A constant of a function.
    pub(super) fn constant(self, name: &str, value: &str) -> String {
        match self {
            Self::C => format!("const float {name} = {value};"),
            Self::Rust => format!("let {name} = {value};"),
            Self::Python => format!("{name} = {value}"),
        }
    }

    /// A statement that reads a parameter for nothing, where a compiler asks for it.
    pub(super) fn ignored(self, parameter: &str) -> Option<String> {
        match self {
            Self::C => Some(format!("(void){parameter};")),
            Self::Rust => Some(format!("let _ = {parameter};")),
            Self::Python => None,
        }
    }

    /// A statement, such as an assignment.
    pub(super) fn statement(self, text: &str) -> String {
        if self == Self::Python { text.to_owned() } else { format!("{text};") }
    }

    /// A return in the middle of a function.
    pub(super) fn return_where(self, condition: &str, value: f32) -> String {
        let value = self.number(value);
        match self {
            Self::C => format!("if ({condition}) return {value};"),
            Self::Rust => format!("if {condition} {{ return {value}; }}"),
            Self::Python => format!("if {condition}: return {value}"),
        }
    }

    /// The last statement of a function.
    pub(super) fn last(self, value: &str) -> String {
        match self {
            Self::C => format!("return {value};"),
            Self::Rust => value.to_owned(),
            Self::Python => format!("return {value}"),
        }
    }

    /// Conditions of which one has to hold.
    pub(super) fn any(self, conditions: &[String]) -> String {
        conditions.join(if self == Self::Python { " or " } else { " || " })
    }

    /// That a condition does not hold.
    pub(super) fn not(self, condition: &str) -> String {
        if self == Self::Python { format!("not {condition}") } else { format!("!{condition}") }
    }

    /// The sample as an argument.
    pub(super) fn motion(self) -> &'static str {
        if self == Self::Python { "m" } else { "&m" }
    }

    /// A field of the state as an argument by which it is changed.
    pub(super) fn field(self, field: &str) -> String {
        match self {
            Self::C => format!("state->{field}"),
            Self::Rust => format!("&mut self.{field}"),
            Self::Python => format!("self.{field}"),
        }
    }

    /// The cells of all tables as an argument.
    pub(super) fn cells(self) -> &'static str {
        match self {
            Self::C => "cells",
            Self::Rust => "&CELLS",
            Self::Python => "CELLS",
        }
    }
}
