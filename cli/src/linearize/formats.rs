//! Matrices of a linear system as CSV, and as programs for MATLAB and python-control.

use crate::linear::rows;
use hamel_engine::LinearSystem;
use hamel_engine::linear::Matrix;
use hamel_files::number::exact;

/// Returns [A B; C D] with the names of its rows and columns; the first line names the columns.
pub fn csv(system: &LinearSystem) -> String {
    let quoted = |name: &String| match name.contains(',') {
        true => format!("\"{name}\""),
        false => name.clone(),
    };
    let line = |first: String, cells: Vec<String>| {
        format!("{}\n", [vec![first], cells].concat().join(","))
    };
    let columns = system.states.iter().chain(&system.inputs).map(quoted);
    let mut text = line(String::new(), columns.collect());
    let parts = &system.matrices;
    for (names, left, right) in [
        (&system.states, &parts.a, &parts.b),
        (&system.outputs, &parts.c, &parts.d),
    ] {
        for ((name, left), right) in names.iter().zip(rows(left)).zip(rows(right)) {
            let cells = left.into_iter().chain(right).map(exact);
            text += &line(quoted(name), cells.collect());
        }
    }
    text
}

/// Syntax of a linear system in another language.
struct Dialect {
    /// Start of a comment.
    comment: &'static str,
    /// Lines before the matrices.
    opening: &'static str,
    /// A matrix, by what stands before its rows, each row, between its rows, and after them.
    rows: [&'static str; 4],
    /// Between the entries of a row.
    entries: &'static str,
    /// A matrix without entries, by its number of rows and columns.
    empty: &'static str,
    /// The system, from its matrices and, in steps, their length.
    system: [&'static str; 2],
    /// Arguments for the names of states, inputs and outputs, and brackets of lists.
    names: [&'static str; 3],
    list: [&'static str; 2],
    /// After each statement.
    end: &'static str,
}

const MATLAB: Dialect = Dialect {
    comment: "%",
    opening: "",
    rows: ["[\n", "    ", "\n", "\n];\n"],
    entries: " ",
    empty: "zeros({rows}, {columns});\n",
    system: ["sys = ss(A, B, C, D", "sys = ss(A, B, C, D, {step}"],
    names: [
        ", ...\n    'StateName', ",
        ", ...\n    'InputName', ",
        ", ...\n    'OutputName', ",
    ],
    list: ["{", "}"],
    end: ");\n",
};

const PYTHON: Dialect = Dialect {
    comment: "#",
    opening: "import control\nimport numpy as np\n\n",
    rows: ["np.array([\n", "    [", "],\n", "],\n])\n"],
    entries: ", ",
    empty: "np.zeros(({rows}, {columns}))\n",
    system: [
        "sys = control.ss(A, B, C, D",
        "sys = control.ss(A, B, C, D, {step}",
    ],
    names: [",\n    states=", ",\n    inputs=", ",\n    outputs="],
    list: ["[", "]"],
    end: ")\n",
};

/// Returns a script for MATLAB, or for Octave with its package `control`.
pub fn matlab(name: &str, system: &LinearSystem) -> String {
    program(&MATLAB, name, system)
}

/// Returns a program for Python with python-control.
pub fn python(name: &str, system: &LinearSystem) -> String {
    program(&PYTHON, name, system)
}

fn program(dialect: &Dialect, name: &str, system: &LinearSystem) -> String {
    let parts = &system.matrices;
    let (n, m) = parts.b.shape();
    // Without outputs the states are shown.
    let (outputs, c, d) = match system.outputs.is_empty() {
        true => (&system.states, Matrix::identity(n, n), Matrix::zeros(n, m)),
        false => (&system.outputs, parts.c.clone(), parts.d.clone()),
    };
    let kind = if system.step.is_some() {
        "x+ = A x + B u"
    } else {
        "dx/dt = A x + B u"
    };
    let mut text = format!(
        "{} Linearisation of {name}: {kind}, y = C x + D u.\n{}",
        dialect.comment, dialect.opening
    );
    for (name, matrix) in [("A", &parts.a), ("B", &parts.b), ("C", &c), ("D", &d)] {
        let [before, row, between, after] = dialect.rows;
        let lines = rows(matrix).into_iter().map(|entries| {
            let entries: Vec<String> = entries.into_iter().map(exact).collect();
            format!("{row}{}", entries.join(dialect.entries))
        });
        let written = match matrix.is_empty() {
            true => (dialect.empty)
                .replace("{rows}", &matrix.nrows().to_string())
                .replace("{columns}", &matrix.ncols().to_string()),
            false => format!("{before}{}{after}", lines.collect::<Vec<_>>().join(between)),
        };
        text += &format!("{name} = {written}");
    }
    text += &match system.step {
        Some(step) => dialect.system[1].replace("{step}", &exact(step)),
        None => dialect.system[0].into(),
    };
    for (argument, names) in
        dialect
            .names
            .into_iter()
            .zip([&system.states, &system.inputs, outputs])
    {
        let names: Vec<String> = names.iter().map(|name| format!("'{name}'")).collect();
        let [open, close] = dialect.list;
        text += &format!("{argument}{open}{}{close}", names.join(", "));
    }
    text + dialect.end
}
