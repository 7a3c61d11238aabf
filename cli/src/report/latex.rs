//! Reports as documents for pdfLaTeX, in ASCII but for letters with accents; they need the packages amsmath and longtable.

use super::document::{Block, Document};
use hamel_codegen::tables::display::{Display, signs};

const PREAMBLE: &str = r"\documentclass{article}
\usepackage[a4paper,margin=25mm]{geometry}
\usepackage{amsmath,amssymb,longtable}
\setlength{\parindent}{0pt}
\setlength{\parskip}{6pt}
\allowdisplaybreaks
\setcounter{MaxMatrixCols}{12}
";

/// Number of signs after which a formula is broken.
const MAX_LINE_LENGTH: usize = 70;

/// Letters and signs with their LaTeX; what stands in `$` is mathematics.
const SIGNS: &[(char, &str)] = &[
    ('α', r"$\alpha$"),
    ('β', r"$\beta$"),
    ('γ', r"$\gamma$"),
    ('δ', r"$\delta$"),
    ('ε', r"$\varepsilon$"),
    ('ζ', r"$\zeta$"),
    ('η', r"$\eta$"),
    ('θ', r"$\theta$"),
    ('κ', r"$\kappa$"),
    ('λ', r"$\lambda$"),
    ('μ', r"$\mu$"),
    ('ν', r"$\nu$"),
    ('ξ', r"$\xi$"),
    ('π', r"$\pi$"),
    ('ρ', r"$\rho$"),
    ('σ', r"$\sigma$"),
    ('τ', r"$\tau$"),
    ('φ', r"$\varphi$"),
    ('χ', r"$\chi$"),
    ('ψ', r"$\psi$"),
    ('ω', r"$\omega$"),
    ('Γ', r"$\Gamma$"),
    ('Δ', r"$\Delta$"),
    ('Θ', r"$\Theta$"),
    ('Λ', r"$\Lambda$"),
    ('Σ', r"$\Sigma$"),
    ('Φ', r"$\Phi$"),
    ('Ψ', r"$\Psi$"),
    ('Ω', r"$\Omega$"),
    ('ᵢ', "$_{i}$"),
    ('ⱼ', "$_{j}$"),
    ('ₖ', "$_{k}$"),
    ('ₛ', "$_{s}$"),
    ('ₚ', "$_{p}$"),
    ('₀', "$_{0}$"),
    ('₁', "$_{1}$"),
    ('₂', "$_{2}$"),
    ('₃', "$_{3}$"),
    ('ⁱ', "$^{i}$"),
    ('ʲ', "$^{j}$"),
    ('ᵏ', "$^{k}$"),
    ('ˢ', "$^{s}$"),
    ('ˡ', "$^{l}$"),
    ('ᵀ', "$^{T}$"),
    ('ᴱ', "$^{E}$"),
    ('⁰', "$^{0}$"),
    ('¹', "$^{1}$"),
    ('²', "$^{2}$"),
    ('³', "$^{3}$"),
    ('⁴', "$^{4}$"),
    ('⁶', "$^{6}$"),
    ('⁻', "$^{-}$"),
    ('ₐ', "$_{a}$"),
    ('½', r"$\tfrac12$"),
    ('∂', r"$\partial$"),
    ('∇', r"$\nabla$"),
    ('√', r"$\surd$"),
    ('⟨', r"$\langle$"),
    ('⟩', r"$\rangle$"),
    ('‖', r"$\|$"),
    ('−', "$-$"),
    ('·', r"$\cdot$"),
    ('×', r"$\times$"),
    ('⊕', r"$\oplus$"),
    ('⊗', r"$\otimes$"),
    ('±', r"$\pm$"),
    ('≤', r"$\le$"),
    ('≥', r"$\ge$"),
    ('≠', r"$\ne$"),
    ('≈', r"$\approx$"),
    ('→', r"$\to$"),
    ('∈', r"$\in$"),
    ('ẋ', r"$\dot{x}$"),
    ('Ċ', r"$\dot{C}$"),
    ('Ṁ', r"$\dot{M}$"),
    ('ṁ', r"$\dot{m}$"),
    ('ẏ', r"$\dot{y}$"),
    ('ż', r"$\dot{z}$"),
    ('ṗ', r"$\dot{p}$"),
    ('ṙ', r"$\dot{r}$"),
    ('ℓ', r"$\ell$"),
    ('°', r"$^\circ$"),
    ('…', r"\dots{}"),
    ('“', "``"),
    ('”', "''"),
    ('–', "--"),
    ('«', "\""),
    ('»', "\""),
    ('\\', r"\textbackslash{}"),
    ('{', r"\{"),
    ('}', r"\}"),
    ('_', r"\_"),
    ('^', r"\^{}"),
    ('&', r"\&"),
    ('%', r"\%"),
    ('#', r"\#"),
    ('$', r"\$"),
    ('~', r"\~{}"),
    ('<', "$<$"),
    ('>', "$>$"),
    ('|', "$|$"),
];

/// Dots above a letter, which follow it as characters of their own.
const DOTS: [(char, &str); 2] = [('\u{307}', "dot"), ('\u{308}', "ddot")];

