//! Base parameters as text, Markdown, LaTeX and JSON.

use super::entries::Definition;
use super::expression::Term;
use super::naming::Temporaries;
use super::notation::latex_name;
use super::print::Notation;
use super::simplify::Simplifier;
use super::style::Style;
use super::write::Writer;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::numeric::evaluate;
use hamel_dynamics::regressor::{
    DIAGONAL_PARAMETERS, ParameterKind, Regressor, SECOND_MOMENT_NAMES, StandardParameter,
};
use hamel_program::count::count;
use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use serde_json::{Value, json as object};

/// Largest number of decimal places of a factor; others are written as fractions.
const MAX_DECIMAL_PLACES: u32 = 12;

/// Returns the pseudo-inertia `[[tr(Θ)/2 I − Θ, h], [hᵀ, m]]` of a link from its ten standard parameters. It is
/// positive definite for every physical body (Wensing, Kim and Slotine 2018).
pub fn pseudo_inertia(ten: [f64; 10]) -> [[f64; 4]; 4] {
    let [xx, xy, xz, yy, yz, zz, x, y, z, m] = ten;
    let half = (xx + yy + zz) / 2.0;
    [
        [half - xx, -xy, -xz, x],
        [-xy, half - yy, -yz, y],
        [-xz, -yz, half - zz, z],
        [x, y, z, m],
    ]
}

/// A base parameter with its factors as expressions.
struct Row {
    name: String,
    kind: ParameterKind,
    value: f64,
    /// Terms of the sum: index of the standard parameter, factor, and the factor's number.
    terms: Vec<(usize, Term, f64)>,
    /// The same sum as it is shown: with second moments instead of Θ_xx, Θ_yy and Θ_zz of a link if that is shorter.
    shown: Vec<(Shown, Term)>,
}

/// A parameter as shown in a sum.
#[derive(Clone, Copy)]
enum Shown {
    /// A standard parameter, by its index.
    StandardParameter(usize),
    /// Σ_xx, Σ_yy or Σ_zz of a link: index of the link's first standard parameter, and axis.
    Moment(usize, usize),
}

/// Returns a sum of standard parameters as it is shown.
fn shown(
    graph: &mut Graph,
    standard: &[StandardParameter],
    terms: &[(usize, Edge)],
) -> Vec<(Shown, Edge)> {
    let zero = graph.zero();
    let first = |k: usize| match standard[k].kind {
        ParameterKind::Inertia(place) if DIAGONAL_PARAMETERS.contains(&place) => Some(k - place),
        _ => None,
    };
    let mut all = Vec::new();
    let mut done = Vec::new();
    for &(k, factor) in terms {
        let Some(link) = first(k) else {
            all.push((Shown::StandardParameter(k), factor));
            continue;
        };
        if done.contains(&link) {
            continue;
        }
        done.push(link);
        let of = |place: usize| terms.iter().find(|(k, _)| *k == link + place);
        let inertia =
            DIAGONAL_PARAMETERS.map(|place| of(place).map_or(zero, |&(_, factor)| factor));
        // Θ_xx = Σ_yy + Σ_zz, and so on.
        let moments: [Edge; 3] =
            std::array::from_fn(|i| graph.add(inertia[(i + 1) % 3], inertia[(i + 2) % 3]));
        let count = |factors: &[Edge; 3]| factors.iter().filter(|&&factor| factor != zero).count();
        let fewer = count(&moments) < count(&inertia);
        for (axis, place) in DIAGONAL_PARAMETERS.into_iter().enumerate() {
            all.push(match fewer {
                true => (Shown::Moment(link, axis), moments[axis]),
                false => (Shown::StandardParameter(link + place), inertia[axis]),
            });
        }
    }
    all.retain(|&(_, factor)| factor != zero);
    all
}

/// The base parameters of a system, ready to be printed.
pub struct BaseParameters {
    system: String,
    velocities: usize,
    links: Vec<String>,
    standard: Vec<StandardParameter>,
    values: Vec<f64>,
    rows: Vec<Row>,
    idle: Vec<usize>,
    besides: Vec<&'static str>,
    definitions: Vec<Definition>,
    /// Cost of evaluating Y: number of products, sums and quotients.
    operations: usize,
}

