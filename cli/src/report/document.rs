//! The contents of a report: sections of paragraphs, formulas and tables, before they are written in a format.

use crate::check::{CheckedIdentity, check_identities};
use crate::ops::calls;
use hamel_codegen::derive::geometry::Inspection;
use hamel_codegen::generate::Generated;
use hamel_codegen::tables::display::{Display, displays};
use hamel_codegen::tables::geometry;
use hamel_codegen::tables::print::Notation;
use hamel_codegen::tables::{Table, TableError, Tables};
use hamel_engine::state::constraint_lines;
use hamel_files::number::short;

/// Where notation and equation numbers come from.
pub const SOURCE: &str = "Notation and equation numbers are those of M. Konz and J. Rudolph, Redundant configuration \
     coordinates and nonholonomic velocity coordinates in analytical mechanics, IFAC-PapersOnLine 51-2 (2018) 409-414. \
     Indices count from 1; repeated indices are summed. Entries that are not shown are zero. The \
     abbreviations t₁, t₂, … hold within one section.";

/// A report on one mechanism.
pub struct Document {
    /// Name of the system.
    pub system: String,
    /// Sections, in the order of the derivation.
    pub sections: Vec<Section>,
}

/// A section.
pub struct Section {
    /// Its heading.
    pub heading: &'static str,
    /// Its contents.
    pub blocks: Vec<Block>,
}

/// A piece of a section. Formulas are in the notation of the document, all other texts are plain.
pub enum Block {
    /// A paragraph.
    Paragraph(String),
    /// A displayed formula, or several.
    Formulas(Display),
    /// A table: heads of the columns, and rows.
    Table(Vec<&'static str>, Vec<Vec<String>>),
    /// Lines in a font of fixed width.
    Lines(String),
}

impl Document {
    /// Collects the derivation of a system; `text` is that of its description, or empty.
    pub fn new(generated: &Generated, text: &str, notation: Notation) -> Document {
        let writer = Writer {
            generated,
            notation,
        };
        let mut sections = vec![
            writer.coordinates(),
            writer.velocities(),
            writer.commutation(),
        ];
        if generated.model.has_inertia {
            sections.push(writer.of_table(
                "Mass matrix",
                "The kinetic energy is T = ½ Mᵢⱼ ξⁱ ξʲ (20).",
                Table::Mass,
                "",
            ));
            sections.push(writer.of_table(
                "Connection coefficients",
                "M and γ determine them by ∂ₖMᵢⱼ = Γᵢⱼₖ + Γⱼᵢₖ and γₖⱼˢ Mₛᵢ = Γᵢⱼₖ − Γᵢₖⱼ (21).",
                Table::Connection,
                "All are zero: M is constant and the velocities are rates of coordinates.",
            ));
        }
        sections.push(writer.of_table(
            "Conservative forces",
            "Gravity, springs and other potentials act by the slope of the potential energy, ∂ᵢV.",
            Table::PotentialForce,
            "It is zero: there is no potential energy.",
        ));
        sections.push(writer.of_table(
            "Loads",
            "All other loads act by their virtual work, fᵢ = Σ ⟨F, ∂ᵢr⟩ (28).",
            Table::GeneralizedForce,
            "There are none.",
        ));
        sections.extend(writer.constraints(text));
        sections.push(writer.equations());
        sections.extend(writer.states_and_outputs());
        sections.push(proofs(&check_identities(generated)));
        sections.push(costs(generated));
        if !text.is_empty() {
            sections.push(Section {
                heading: "Description",
                blocks: vec![Block::Lines(text.trim_end().to_string())],
            });
        }
        Document {
            system: generated.model.name.clone(),
            sections,
        }
    }
}

struct Writer<'a> {
    generated: &'a Generated,
    notation: Notation,
}

