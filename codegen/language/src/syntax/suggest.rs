//! Suggestions for misspelt words.

/// Returns the candidate closest to a misspelt word; `None` if none is close enough to be worth a suggestion.
///
/// The distance counts insertions, deletions, substitutions and swaps of neighbours. At most a third of the word,
/// rounded up, may differ.
pub fn closest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    /// Longer words are not taken for misspelt names.
    const LONGEST: usize = 64;
    let word: Vec<char> = word.chars().take(LONGEST + 1).collect();
    if word.len() > LONGEST {
        return None;
    }
    let allowed = word.len().div_ceil(3);
    let mut best = None;
    for candidate in candidates {
        let letters: Vec<char> = candidate.chars().collect();
        if letters.len().abs_diff(word.len()) > allowed {
            continue;
        }
        let distance = distance(&word, &letters);
        if distance <= allowed
            && distance < letters.len()
            && best.is_none_or(|(least, _)| distance < least)
        {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Returns the names of coordinates whose rate a name may stand for, as `x_dot`, `xdot`, `x_d` and `dx` do for `x`.
pub fn coordinates_of_rate(name: &str) -> impl Iterator<Item = &str> {
    const ENDINGS: [&str; 3] = ["_dot", "dot", "_d"];
    let endings = ENDINGS.iter();
    let stripped = endings.filter_map(move |ending| name.strip_suffix(ending));
    stripped.chain(name.strip_prefix('d'))
}

/// Returns the optimal string alignment distance, using three rows of its table.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = Vec::new();
    let mut above: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let changed = usize::from(a[i - 1] != b[j - 1]);
            row[j] = (above[j] + 1)
                .min(row[j - 1] + 1)
                .min(above[j - 1] + changed);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut above, row);
    }
    above[b.len()]
}