impl BaseParameters {
    /// Writes out the base parameters. Numeric values use the default values of run-time parameters, and the number π.
    pub fn new(regressor: &Regressor) -> Self {
        let model = &regressor.model;
        let mut graph = model.graph.clone();
        let sums = regressor
            .base
            .iter()
            .map(|base| shown(&mut graph, &regressor.standard, &base.terms));
        let sums: Vec<Vec<(Shown, Edge)>> = sums.collect();
        let factors = regressor.base.iter().flat_map(|base| base.terms.iter());
        let mut roots: Vec<Edge> = factors.map(|&(_, factor)| factor).collect();
        roots.extend(sums.iter().flatten().map(|&(_, factor)| factor));
        let mut simplifier = Simplifier::free(&model.points);
        let names = Temporaries::new(&graph, &roots, &[]);
        let mut writer = Writer::new(&graph, &mut simplifier, Style::Table, names);
        writer.prepare(&roots);
        let numbers = model.numbers(&model.defaults, &[], &[], &[], &[]);
        let number = |edges: &[Edge]| evaluate(&graph, edges, &numbers);
        let standard: Vec<Edge> = regressor.standard.iter().map(|one| one.value).collect();
        let values = number(&standard);
        let rows = regressor.base.iter().zip(sums).map(|(base, sum)| {
            let shown = sum.into_iter();
            let shown = shown.map(|(what, factor)| (what, writer.value(factor)));
            let shown = shown.collect();
            let terms = base
                .terms
                .iter()
                .map(|&(k, factor)| (k, writer.value(factor), number(&[factor])[0]));
            let terms: Vec<(usize, Term, f64)> = terms.collect();
            Row {
                name: base.name.clone(),
                kind: base.kind,
                value: terms.iter().map(|(k, _, factor)| factor * values[*k]).sum(),
                terms,
                shown,
            }
        });
        let rows = rows.collect();
        let (mut definitions, rest) = writer.definitions();
        definitions.extend(rest);
        let columns = regressor.base.iter().map(|base| &base.column);
        let columns: Vec<Edge> = columns.flatten().copied().collect();
        BaseParameters {
            operations: count(&model.graph, &columns).flops(),
            system: model.name.clone(),
            velocities: model.n(),
            links: regressor.links.clone(),
            standard: regressor.standard.clone(),
            values,
            rows,
            idle: regressor.idle.clone(),
            besides: regressor.besides.clone(),
            definitions,
        }
    }

    /// The standard parameters: ten for each link, followed by those of joints.
    pub fn standard(&self) -> &[StandardParameter] {
        &self.standard
    }

    /// Values of the standard parameters in the description.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Names of the frames that represent the links.
    pub fn links(&self) -> &[String] {
        &self.links
    }

