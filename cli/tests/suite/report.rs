//! Reports: the formulas in their HTML are evaluated, and compared with the numbers of `hamel eval`.

use crate::common::{hamel, text};
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::tables::print::Notation;
use roxmltree::{Document, Node};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Values of symbols, by their MathML.
type Values = BTreeMap<String, f64>;

/// Largest difference between a formula and the number, relative to the largest entry of the table or 1.
const TOLERANCE: f64 = 1e-11;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Returns the descriptions of the gallery and of the tests; by default every third.
fn descriptions() -> Vec<PathBuf> {
    let folders = ["examples/gallery", "tests/models"].map(|folder| root().join(folder));
    let files = folders
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).expect("a folder"));
    let files = files.map(|file| file.expect("a file").path());
    let mut files: Vec<PathBuf> = files
        .filter(|file| file.extension().is_some_and(|ending| ending == "eom"))
        .collect();
    files.sort();
    let step = match std::env::var_os("HAMEL_ATTACK") {
        Some(_) => 1,
        None => 3,
    };
    files.into_iter().step_by(step).collect()
}

/// Writes the report of a file, and returns its text.
fn report(file: &Path, ending: &str) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report");
    std::fs::create_dir_all(&folder).expect("a folder");
    let name = file.file_stem().expect("a name").to_string_lossy();
    let out = folder.join(format!("{name}.{ending}"));
    let [given, out_path] = [file, &out].map(|path| path.to_string_lossy().to_string());
    let output = hamel(&["report", &given, "-o", &out_path], "");
    assert!(output.status.success(), "{}", text(&output.stderr));
    std::fs::read_to_string(&out).expect("a report")
}

#[test]
fn formulas_have_the_values_of_the_equations() {
    let mut compared = 0;
    for file in descriptions() {
        let html = report(&file, "html");
        let path = file.to_string_lossy().to_string();
        let output = hamel(&["eval", &path], "");
        let source = std::fs::read_to_string(&file).expect("a text");
        // Files that include others are read by their path alone.
        let Ok(generated) = from_text(&source) else {
            continue;
        };
        if !output.status.success() {
            continue;
        }
        let numbers: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let symbols = symbols(&generated, &numbers);
        for (heading, symbol, key) in [
            ("Velocities", "A", "A"),
            ("Mass matrix", "M", "M"),
            ("Conservative forces", "V", "potential_force"),
        ] {
            // Forces of `hamel eval` are those of the velocities that constraints leave.
            if symbol == "V" && numbers["frame"] != numbers["velocities"] {
                continue;
            }
            let Some(section) = html.split(&format!("<h2>{heading}</h2>")).nth(1) else {
                continue;
            };
            let section = section.split("</section>").next().expect("a section");
            compared += compare(&path, section, symbol, &numbers[key], &symbols);
        }
    }
    assert!(compared > 300, "{compared} entries compared");
}

/// Returns the values of all coordinates and parameters.
fn symbols(generated: &Generated, numbers: &Value) -> Values {
    let mut values = Values::new();
    let names = numbers["coordinates"].as_array().expect("names");
    let x = numbers["x"].as_array().expect("numbers");
    for (name, value) in names.iter().zip(x) {
        let name = Notation::MathMl.name(name.as_str().expect("a name"));
        values.insert(name, value.as_f64().expect("a number"));
    }
    let model = &generated.model;
    for group in &model.params {
        // Entries of a symmetric matrix occur twice.
        let mut entries = group.value.entries();
        let mut known = BTreeSet::new();
        entries.retain(|edge| known.insert(edge.node()));
        for (place, edge) in entries.into_iter().enumerate() {
            let symbols = model.graph.symbols().iter();
            let mut found = symbols.filter(|symbol| symbol.node == edge.node());
            let name = &found.next().expect("a symbol").name;
            let value = model.defaults[group.offset + place];
            values.insert(Notation::MathMl.name(name), value);
        }
    }
    values
}