/// Writes the document.
pub fn write(document: &Document) -> String {
    let title = escape(&format!("{}: equations of motion", document.system));
    let mut text = format!(
        "{PREAMBLE}\\title{{{title}}}\n\\date{{}}\n\\begin{{document}}\n\\maketitle\n{}\n",
        escape(super::document::SOURCE)
    );
    for section in &document.sections {
        text.push_str(&format!("\n\\section{{{}}}\n", section.heading));
        for block in &section.blocks {
            text.push_str(&written(block));
        }
    }
    text.push_str("\n\\end{document}\n");
    text
}

fn written(block: &Block) -> String {
    match block {
        Block::Paragraph(text) => format!("{}\n", escape(text)),
        Block::Lines(text) => {
            let lines: Vec<String> = text.lines().map(fixed_width).collect();
            format!(
                "\n{{\\small\\ttfamily\\raggedright\n{}\\par}}\n",
                lines.join("\\\\\n")
            )
        }
        Block::Table(heads, rows) => {
            let row = |cells: Vec<String>| format!("{} \\\\\n", cells.join(" & "));
            let head = row(heads.iter().map(|head| escape(head)).collect());
            let rows = rows
                .iter()
                .map(|cells| row(cells.iter().map(|cell| escape(cell)).collect()));
            // The last column breaks its lines if there are words in it.
            let columns = match heads.len() {
                0..=2 => "lp{110mm}".to_string(),
                3 => "lp{75mm}p{50mm}".to_string(),
                count => format!("l{}", "r".repeat(count - 1)),
            };
            format!(
                "\\begin{{longtable}}{{{columns}}}\n{head}\\hline\n{}\\end{{longtable}}\n",
                rows.collect::<String>()
            )
        }
        Block::Formulas(Display::Matrix { symbol, rows }) => {
            let rows: Vec<String> = rows.iter().map(|cells| cells.join(" & ")).collect();
            format!(
                "\\[\n{symbol} = \\begin{{pmatrix}}\n  {}\n\\end{{pmatrix}}\n\\]\n",
                rows.join(" \\\\\n  ")
            )
        }
        Block::Formulas(Display::Equations(list)) => {
            let rows: Vec<String> = list
                .iter()
                .map(|[left, right]| {
                    format!("{left} &= {}", lines(right).join(" \\\\\n  &\\quad "))
                })
                .collect();
            format!(
                "\\begin{{align*}}\n  {}\n\\end{{align*}}\n",
                rows.join(" \\\\\n  ")
            )
        }
    }
}

/// Breaks a formula at signs of sums outside of braces, where it is longer than a line.
fn lines(formula: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut depth = 0_i32;
    for part in formula.split_inclusive(' ') {
        let is_sign = matches!(part, "+ " | "- ");
        let begun = lines.last().map_or(0, |line| signs(line));
        if is_sign && depth == 0 && begun > MAX_LINE_LENGTH {
            if let Some(line) = lines.last_mut() {
                line.truncate(line.trim_end().len());
            }
            lines.push(String::new());
        }
        depth += part.matches(['{']).count() as i32 - part.matches('}').count() as i32;
        depth += part.matches(r"\left").count() as i32 - part.matches(r"\right").count() as i32;
        if let Some(line) = lines.last_mut() {
            line.push_str(part);
        }
    }
    lines
}

/// Returns a line whose columns are kept; it may be broken at single spaces.
fn fixed_width(line: &str) -> String {
    let escaped = escape(line).replace("  ", "~~");
    match escaped.is_empty() {
        true => "~".into(),
        false => format!("\\mbox{{}}{escaped}"),
    }
}

/// Returns plain text in LaTeX; a character without a counterpart is given by its code point.
fn escape(text: &str) -> String {
    let mut escaped = String::new();
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        let written = match SIGNS.iter().find(|(sign, _)| *sign == letter) {
            Some((_, written)) => (*written).to_string(),
            None if letter.is_ascii() || ('À'..='ɏ').contains(&letter) => letter.to_string(),
            None => format!("[U+{:04X}]", letter as u32),
        };
        let above = letters
            .peek()
            .and_then(|next| DOTS.iter().find(|(dot, _)| dot == next));
        match above {
            Some((_, accent)) => {
                letters.next();
                escaped.push_str(&format!("$\\{accent}{{{}}}$", written.trim_matches('$')));
            }
            // Neighbouring subscripts, or superscripts, are one.
            None if written.starts_with("$_{") && is_script(&escaped, "_{")
                || written.starts_with("$^{") && is_script(&escaped, "^{") =>
            {
                escaped.truncate(escaped.len() - "}$".len());
                escaped.push_str(&written["$_{".len()..]);
            }
            None => escaped.push_str(&written),
        }
    }
    escaped.replace("$$", "")
}

/// Whether a text ends in a subscript or superscript.
fn is_script(text: &str, opening: &str) -> bool {
    let formula = text
        .strip_suffix("}$")
        .and_then(|rest| rest.rsplit_once('$'));
    formula.is_some_and(|(_, formula)| formula.starts_with(opening))
}