    /// Names of the base parameters.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.rows.iter().map(|row| row.name.as_str())
    }

    /// Returns K in β = K π, where π are the standard parameters: indices and factors of the terms of each base
    /// parameter.
    pub fn map(&self) -> Vec<Vec<(usize, f64)>> {
        let row = |row: &Row| {
            row.terms
                .iter()
                .map(|&(k, _, factor)| (k, factor))
                .collect()
        };
        self.rows.iter().map(row).collect()
    }

    /// Counts the base parameters of inertia and those of joints.
    fn counts(&self) -> (usize, usize) {
        let inertial = |row: &&Row| matches!(row.kind, ParameterKind::Inertia(_));
        let own = self.rows.iter().filter(inertial).count();
        (own, self.rows.len() - own)
    }

    fn summary(&self) -> String {
        let (inertial, joints) = self.counts();
        let of_joints = match joints {
            0 => String::new(),
            _ => format!(", {inertial} of inertia and {joints} of joints"),
        };
        format!(
            "{} base parameters of {} standard parameters{of_joints}; {} velocities; Y takes {} operations",
            self.rows.len(),
            self.standard.len(),
            self.velocities,
            self.operations
        )
    }

    /// Whether the pseudo-inertia of a link in the description is positive definite, by Cholesky factorization.
    fn is_consistent(&self, link: usize) -> bool {
        let mut rows = pseudo_inertia(std::array::from_fn(|k| self.values[10 * link + k]));
        for k in (0..4).rev() {
            let pivot = rows[k][k];
            if pivot.is_nan() || pivot <= 0.0 {
                return false;
            }
            for i in 0..k {
                for j in 0..k {
                    rows[i][j] -= rows[i][k] * rows[k][j] / pivot;
                }
            }
        }
        true
    }

    fn join_names(&self, places: &[usize]) -> String {
        let names: Vec<String> = places.iter().map(|&k| self.standard[k].name()).collect();
        names.join(", ")
    }

    /// Returns the sign and the absolute value of a factor; the value is empty for 1.
    fn factor(term: &Term, notation: Notation) -> (char, String) {
        let sign = if term.is_negative() { '-' } else { '+' };
        let positive = if term.is_negative() {
            term.clone().negated()
        } else {
            term.clone()
        };
        let text = decimal(&positive).unwrap_or_else(|| notation.term(&positive));
        (sign, if text == "1" { String::new() } else { text })
    }

    fn sum(&self, row: &Row, notation: Notation) -> String {
        let mut text = String::new();
        for (place, (what, term)) in row.shown.iter().enumerate() {
            let (sign, factor) = Self::factor(term, notation);
            if place > 0 || sign == '-' {
                text.push_str(&format!(" {sign} "));
            }
            let name = match (*what, notation) {
                (Shown::StandardParameter(k), Notation::Text) => self.standard[k].name(),
                (Shown::StandardParameter(k), _) => symbol(&self.standard[k]),
                (Shown::Moment(k, axis), Notation::Text) => {
                    format!("{}.{}", self.standard[k].of, SECOND_MOMENT_NAMES[axis])
                }
                (Shown::Moment(k, axis), _) => {
                    let of = self.standard[k].of.replace('_', r"\_");
                    let axes = ["xx", "yy", "zz"][axis];
                    format!(r"\Sigma_{{{axes}}}^{{\text{{{of}}}}}")
                }
            };
            let is_sum = term.bare_sum().is_some();
            text.push_str(&match (factor.as_str(), notation) {
                ("", _) => name,
                (factor, Notation::Text) if is_sum => format!("({factor})*{name}"),
                (factor, Notation::Text) => format!("{factor}*{name}"),
                (factor, _) if is_sum => format!(r"({factor})\,{name}"),
                (factor, _) => format!(r"{factor}\,{name}"),
            });
        }
        text.trim_start().to_string()
    }
}

/// Returns a positive non-integer number as an exact decimal, if it has few decimal places.
fn decimal(term: &Term) -> Option<String> {
    if !term.over.is_empty() || !term.under.is_empty() || term.coefficient.is_integer() {
        return None;
    }
    (1..=MAX_DECIMAL_PLACES).find_map(|places| {
        let power = BigInt::from(10).pow(places);
        let digits = &term.coefficient * BigRational::from_integer(power.clone());
        let (whole, rest) = digits
            .is_integer()
            .then(|| digits.to_integer().div_rem(&power))?;
        Some(format!(
            "{whole}.{:0>width$}",
            rest.to_string(),
            width = places as usize
        ))
    })
}

const CONDITIONS: &str = "Physically consistent where for each link the pseudo-inertia [[tr(Theta)/2 I - Theta, h], [h^T, m]] is positive definite";

/// Prints the base parameters as text.
pub fn text(all: &BaseParameters) -> String {
    let mut text = format!("{}: {}\n", all.system, all.summary());
    text.push_str("F = Y(x, xi, xi_dot) beta: the force that a motion needs; Theta about the frame's origin, h = m s, Sigma = tr(Theta)/2 I - Theta\n");
    if !all.definitions.is_empty() {
        text.push('\n');
    }
    for definition in &all.definitions {
        text.push_str(&format!(
            "  {} = {}\n",
            definition.name,
            Notation::Text.term(&definition.value)
        ));
    }
    text.push('\n');
    for (place, row) in all.rows.iter().enumerate() {
        let sum = all.sum(row, Notation::Text);
        text.push_str(&format!("  beta[{}] = {sum}\n", place + 1));
    }
    text.push_str(&rest(all, "\n"));
    text
}

/// Lists the parameters without effect, the other forces that act, and the conditions of physical consistency.
fn rest(all: &BaseParameters, between: &str) -> String {
    let mut text = String::new();
    if !all.idle.is_empty() {
        text.push_str(&format!(
            "{between}Without effect: {}\n",
            all.join_names(&all.idle)
        ));
    }
    if !all.besides.is_empty() {
        text.push_str(&format!(
            "{between}Acts in addition, and is not part of F: {}\n",
            all.besides.join(", ")
        ));
    }
    let broken: Vec<&str> = (0..all.links.len())
        .filter(|&link| !all.is_consistent(link))
        .map(|link| all.links[link].as_str())
        .collect();
    let verdict = match broken.as_slice() {
        [] => "the values of the description are".to_string(),
        links => format!(
            "the values of the description are not, for {}",
            links.join(", ")
        ),
    };
    text.push_str(&format!("{between}{CONDITIONS}: {verdict}\n"));
    text
}

