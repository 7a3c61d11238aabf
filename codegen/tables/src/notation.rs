//! Names of a description in LaTeX and MathML.

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
    let Parts { stem, dots, below } = parts(name);
    let stem = latex_word(&stem);
    let stem = match dots {
        0 => stem,
        1 => format!(r"\dot{{{stem}}}"),
        _ => format!(r"\ddot{{{stem}}}"),
    };
    let below: Vec<String> = below.iter().map(|part| latex_word(part)).collect();
    match below.as_slice() {
        [] => stem,
        [one] if one.chars().all(char::is_alphabetic) && one.len() == 1 => {
            format!("{stem}_{one}")
        }
        _ => format!("{stem}_{{{}}}", below.join(",")),
    }
}

/// Converts a name with its indices to MathML, by the rules of [`latex_name`].
pub fn mathml_name(name: &str) -> String {
    let Parts { stem, dots, below } = parts(name);
    let stem = mathml_word(&stem);
    let stem = match dots {
        0 => stem,
        1 => format!("<mover>{stem}<mo>˙</mo></mover>"),
        _ => format!("<mover>{stem}<mo>¨</mo></mover>"),
    };
    let below: Vec<String> = below.iter().map(|part| mathml_word(part)).collect();
    match below.as_slice() {
        [] => stem,
        _ => format!(
            "<msub>{stem}<mrow>{}</mrow></msub>",
            below.join("<mo>,</mo>")
        ),
    }
}

/// A name taken apart.
struct Parts {
    /// The letter or word that carries dots and subscripts.
    stem: String,
    /// Number of dots above it, 0 to 2.
    dots: usize,
    /// Subscripts.
    below: Vec<String>,
}

fn parts(name: &str) -> Parts {
    let (path, index) = match name.split_once('[') {
        Some((path, rest)) => (path, rest.trim_end_matches(']')),
        None => (name, ""),
    };
    let mut parts = path.split('.');
    let head = parts.next().unwrap_or_default();
    let (head, dots) = undot(head);
    let (stem, mut below) = split(head);
    below.extend(parts.map(str::to_string));
    let indices: Vec<&str> = index
        .split(',')
        .map(str::trim)
        .filter(|part| !part.is_empty())
        .collect();
    if !indices.is_empty() {
        let single = indices.iter().all(|index| index.len() == 1);
        below.push(indices.join(if single { "" } else { "," }));
    }
    Parts { stem, dots, below }
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
        below.push(rest.replace('_', ""));
        return (letter, below);
    }
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = &name[stem.len()..];
    if is_letter(stem) {
        let digits = (!digits.is_empty()).then(|| digits.to_string());
        return (stem.to_string(), digits.into_iter().collect());
    }
    (name.to_string(), Vec::new())
}

/// Whether a name is a single letter, or that of a Greek one.
fn is_letter(text: &str) -> bool {
    text.len() == 1 && text.chars().all(|c| c.is_ascii_alphabetic()) || greek(text).is_some()
}

/// Returns the name of the LaTeX command of a Greek letter, and the letter.
fn greek(text: &str) -> Option<&'static (&'static str, &'static str)> {
    GREEK
        .iter()
        .find(|(name, sign)| *name == text || *sign == text)
}

/// Returns a letter, digits with commas between them, or an upright word.
fn latex_word(text: &str) -> String {
    match greek(text) {
        Some((name, _)) => format!("\\{name}"),
        None if is_letter(text) || is_number(text) => text.to_string(),
        None => format!(r"\mathrm{{{}}}", text.replace('_', r"\_")),
    }
}

/// Returns the element for a letter or word, or for digits.
fn mathml_word(text: &str) -> String {
    match greek(text) {
        Some((_, sign)) => format!("<mi>{sign}</mi>"),
        None if is_number(text) => format!("<mn>{text}</mn>"),
        None => format!("<mi>{text}</mi>"),
    }
}

fn is_number(text: &str) -> bool {
    text.chars().all(|c| c.is_ascii_digit() || c == ',')
}