/// Evaluates the formulas of a section, and compares the entries of a table with its numbers. Returns how many there were.
fn compare(path: &str, section: &str, symbol: &str, numbers: &Value, symbols: &Values) -> usize {
    let formulas: Vec<&str> = section
        .split("<math")
        .skip(1)
        .map(|rest| rest.split("</math>").next().expect("an end"))
        .collect();
    let mut values = symbols.clone();
    let mut matrix = None;
    let documents: Vec<String> = formulas
        .iter()
        .map(|inner| format!("<math{inner}</math>"))
        .collect();
    let parsed: Vec<Document> = documents
        .iter()
        .map(|text| Document::parse(text).unwrap_or_else(|why| panic!("{path}: {why}\n{text}")))
        .collect();
    // What is defined may stand below its use.
    let rows = parsed.iter().flat_map(|document| document.descendants());
    let mut rows: Vec<[Node; 2]> = rows
        .filter(|node| node.has_tag_name("mtr"))
        .filter_map(|row| match row.children().collect::<Vec<_>>()[..] {
            [left, equals, right] if source(equals).contains("<mo>=</mo>") => Some([left, right]),
            _ => None,
        })
        .collect();
    loop {
        let before = rows.len();
        rows.retain(|[left, right]| {
            let value = sequence(&right.children().collect::<Vec<_>>(), &values);
            if let Some(value) = value {
                values.insert(left.children().map(source).collect(), value);
            }
            value.is_none()
        });
        if rows.len() == before {
            break;
        }
    }
    for document in &parsed {
        let is_matrix = source(document.root_element()).contains("<mrow><mo>(</mo><mtable>")
            && source(document.root_element()).contains(&format!("<mi>{symbol}</mi><mo>=</mo>"));
        if is_matrix {
            matrix = Some(document);
        }
    }
    let mut count = 0;
    let mut check = |value: Option<f64>, expected: f64, size: f64, of: &str| {
        let value = value.unwrap_or_else(|| panic!("{path}: {symbol} {of} has no value"));
        let error = (value - expected).abs();
        assert!(
            error <= TOLERANCE * size,
            "{path}: {symbol} {of}: {value} for {expected}"
        );
        count += 1;
    };
    let rows: Vec<Vec<f64>> = match numbers {
        Value::Array(rows) => rows.iter().map(|row| match row {
            Value::Array(row) => row.iter().filter_map(Value::as_f64).collect(),
            number => number.as_f64().into_iter().collect(),
        }),
        _ => return 0,
    }
    .collect();
    let size = rows.iter().flatten().fold(1.0, |a: f64, b| a.max(b.abs()));
    if let Some(document) = matrix {
        let table = document
            .descendants()
            .find(|node| node.has_tag_name("mtable"));
        let table = table.expect("a matrix");
        for (i, row) in table.children().enumerate() {
            for (j, cell) in row.children().enumerate() {
                let cell: Vec<Node> = cell.children().collect();
                // Below the diagonal of a symmetric matrix.
                if !cell.is_empty() {
                    check(
                        sequence(&cell, &values),
                        rows[i][j],
                        size,
                        &format!("{i} {j}"),
                    );
                }
            }
        }
    } else if symbol == "V" {
        for (i, row) in rows.iter().enumerate() {
            let name = format!("<msub><mo>∂</mo><mn>{}</mn></msub><mi>V</mi>", i + 1);
            let value = values
                .get(&name)
                .copied()
                .or((row[0] == 0.0).then_some(0.0));
            check(value, row[0], size, &name);
        }
    }
    count
}

/// Returns the text of an element.
fn source<'a>(node: Node<'a, '_>) -> &'a str {
    &node.document().input_text()[node.range()]
}

/// Evaluates a sum of products; `None` if a symbol has no value yet.
fn sequence(nodes: &[Node], values: &Values) -> Option<f64> {
    let (mut sum, mut product, mut sign) = (0.0, None, 1.0);
    let mut rest = nodes
        .iter()
        .filter(|node| !node.has_tag_name("mspace"))
        .peekable();
    while let Some(node) = rest.next() {
        let operator = node.has_tag_name("mo").then(|| node.text().unwrap_or(""));
        if let Some(operator @ ("+" | "−")) = operator {
            sum += product.take().map_or(0.0, |product: f64| sign * product);
            sign = if operator == "−" { -1.0 } else { 1.0 };
            continue;
        }
        let factor = match function(*node) {
            Some((name, power))
                if rest
                    .peek()
                    .is_some_and(|next| next.text() == Some("\u{2061}")) =>
            {
                rest.next();
                let arguments = arguments(*rest.next()?, values)?;
                apply(&name, &arguments)?.powi(power)
            }
            _ => value(*node, values)?,
        };
        product = Some(product.unwrap_or(1.0) * factor);
    }
    Some(sum + sign * product?)
}