impl Writer<'_> {
    fn table(&self, table: Table) -> Result<Tables, TableError> {
        self.generated.tables(&[table])
    }

    /// Returns the formulas of a table, or the given sentence if all its entries are zero.
    fn formulas(&self, table: Table, if_zero: &str) -> Vec<Block> {
        let tables = match self.table(table) {
            Ok(tables) => tables,
            Err(why) => return vec![Block::Paragraph(format!("Not available: {why}."))],
        };
        let listings = tables.listings.iter();
        let formulas = listings.flat_map(|listing| displays(listing, self.notation));
        let blocks: Vec<Block> = formulas.map(Block::Formulas).collect();
        match blocks.is_empty() && !if_zero.is_empty() {
            true => vec![Block::Paragraph(if_zero.into())],
            false => blocks,
        }
    }

    fn of_table(
        &self,
        heading: &'static str,
        introduction: &str,
        table: Table,
        if_zero: &str,
    ) -> Section {
        let mut blocks = vec![Block::Paragraph(introduction.into())];
        blocks.extend(self.formulas(table, if_zero));
        Section { heading, blocks }
    }

    /// Returns an equation between a symbol and a column of names.
    fn vector(&self, symbol: &str, names: &[String]) -> Block {
        let symbol = match self.notation {
            Notation::Latex if symbol == "ξ" => r"\xi".into(),
            Notation::MathMl => format!("<mi>{symbol}</mi>"),
            Notation::Text | Notation::Latex => symbol.into(),
        };
        let names = names.iter().map(|name| self.notation.name(name));
        let separator = match self.notation {
            Notation::MathMl => "<mo>,</mo>",
            Notation::Text | Notation::Latex => r",\; ",
        };
        let names: Vec<String> = names.collect();
        let list = match self.notation {
            Notation::MathMl => format!("<mo>(</mo>{}<mo>)</mo>", names.join(separator)),
            Notation::Text | Notation::Latex => format!("({})", names.join(separator)),
        };
        Block::Formulas(Display::Equations(vec![[symbol, list]]))
    }

    fn coordinates(&self) -> Section {
        let model = &self.generated.model;
        let mut blocks = vec![Block::Paragraph(format!(
            "The configuration is given by ν = {} coordinates.",
            model.x.len()
        ))];
        if let Ok(tables) = self.table(Table::Phi) {
            blocks.push(self.vector("x", &tables.coordinates));
            let redundant = tables.listings.iter().any(|it| !it.entries.is_empty());
            if redundant {
                let text = format!(
                    "They are redundant: x lies on the manifold X = {{x : φ(x) = 0}} of dimension n = {} (3).",
                    model.xi.len()
                );
                blocks.push(Block::Paragraph(text));
                let formulas = tables.listings.iter();
                let formulas = formulas.flat_map(|it| displays(it, self.notation));
                blocks.extend(formulas.map(Block::Formulas));
            }
        }
        if !model.params.is_empty() {
            let values = |at: usize| model.defaults.get(at).copied().unwrap_or(f64::NAN);
            let rows = model.params.iter().map(|group| {
                let numbers = group.offset..group.offset + group.len;
                let numbers: Vec<String> = numbers.map(|at| short(values(at))).collect();
                vec![group.name.clone(), numbers.join(", ")]
            });
            blocks.push(Block::Table(vec!["parameter", "default"], rows.collect()));
        }
        Section {
            heading: "Coordinates",
            blocks,
        }
    }

    fn velocities(&self) -> Section {
        let model = &self.generated.model;
        let mut blocks = vec![Block::Paragraph(format!(
            "The motion is given by n = {} velocity coordinates ξ, with ẋ = A(x) ξ and ξ = Y(x) ẋ (5, 6). ∂ᵢ is the \
             derivative along the column i of A.",
            model.xi.len()
        ))];
        if let Ok(tables) = self.table(Table::A) {
            blocks.push(self.vector("ξ", &tables.velocities));
        }
        blocks.extend(self.formulas(Table::A, ""));
        blocks.extend(self.formulas(Table::Y, ""));
        Section {
            heading: "Velocities",
            blocks,
        }
    }

    fn commutation(&self) -> Section {
        let mut section = self.of_table(
            "Hamel coefficients",
            "The columns of A commute up to ∂ᵢ∂ⱼ − ∂ⱼ∂ᵢ = γᵢⱼᵏ ∂ₖ (12).",
            Table::Gamma,
            "All are zero: every velocity is the rate of a function of x.",
        );
        if let Some(inspection) = Inspection::new(&self.generated.model) {
            let lines = geometry::lines(&inspection);
            let lines: Vec<&str> = lines.iter().map(|line| line.trim_end()).collect();
            section.blocks.push(Block::Lines(lines.join("\n")));
        }
        section
    }

    fn constraints(&self, text: &str) -> Option<Section> {
        let lines = constraint_lines(self.generated, text);
        (!lines.is_empty()).then(|| Section {
            heading: "Constraints",
            blocks: vec![
                Block::Paragraph(
                    "These hold in addition: they leave fewer independent velocities, and act by multipliers λ.".into(),
                ),
                Block::Lines(lines.join("\n")),
            ],
        })
    }

    fn equations(&self) -> Section {
        let forms = [
            ("Hamel", "d/dt ∂L/∂ξⁱ + γᵢⱼᵏ ξʲ ∂L/∂ξᵏ − ∂ᵢL = fᵢ (30a)"),
            ("Gibbs-Appell", "∂S/∂ξ̇ⁱ + ∂ᵢV = fᵢ (30b)"),
            ("explicit", "Mᵢⱼ ξ̇ʲ + Γᵢⱼₖ ξʲ ξᵏ + ∂ᵢV = fᵢ (30c)"),
        ];
        let rows = forms.map(|(name, form)| vec![name.to_string(), form.to_string()]);
        let mut blocks = vec![
            Block::Paragraph(
                "With ẋ = A ξ, each of three forms states the equations of motion; L = T − V, and S is the \
                 acceleration energy."
                    .into(),
            ),
            Block::Table(vec!["form", "equation"], rows.to_vec()),
        ];
        if self.generated.model.has_inertia {
            blocks.push(Block::Paragraph(
                "The products of velocities in (30c), the bias force bᵢ = Γᵢⱼₖ ξʲ ξᵏ:".into(),
            ));
            blocks.extend(self.formulas(Table::Bias, "They are zero."));
        }
        Section {
            heading: "Equations of motion",
            blocks,
        }
    }

    fn states_and_outputs(&self) -> Vec<Section> {
        let model = &self.generated.model;
        let mut sections = Vec::new();
        if !model.states.is_empty() {
            let introduction = "Rates of the states of first order:";
            sections.push(self.of_table("States", introduction, Table::States, ""));
        }
        if !model.outputs.is_empty() {
            let introduction = "Quantities that are computed beside the motion:";
            sections.push(self.of_table("Outputs", introduction, Table::Outputs, ""));
        }
        sections
    }
}

