//! What is noted of several recordings in the same words, told once.

/// What is noted of a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Noted {
    /// Name of the recording, where it is one of several.
    pub recording: Option<String>,
    /// What is noted, without the name.
    pub sentence: String,
}

/// Sentences, each with the recordings that it is noted of: those that differ in nothing or in their figures only are one, with the range of each figure, as `9.4–19`.
#[must_use]
pub fn folded(notes: &[Noted]) -> Vec<String> {
    let mut groups: Vec<Vec<&Noted>> = Vec::new();
    for note in notes {
        let alike = |group: &&mut Vec<&Noted>| {
            let first = group[0];
            first.recording.is_some() && note.recording.is_some() && is_alike(&first.sentence, &note.sentence)
        };
        match groups.iter_mut().find(alike) {
            Some(group) => group.push(note),
            None => groups.push(vec![note]),
        }
    }
    groups.iter().map(|group| one(group)).collect()
}

/// The recordings of a list as words: `a.csv, b.csv and c.csv`.
#[must_use]
pub fn listed(names: &[&str]) -> String {
    match names.split_last() {
        None => String::new(),
        Some((last, [])) => (*last).to_owned(),
        Some((last, before)) => format!("{} and {last}", before.join(", ")),
    }
}

fn one(group: &[&Noted]) -> String {
    let sentences: Vec<&str> = group.iter().map(|note| note.sentence.as_str()).collect();
    let mut names: Vec<&str> = group.iter().filter_map(|note| note.recording.as_deref()).collect();
    names.dedup();
    let sentence = merged(&sentences);
    if names.is_empty() { sentence } else { format!("in {} {sentence}", listed(&names)) }
}

/// Sentences that are alike as one.
fn merged(sentences: &[&str]) -> String {
    let words: Vec<Vec<&str>> = sentences.iter().map(|sentence| sentence.split(' ').collect()).collect();
    let Some(first) = words.first() else { return String::new() };
    let of_place = |place: usize| {
        let all: Vec<&str> = words.iter().filter_map(|words| words.get(place).copied()).collect();
        let figures: Vec<(f64, &str)> = all.iter().filter_map(|word| figure(word)).collect();
        let least = figures.iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let most = figures.iter().max_by(|a, b| a.0.total_cmp(&b.0));
        match least.zip(most) {
            Some((least, most)) if least.0 != most.0 => {
                let mark = first[place].strip_prefix(figure(first[place]).map_or("", |(_, text)| text)).unwrap_or("");
                format!("{}–{}{mark}", least.1, most.1)
            }
            _ => first[place].to_owned(),
        }
    };
    (0..first.len()).map(of_place).collect::<Vec<_>>().join(" ")
}

/// Whether two sentences differ in nothing but figures.
fn is_alike(a: &str, b: &str) -> bool {
    let mut words = (a.split(' '), b.split(' '));
    loop {
        match (words.0.next(), words.1.next()) {
            (None, None) => return true,
            (Some(a), Some(b)) if a == b || figure(a).is_some() && figure(b).is_some() => {}
            _ => return false,
        }
    }
}

/// The number that a word is, and its text without the punctuation behind it.
fn figure(word: &str) -> Option<(f64, &str)> {
    let text = word.trim_end_matches([',', ';', ':', ')']);
    let starts = text.starts_with(|letter: char| letter.is_ascii_digit() || letter == '-');
    Some((text.parse().ok().filter(|_| starts)?, text))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noted(recording: &str, sentence: &str) -> Noted {
        Noted { recording: (!recording.is_empty()).then(|| recording.to_owned()), sentence: sentence.to_owned() }
    }

    #[test]
    fn the_same_of_several_recordings_is_told_once_with_the_range_of_its_figures() {
        let notes = [
            noted("a.csv", "FRK the velocity comes 15.1 ms after, 2 times"),
            noted("b.csv", "FRK the velocity comes 9.4 ms after, 2 times"),
            noted("b.csv", "FRK q2 stands still"),
            noted("c.csv", "FRK the velocity comes 19 ms after, 2 times"),
            noted("c.csv", "FRK q3 stands still"),
        ];
        let told = folded(&notes);
        assert_eq!(told.len(), 3, "{told:?}");
        assert_eq!(told[0], "in a.csv, b.csv and c.csv FRK the velocity comes 9.4–19 ms after, 2 times");
        assert_eq!(told[1], "in b.csv FRK q2 stands still");
    }

    #[test]
    fn what_is_of_no_recording_in_particular_stays_as_it_is() {
        let notes = [noted("", "at 3 rows"), noted("", "at 4 rows")];
        assert_eq!(folded(&notes), ["at 3 rows", "at 4 rows"]);
    }
}
