//! The kinds of tables.

use super::error::TableError;

/// A kind of table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Table {
    /// φ(x), ν − n or more rows.
    Phi,
    /// A(x), ν×n.
    A,
    /// Y(x), n×ν.
    Y,
    /// Φ(x), (ν−n)×ν.
    Gradient,
    /// Ψ(x), ν×(ν−n).
    Psi,
    /// γᵢⱼᵏ.
    Gamma,
    /// M(x), n×n.
    Mass,
    /// Γᵢⱼₖ.
    Connection,
    /// ξ̇ as it is computed by the generated code.
    Accel,
    /// Γᵢⱼₖ ξʲ ξᵏ.
    Bias,
    /// ∂ᵢV.
    PotentialForce,
    /// Generalised forces fᵢ of the applied loads.
    GeneralizedForce,
    /// ż, the rates of the states of first order.
    States,
    /// The outputs of the description.
    Outputs,
    /// A report on the geometry instead of coefficients.
    Geometry,
}

struct Row {
    table: Table,
    name: &'static str,
    symbol: &'static str,
    latex: &'static str,
    indices: &'static str,
    title: &'static str,
}

const fn row(
    table: Table,
    name: &'static str,
    symbol: &'static str,
    latex: &'static str,
    indices: &'static str,
    title: &'static str,
) -> Row {
    Row {
        table,
        name,
        symbol,
        latex,
        indices,
        title,
    }
}

const ROWS: [Row; 15] = [
    row(
        Table::Phi,
        "phi",
        "φ",
        r"\varphi",
        "κ",
        "geometric constraint, φ(x) = 0",
    ),
    row(Table::A, "A", "A", "A", "αi", "kinematic map, ẋ = A ξ"),
    row(Table::Y, "Y", "Y", "Y", "iα", "left inverse, ξ = Y ẋ"),
    row(
        Table::Gradient,
        "Phi",
        "Φ",
        r"\Phi",
        "κα",
        "independent rows of ∂φ/∂x, Φ A = 0",
    ),
    row(
        Table::Psi,
        "Psi",
        "Ψ",
        r"\Psi",
        "ακ",
        "completes the inverse, [A Ψ] = [Y; Φ]⁻¹",
    ),
    row(
        Table::Gamma,
        "gamma",
        "γ",
        r"\gamma",
        "ijk",
        "Hamel coefficients γᵢⱼᵏ, ∂ᵢ∂ⱼ − ∂ⱼ∂ᵢ = γᵢⱼᵏ ∂ₖ",
    ),
    row(
        Table::Mass,
        "M",
        "M",
        "M",
        "ij",
        "mass matrix, T = ½ Mᵢⱼ ξⁱ ξʲ",
    ),
    row(
        Table::Connection,
        "Gamma",
        "Γ",
        r"\Gamma",
        "ijk",
        "connection coefficients Γᵢⱼₖ, M ξ̇ + Γ ξ ξ + ∂V = f",
    ),
    row(
        Table::Accel,
        "accel",
        "ξ̇",
        r"\dot{\xi}",
        "i",
        "forward dynamics as emitted",
    ),
    row(
        Table::Bias,
        "bias",
        "b",
        "b",
        "i",
        "bias force bᵢ = Γᵢⱼₖ ξʲ ξᵏ",
    ),
    row(
        Table::PotentialForce,
        "potential_force",
        "∂V",
        r"\partial V",
        "i",
        "slope of the potential, ∂ᵢV",
    ),
    row(
        Table::GeneralizedForce,
        "generalized_force",
        "f",
        "f",
        "i",
        "generalised force fᵢ of the loads",
    ),
    row(
        Table::States,
        "states",
        "ż",
        r"\dot{z}",
        "i",
        "rates of the states of first order",
    ),
    row(
        Table::Outputs,
        "outputs",
        "y",
        "y",
        "",
        "outputs of the description",
    ),
    row(
        Table::Geometry,
        "geometry",
        "",
        "",
        "",
        "integrable velocities, Lie algebra, pattern of M, symmetries",
    ),
];

impl Table {
    /// Tables shown by default; for systems with states of first order, `States` is shown in addition.
    pub const DEFAULT: [Table; 6] = [
        Table::Phi,
        Table::A,
        Table::Y,
        Table::Gamma,
        Table::Mass,
        Table::Connection,
    ];

    /// Whether the table depends on M, which a system without inertia does not have.
    pub fn needs_inertia(self) -> bool {
        matches!(
            self,
            Table::Mass | Table::Connection | Table::Accel | Table::Bias
        )
    }

    fn row(self) -> &'static Row {
        ROWS.iter()
            .find(|row| row.table == self)
            .unwrap_or(&ROWS[0])
    }

    /// Returns the names of all tables.
    pub fn names() -> Vec<&'static str> {
        ROWS.iter().map(|row| row.name).collect()
    }

    /// Returns the table with this name; the error lists all names.
    pub fn parse(name: &str) -> Result<Table, TableError> {
        let found = ROWS.iter().find(|row| row.name == name.trim());
        found
            .map(|row| row.table)
            .ok_or_else(|| TableError::Unknown {
                name: name.trim().to_string(),
            })
    }

    /// Parses a comma-separated list of tables, such as `A,gamma,M`.
    pub fn parse_list(list: &str) -> Result<Vec<Table>, TableError> {
        list.split(',')
            .filter(|name| !name.trim().is_empty())
            .map(Table::parse)
            .collect()
    }

    /// Name on the command line and in JSON.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// Symbol of the table.
    pub fn symbol(self) -> &'static str {
        self.row().symbol
    }

    /// Symbol of the table in LaTeX.
    pub fn latex(self) -> &'static str {
        self.row().latex
    }

    /// Letters of its indices.
    pub fn indices(self) -> &'static str {
        self.row().indices
    }

    /// Short description of the table.
    pub fn title(self) -> &'static str {
        self.row().title
    }

    /// Whether entries with equal values share a row.
    pub fn is_grouped(self) -> bool {
        matches!(
            self,
            Table::A
                | Table::Y
                | Table::Gradient
                | Table::Psi
                | Table::Gamma
                | Table::Mass
                | Table::Connection
        )
    }
}