/// Returns the section with the verdicts on all identities.
fn proofs(identities: &[CheckedIdentity]) -> Section {
    let rows = identities.iter().map(|identity| {
        let verdict = match identity.explanation.as_str() {
            "" => identity.verdict.to_string(),
            why => why.to_string(),
        };
        vec![identity.label.into(), identity.equation.clone(), verdict]
    });
    Section {
        heading: "Proofs",
        blocks: vec![
            Block::Paragraph(
                "Every quantity was derived a second time, independently, and compared. “Proved” is exact, over the \
                 rationals and modulo φ; “checked” is equality at random points of X in exact arithmetic modulo two \
                 primes."
                    .into(),
            ),
            Block::Table(vec!["equation", "claim", "verdict"], rows.collect()),
        ],
    }
}

/// Returns the section with the operations of a call of each function.
fn costs(generated: &Generated) -> Section {
    let rows = calls(&generated.program).into_iter().map(|(name, counts)| {
        let counts = counts.iter().map(u128::to_string);
        std::iter::once(name).chain(counts).collect()
    });
    Section {
        heading: "Operations",
        blocks: vec![
            Block::Paragraph("Operations of one call of each generated function:".into()),
            Block::Table(
                vec!["function", "add", "mul", "div", "sqrt", "sincos", "other"],
                rows.collect(),
            ),
        ],
    }
}
