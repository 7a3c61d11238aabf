//! Which tables there are.

/// A table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Table {
    /// φ(x), ν − n or more rows.
    Phi,
    /// A(x), ν×n.
    A,
    /// Y(x), n×ν.
    Y,
    /// Φ(x), ν−n×ν.
    Gradient,
    /// Ψ(x), ν×ν−n.
    Psi,
    /// γᵢⱼᵏ.
    Gamma,
    /// M(x), n×n.
    Mass,
    /// Γᵢⱼₖ.
    Connection,
    /// ξ̇ by the emitted route.
    Accel,
    /// Γᵢⱼₖ ξʲ ξᵏ.
    Bias,
    /// ∂ᵢV.
    PotentialForce,
    /// fᵢ of applied loads.
    GeneralizedForce,
    /// ż of the states of first order.
    States,
    /// The outputs of the description.
    Outputs,
    /// No coefficients, but what they say about the geometry.
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
    /// What is shown where nothing is asked for; of systems with states of first order, their rates, too.
    pub const DEFAULT: [Table; 6] = [
        Table::Phi,
        Table::A,
        Table::Y,
        Table::Gamma,
        Table::Mass,
        Table::Connection,
    ];

    /// Whether it is about M, which a system without inertia does not have.
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

    /// The names of all tables.
    pub fn names() -> Vec<&'static str> {
        ROWS.iter().map(|row| row.name).collect()
    }

    /// The table of a name; the error lists the names.
    pub fn parse(name: &str) -> Result<Table, String> {
        let found = ROWS.iter().find(|row| row.name == name.trim());
        found.map(|row| row.table).ok_or_else(|| {
            format!(
                "there is no table `{}`; the tables are {}",
                name.trim(),
                Table::names().join(", ")
            )
        })
    }

    /// The tables of a list with commas, `A,gamma,M`.
    pub fn parse_list(list: &str) -> Result<Vec<Table>, String> {
        list.split(',')
            .filter(|name| !name.trim().is_empty())
            .map(Table::parse)
            .collect()
    }

    /// Its name on the command line and in JSON.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// Its symbol.
    pub fn symbol(self) -> &'static str {
        self.row().symbol
    }

    /// Its symbol in LaTeX.
    pub fn latex(self) -> &'static str {
        self.row().latex
    }

    /// The letters of its indices.
    pub fn indices(self) -> &'static str {
        self.row().indices
    }

    /// What it is, in a few words.
    pub fn title(self) -> &'static str {
        self.row().title
    }

    /// Whether equal values share a row.
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