/// Returns the name and the power of a function.
fn function(node: Node) -> Option<(String, i32)> {
    if node.has_tag_name("mi") {
        return Some((node.text()?.to_string(), 1));
    }
    let base = node
        .has_tag_name("msup")
        .then(|| node.first_child())
        .flatten()?;
    let name = base.first_child().filter(|name| name.has_tag_name("mi"))?;
    let known = apply(name.text()?, &[0.5]).is_some();
    let power = node.last_child()?.text()?.parse().ok()?;
    known.then(|| (name.text().unwrap_or("").to_string(), power))
}

fn is_group(node: Node) -> bool {
    node.has_tag_name("mrow")
        && node
            .first_child()
            .is_some_and(|first| first.text() == Some("("))
}

/// Evaluates what stands in parentheses, between commas.
fn arguments(node: Node, values: &Values) -> Option<Vec<f64>> {
    let inside: Vec<Node> = node.children().collect();
    let inside = &inside[1..inside.len() - 1];
    let parts = inside.split(|part| part.has_tag_name("mo") && part.text() == Some(","));
    parts.map(|part| sequence(part, values)).collect()
}

fn apply(name: &str, arguments: &[f64]) -> Option<f64> {
    Some(match (name, arguments) {
        ("sin", [a]) => a.sin(),
        ("cos", [a]) => a.cos(),
        ("tan", [a]) => a.tan(),
        ("exp", [a]) => a.exp(),
        ("log1p", [a]) => a.ln_1p(),
        ("ln" | "log", [a]) => a.ln(),
        ("tanh", [a]) => a.tanh(),
        ("abs", [a]) => a.abs(),
        ("sign", [a]) => match *a == 0.0 {
            true => 0.0,
            false => a.signum(),
        },
        ("atan2", [y, x]) => y.atan2(*x),
        _ => return None,
    })
}

/// Evaluates an element.
fn value(node: Node, values: &Values) -> Option<f64> {
    if let Some(known) = values.get(source(node)) {
        return Some(*known);
    }
    let children: Vec<Node> = node.children().collect();
    match (node.tag_name().name(), children.as_slice()) {
        ("mn", _) => node.text()?.parse().ok(),
        ("mi", _) if node.text() == Some("π") => Some(std::f64::consts::PI),
        ("mfrac", [over, under]) => Some(value(*over, values)? / value(*under, values)?),
        ("msup", [base, power]) => Some(value(*base, values)?.powi(power.text()?.parse().ok()?)),
        ("msqrt", under) => Some(sequence(under, values)?.sqrt()),
        ("mrow", [brace, choice]) if brace.text() == Some("{") => {
            let cells: Vec<Node> = choice.children().flat_map(|row| row.children()).collect();
            let [then, condition, otherwise, _] = cells[..] else {
                return None;
            };
            let condition: Vec<Node> = condition.children().collect();
            let greater = condition.iter().position(|node| node.text() == Some(">"))?;
            let chosen = match sequence(&condition[..greater], values)? > 0.0 {
                true => then,
                false => otherwise,
            };
            sequence(&chosen.children().collect::<Vec<_>>(), values)
        }
        ("mrow", [_, inside @ .., _]) if is_group(node) => sequence(inside, values),
        ("mrow", inside) => sequence(inside, values),
        _ => None,
    }
}

#[test]
fn documents_are_ascii_with_balanced_groups() {
    for file in descriptions() {
        let tex = report(&file, "tex");
        let path = file.display();
        // Letters with accents are known to LaTeX.
        let is_known = |letter: char| letter.is_ascii() || ('À'..='ɏ').contains(&letter);
        let strange: String = tex.chars().filter(|letter| !is_known(*letter)).collect();
        assert!(
            strange.is_empty() && !tex.contains("[U+"),
            "{path}: {strange}"
        );
        let plain = tex.replace(r"\{", "").replace(r"\}", "");
        assert_eq!(
            plain.matches('{').count(),
            plain.matches('}').count(),
            "{path}"
        );
        let dollars = plain.replace(r"\$", "").matches('$').count();
        assert_eq!(dollars % 2, 0, "{path}");
        for name in ["align*", "pmatrix", "longtable", "document"] {
            let [opened, closed] =
                ["begin", "end"].map(|word| tex.matches(&format!(r"\{word}{{{name}}}")).count());
            assert_eq!(opened, closed, "{path}: {name}");
        }
    }
}

#[test]
fn other_endings_are_refused() {
    let file = root().join("examples/gallery/furuta.eom");
    let output = hamel(&["report", &file.to_string_lossy(), "-o", "furuta.pdf"], "");
    assert_eq!(output.status.code(), Some(2));
    let said = text(&output.stderr);
    assert!(
        said.contains("a report is an `.html` or a `.tex` file"),
        "{said}"
    );
}
