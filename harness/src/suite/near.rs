//! Suggestions for names that are not known.

/// Similarity (Jaro-Winkler, 0 to 1) from which a name is taken for a misspelling of another.
const SIMILAR: f64 = 0.7;

/// The message for an unknown name: the nearest of the `known` names, and all of them.
pub(super) fn unknown(what: &str, name: &str, known: &[impl AsRef<str>]) -> String {
    let names = || known.iter().map(AsRef::as_ref);
    let similarity = |other: &&str| strsim::jaro_winkler(name, other);
    let nearest = names().max_by(|a, b| similarity(a).total_cmp(&similarity(b)));
    let all = match known.is_empty() {
        true => "there are none".to_owned(),
        false => format!("there are {}", names().collect::<Vec<_>>().join(", ")),
    };
    match nearest.filter(|other| similarity(other) >= SIMILAR) {
        Some(other) => format!("{what} {name:?}; did you mean {other:?}? {all}"),
        None => format!("{what} {name:?}; {all}"),
    }
}
