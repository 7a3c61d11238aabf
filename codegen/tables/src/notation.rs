//! LaTeX for the names of a description.

#[cfg(test)]
mod tests;

/// Greek letters: name of the LaTeX command, and the letter.
const GREEK: &[(&str, &str)] = &[
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("varepsilon", "ϵ"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("vartheta", "ϑ"),
    ("iota", "ι"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("pi", "π"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("upsilon", "υ"),
    ("phi", "φ"),
    ("varphi", "ϕ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
    ("Gamma", "Γ"),
    ("Delta", "Δ"),
    ("Theta", "Θ"),
    ("Lambda", "Λ"),
    ("Xi", "Ξ"),
    ("Pi", "Π"),
    ("Sigma", "Σ"),
    ("Upsilon", "Υ"),
    ("Phi", "Φ"),
    ("Psi", "Ψ"),
    ("Omega", "Ω"),
];

/// Converts a name with its indices to LaTeX: `s[1]` is s_{1}, `Theta[1,2]` is \Theta_{12}, `q.c` is q_c, `T.p[1]` is
/// T_{p,1}, `v_dot[1]` is \dot{v}_{1}, `q_dot_dot` is \ddot{q}, `m1` is m_{1}, `th1` is \mathrm{th1}.
pub fn latex_name(name: &str) -> String {
    let (path, index) = match name.split_once('[') {
        Some((path, rest)) => (path, rest.trim_end_matches(']')),
        None => (name, ""),
    };
    let mut parts = path.split('.');
    let head = parts.next().unwrap_or_default();
    let (head, dots) = undot(head);
    let (letter, mut below) = split(head);
    let letter = match dots {
        0 => letter,
        1 => format!(r"\dot{{{letter}}}"),
        _ => format!(r"\ddot{{{letter}}}"),
    };
    below.extend(parts.map(word));
    let indices: Vec<&str> = index
        .split(',')
        .map(str::trim)
        .filter(|part| !part.is_empty())
        .collect();
    if !indices.is_empty() {
        let single = indices.iter().all(|index| index.len() == 1);
        below.push(indices.join(if single { "" } else { "," }));
    }
    match below.as_slice() {
        [] => letter,
        [one] if one.chars().all(char::is_alphabetic) && one.len() == 1 => {
            format!("{letter}_{one}")
        }
        _ => format!("{letter}_{{{}}}", below.join(",")),
    }
}

/// Removes `_dot` from a name and counts how often (0 to 2): `q_dot_dot` is the rate of the velocity `q_dot`.
fn undot(name: &str) -> (&str, usize) {
    let once = |name| str::strip_suffix(name, "_dot").filter(|rest| !rest.is_empty());
    match once(name) {
        None => (name, 0),
        Some(velocity) => match once(velocity) {
            None => (velocity, 1),
            Some(coordinate) => (coordinate, 2),
        },
    }
}

/// Splits a name into a head and the subscripts that are part of it: `m1`, `alpha_2`, `l_rod`.
fn split(name: &str) -> (String, Vec<String>) {
    if let Some((head, rest)) = name.split_once('_')
        && !head.is_empty()
        && !rest.is_empty()
    {
        let (letter, mut below) = split(head);
        below.push(word(&rest.replace('_', "")));
        return (letter, below);
    }
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = &name[stem.len()..];
    match letter(stem) {
        Some(letter) if !digits.is_empty() => (letter, vec![digits.to_string()]),
        Some(letter) => (letter, Vec::new()),
        None => (word(name), Vec::new()),
    }
}

/// Returns a single letter, or the command of a Greek one.
fn letter(text: &str) -> Option<String> {
    if let Some((name, _)) = GREEK
        .iter()
        .find(|(name, sign)| *name == text || *sign == text)
    {
        return Some(format!("\\{name}"));
    }
    let mut letters = text.chars();
    let first = letters.next()?;
    (letters.next().is_none() && first.is_ascii_alphabetic()).then(|| first.to_string())
}

/// Returns a letter, digits, or an upright word.
fn word(text: &str) -> String {
    if text.chars().all(|c| c.is_ascii_digit()) {
        return text.to_string();
    }
    letter(text).unwrap_or_else(|| format!(r"\mathrm{{{}}}", text.replace('_', r"\_")))
}
