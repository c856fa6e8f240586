//! The name that a writer may have meant.

/// How alike two names must be to suggest one for the other: the part of the longer one's letters that need no change
/// (Damerau-Levenshtein). Lower suggests more, and more often something that was not meant.
const ALIKE: f64 = 0.5;

/// The known name that is most like `name`, if any is.
pub fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    let name = name.to_lowercase();
    let alike = |known: &str| strsim::normalized_damerau_levenshtein(&name, &known.to_lowercase());
    let best = known.iter().copied().max_by(|a, b| alike(a).total_cmp(&alike(b)))?;
    (alike(best) >= ALIKE).then_some(best)
}

/// ` (did you mean ...?)` with the nearest name, if there is one, to end a message with.
pub fn did_you_mean(name: &str, known: &[&str]) -> Option<String> {
    nearest(name, known).map(|best| format!(" (did you mean `{best}`?)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_caught_and_strangers_are_not() {
        let known = ["eye", "look_at", "forward", "colour", "newton", "newton-coherent", "tmin", "tmax"];
        for (slip, meant) in [
            ("lookat", "look_at"),
            ("foward", "forward"),
            ("color", "colour"),
            ("newtn", "newton"),
            ("newton_coherent", "newton-coherent"),
            ("t_max", "tmax"),
            ("Eye", "eye"),
            ("eey", "eye"),
        ] {
            assert_eq!(nearest(slip, &known), Some(meant));
        }
        assert_eq!(nearest("weather", &known), None);
        assert_eq!(nearest("", &known), None);
        assert_eq!(nearest("x", &[]), None);
    }
}
