//! `trainer explain CODE`: an error code or the name of an effect, at length.

use crate::did_you_mean::nearest;
use crate::error::{Class, Code, Error, Result, codes};
use clap::Args;

/// One section an effect: a line `# name`, a title, labelled paragraphs.
const EFFECTS: &str = include_str!("explain/effects.txt");

/// Explains an error code or an effect name at length; without argument lists both.
#[derive(Debug, Args)]
pub struct Explain {
    /// An error code such as FRK-D005, or an effect such as stribeck
    pub topic: Option<String>,
}

impl Explain {
    /// The text for standard output.
    ///
    /// # Errors
    /// `FRK-U003` for a topic that is neither.
    pub fn run(&self) -> Result<String> {
        match self.topic.as_deref() {
            None => Ok(listing()),
            Some(topic) => explain(topic),
        }
    }
}

fn explain(topic: &str) -> Result<String> {
    if let Some(code) = codes::find(topic) {
        return Ok(describe(code));
    }
    let wanted = topic.trim().to_ascii_lowercase().replace('-', "_");
    let found = effects().find(|effect| effect.name == wanted || effect.letter().eq_ignore_ascii_case(&wanted));
    match found {
        Some(effect) => Ok(format!("{}: {}\n\n{}\n", effect.name, effect.title, effect.body)),
        None => {
            let shown = topic.escape_debug();
            let known = codes::ALL.iter().map(|code| code.id).chain(effects().map(|effect| effect.name));
            let near = nearest(topic, known).map_or_else(String::new, |near| format!(" Did you mean `{near}`?"));
            let message =
                format!("`{shown}` is neither an error code nor an effect.{near} There are:\n\n{}", listing());
            Err(Error::new(&codes::UNKNOWN_TOPIC, message.trim_end()))
        }
    }
}

fn describe(code: &Code) -> String {
    let status = code.class.exit_status();
    let kind = match code.class {
        Class::Usage => "usage",
        Class::Data => "bad input data",
        Class::NotIdentifiable => "not identifiable or not converged",
        Class::InputOutput => "input or output",
        Class::Warning => "warning",
    };
    format!(
        "{}: {} ({kind}, exit status {status})\n\nmeaning  {}\ncause    {}\nremedy   {}\n",
        code.id, code.title, code.meaning, code.cause, code.remedy
    )
}

fn listing() -> String {
    let mut text = String::from("Error codes\n");
    for code in codes::ALL {
        text += &format!("  {:<10} {}\n", code.id, code.title);
    }
    text += "\nEffects\n";
    for effect in effects() {
        text += &format!("  {:<22} {}\n", effect.name, effect.title);
    }
    text
}

struct Effect {
    name: &'static str,
    title: &'static str,
    body: &'static str,
}

impl Effect {
    /// The catalogue's letter and number, such as `A1`; the first word of the title.
    fn letter(&self) -> &'static str {
        self.title.split(' ').next().unwrap_or("")
    }
}

fn effects() -> impl Iterator<Item = Effect> {
    EFFECTS.split("# ").skip(1).filter_map(|section| {
        let (name, rest) = section.split_once('\n')?;
        let (title, body) = rest.split_once('\n')?;
        Some(Effect { name, title, body: body.trim_end() })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::EffectId;

    #[test]
    fn every_effect_of_the_catalogue_is_explained_under_its_code() {
        for id in EffectId::ALL {
            let effect = effects().find(|effect| effect.name == id.name());
            let effect = effect.unwrap_or_else(|| panic!("{} is not explained", id.name()));
            for label in ["equation", "signature", "mistaken for", "told apart", "on the drive"] {
                assert!(effect.body.contains(label), "{} lacks {label}", effect.name);
            }
            if *id != EffectId::Unknown {
                assert_eq!(effect.letter(), id.code());
            }
        }
        assert_eq!(effects().count(), EffectId::ALL.len());
    }

    #[test]
    fn effects_refer_to_effects_that_exist() {
        for effect in effects() {
            let words = effect.body.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            for word in words.filter(|word| word.contains('_') && word.len() > 9) {
                assert!(effects().any(|other| other.name == word), "{} speaks of {word}", effect.name);
            }
        }
    }

    #[test]
    fn codes_names_and_letters_are_topics_and_the_rest_is_refused_with_a_list() {
        assert!(explain("d005").unwrap().starts_with("FRK-D005: "));
        assert!(explain("Stribeck").unwrap().contains("exp("));
        assert!(explain("c1").unwrap().starts_with("presliding"));
        let error = explain("nonsense").unwrap_err();
        assert_eq!(error.exit_status(), 2);
        assert!(explain("presliden").unwrap_err().message().contains("Did you mean `presliding`?"));
        assert!(explain("FRK-D05").unwrap_err().message().contains("Did you mean `FRK-D0"));
        assert!(error.to_string().contains("FRK-D005") && error.to_string().contains("presliding"));
    }
}
