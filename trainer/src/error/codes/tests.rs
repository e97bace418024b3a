use super::*;

#[test]
fn identifiers_are_unique_and_say_their_class() {
    for (index, code) in ALL.iter().enumerate() {
        let letter = match code.class {
            Class::Usage => "U",
            Class::Data => "D",
            Class::NotIdentifiable => "N",
            Class::InputOutput => "I",
            Class::Warning => "W",
        };
        assert!(code.id.starts_with(&format!("FRK-{letter}")), "{}", code.id);
        assert!(ALL[..index].iter().all(|earlier| earlier.id != code.id), "{} twice", code.id);
    }
}

#[test]
fn a_code_is_found_with_and_without_prefix() {
    assert_eq!(find("frk-d005"), Some(&NOT_A_NUMBER));
    assert_eq!(find("D005"), Some(&NOT_A_NUMBER));
    assert_eq!(find("D999"), None);
}