/// Prints the base parameters as Markdown.
pub fn markdown(all: &BaseParameters) -> String {
    let mut text = format!("## {}\n\n{}\n\n", all.system, all.summary());
    for definition in &all.definitions {
        text.push_str(&format!(
            "- `{} = {}`\n",
            definition.name,
            Notation::Text.term(&definition.value)
        ));
    }
    if !all.definitions.is_empty() {
        text.push('\n');
    }
    text.push_str("| β | standard parameters | value |\n|---|---|---|\n");
    for (place, row) in all.rows.iter().enumerate() {
        let sum = all.sum(row, Notation::Text);
        text.push_str(&format!("| β{} | `{sum}` | {} |\n", place + 1, row.value));
    }
    text.push_str(&rest(all, "\n"));
    text
}

/// Prints the base parameters as LaTeX, in lines of an `align*`.
pub fn latex(all: &BaseParameters) -> String {
    let mut text = format!("% {}: {}\n\\begin{{align*}}\n", all.system, all.summary());
    let definitions = all.definitions.iter().map(|definition| {
        let value = Notation::Latex.term(&definition.value);
        format!("  {} &= {value}", latex_name(&definition.name))
    });
    let rows = all.rows.iter().enumerate().map(|(place, row)| {
        let sum = all.sum(row, Notation::Latex);
        format!("  \\beta_{{{}}} &= {sum}", place + 1)
    });
    let lines: Vec<String> = definitions.chain(rows).collect();
    text.push_str(&lines.join(" \\\\\n"));
    text.push_str("\n\\end{align*}\n");
    for line in rest(all, "").lines() {
        text.push_str(&format!("% {line}\n"));
    }
    text
}

/// Returns the LaTeX symbol of a standard parameter, such as Θ_{xx}^{\text{link}} for Θ_xx of a link.
fn symbol(standard: &StandardParameter) -> String {
    let of = standard.of.replace('_', r"\_");
    let own = match standard.kind {
        ParameterKind::Inertia(9) => "m".to_string(),
        ParameterKind::Inertia(place @ 6..) => format!("h_{{{}}}", ["x", "y", "z"][place - 6]),
        ParameterKind::Inertia(place) => format!(
            r"\Theta_{{{}}}",
            ["xx", "xy", "xz", "yy", "yz", "zz"][place]
        ),
        ParameterKind::Armature => "J".into(),
        ParameterKind::Damping => "c".into(),
        ParameterKind::Stiffness => "k".into(),
    };
    format!(r"{own}^{{\text{{{of}}}}}")
}

/// Returns the base parameters as JSON.
pub fn json(all: &BaseParameters) -> Value {
    let standard: Vec<Value> = all
        .standard
        .iter()
        .zip(&all.values)
        .map(|(one, value)| object!({ "name": one.name(), "value": value }))
        .collect();
    let base: Vec<Value> = all
        .rows
        .iter()
        .map(|row| {
            let terms = row.terms.iter().map(|(k, factor, number)| {
                object!({
                    "parameter": all.standard[*k].name(),
                    "factor": Notation::Text.term(factor),
                    "number": number,
                })
            });
            object!({
                "kept": row.name,
                "terms": terms.collect::<Vec<Value>>(),
                "value": row.value,
            })
        })
        .collect();
    let definitions: Vec<Value> = all
        .definitions
        .iter()
        .map(|one| object!({ "name": one.name, "value": Notation::Text.term(&one.value) }))
        .collect();
    let links = all
        .links
        .iter()
        .enumerate()
        .map(|(link, name)| object!({ "frame": name, "consistent": all.is_consistent(link) }));
    let (inertial, joints) = all.counts();
    object!({
        "system": all.system,
        "velocities": all.velocities,
        "count": all.rows.len(),
        "operations": all.operations,
        "inertial": inertial,
        "of_joints": joints,
        "definitions": definitions,
        "base": base,
        "standard": standard,
        "without_effect": all.idle.iter().map(|&k| all.standard[k].name()).collect::<Vec<_>>(),
        "besides": all.besides,
        "condition": CONDITIONS,
        "links": links.collect::<Vec<Value>>(),
    })
}
