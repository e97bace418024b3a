//! Places that do not keep a rule yet. A list of them can only shrink: an entry that nothing needs any more fails as well.

/// A breach of a rule.
pub struct Violation {
    /// Files or modules that take part.
    pub places: Vec<String>,
    /// What is wrong, line by line.
    pub text: String,
}

/// # Panics
/// Where a violation lies outside of the exempt places, or an exempt place has none.
pub fn none_but(exempt: &[&str], violations: &[Violation]) {
    let excused = |violation: &Violation, place: &&str| violation.places.iter().all(|member| lies_in(member, place));
    let new = violations.iter().filter(|violation| !exempt.iter().any(|place| excused(violation, place)));
    let broken: String = new.map(|violation| format!("{}\n", violation.text)).collect();
    let clean = exempt.iter().filter(|place| !violations.iter().any(|violation| excused(violation, place)));
    let stale: Vec<&str> = clean.copied().collect();
    assert!(broken.is_empty(), "\n{broken}");
    assert!(stale.is_empty(), "these keep the rule now, take them off the list: {stale:?}");
}

/// Whether a file or module is the place, its file, or lies beneath it.
pub fn lies_in(member: &str, place: &str) -> bool {
    member.strip_prefix(place).is_some_and(|rest| rest.is_empty() || rest == ".rs" || rest.starts_with('/'))
}
