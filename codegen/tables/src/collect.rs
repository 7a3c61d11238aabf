//! The entries of every table, as edges of the graph to which they belong.

use super::entries::Cell;
use super::error::TableError;
use super::kind::Table;
use super::listing::{Listing, listing};
use super::simplify::Simplifier;
use crate::Derivation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_dynamics::loads::applied_force;
use hamel_dynamics::tables::EquationTables;
use hamel_language::functions::FunctionId;
use hamel_language::model::Model;
use hamel_language::model::value::Value;

/// Derives the requested tables; the geometry is derived when the first table needs it.
pub struct Collector<'a> {
    derivation: Derivation<'a>,
    geometry: Option<(EquationTables, Simplifier)>,
}

impl<'a> Collector<'a> {
    /// Creates a collector that has derived nothing yet.
    pub fn new(derivation: Derivation<'a>) -> Self {
        Collector {
            derivation,
            geometry: None,
        }
    }

    /// Derives one table.
    pub fn listing(&mut self, table: Table) -> Result<Listing, TableError> {
        match table {
            Table::Phi => Ok(self.phi()),
            Table::A | Table::States | Table::Outputs => Ok(self.described(table)),
            Table::Accel => self.accel(),
            _ => self.derived(table),
        }
    }

    fn phi(&self) -> Listing {
        let model = self.derivation.model;
        let rows = model.phi.iter().enumerate();
        let cells: Vec<Cell> = rows
            .map(|(i, (edge, reads))| Cell {
                reads: reads.clone(),
                ..cell(vec![i], *edge)
            })
            .collect();
        // Not modulo φ, since all rows are 0 there.
        let mut simplifier = Simplifier::free(&model.points);
        let shape = vec![model.phi.len()];
        listing(
            Table::Phi,
            shape,
            &cells,
            &model.points.free,
            &mut simplifier,
            &[],
        )
    }

    fn described(&self, table: Table) -> Listing {
        let model = self.derivation.model;
        let (shape, cells) = match table {
            Table::A => (vec![model.nu(), model.n()], matrix(&model.a)),
            Table::States => {
                let rates = model
                    .state_rates
                    .iter()
                    .zip(names(model, model.z()))
                    .enumerate();
                let cells = rates.map(|(i, (edge, name))| Cell {
                    label: rate_name(&name),
                    ..cell(vec![i], *edge)
                });
                (vec![model.state_rates.len()], cells.collect())
            }
            _ => (vec![model.outputs.len()], outputs(model)),
        };
        let mut simplifier = Simplifier::modulo(&model.points);
        listing(table, shape, &cells, &model.graph, &mut simplifier, &[])
    }

    fn accel(&self) -> Result<Listing, TableError> {
        let Derivation {
            active: model,
            program,
            ..
        } = self.derivation;
        let Some(function) = program.function(FunctionId::Accel) else {
            return Err(TableError::NotGenerated(Table::Accel));
        };
        let rates = function
            .outputs
            .iter()
            .zip(
                names(model, &model.xi)
                    .into_iter()
                    .chain(names(model, model.z())),
            )
            .enumerate();
        let cells: Vec<Cell> = rates
            .map(|(i, (edge, name))| Cell {
                label: rate_name(&name),
                ..cell(vec![i], *edge)
            })
            .collect();
        let mut simplifier = Simplifier::free(&model.points);
        let shape = vec![function.outputs.len()];
        Ok(listing(
            Table::Accel,
            shape,
            &cells,
            &program.graph,
            &mut simplifier,
            &program.names,
        ))
    }

    fn derived(&mut self, table: Table) -> Result<Listing, TableError> {
        let (geometry, simplifier) = match &mut self.geometry {
            Some(derived) => derived,
            underived => {
                let model = self.derivation.model;
                let geometry =
                    EquationTables::new(model).ok_or(TableError::DependentColumns(table))?;
                underived.insert((geometry, Simplifier::modulo(&model.points)))
            }
        };
        let (shape, cells) = cells(geometry, table);
        Ok(listing(
            table,
            shape,
            &cells,
            &geometry.model.graph,
            simplifier,
            &[],
        ))
    }
}

fn cells(geometry: &mut EquationTables, table: Table) -> (Vec<usize>, Vec<Cell>) {
    let (n, nu) = (geometry.model.n(), geometry.model.nu());
    match table {
        Table::Y => (vec![n, nu], matrix(&geometry.y)),
        Table::Gradient => {
            let phi = &geometry.complement.phi;
            (vec![phi.len(), nu], matrix(phi))
        }
        Table::Psi => {
            let rank = geometry.complement.phi.len();
            (vec![nu, rank], matrix(&geometry.complement.psi))
        }
        Table::Mass => (vec![n, n], matrix(&geometry.mass)),
        Table::Gamma => (vec![n; 3], cube(&geometry.gamma)),
        Table::Connection => (vec![n; 3], cube(&geometry.connection)),
        Table::Bias => (vec![n], vector(bias(geometry))),
        Table::PotentialForce => {
            let graph = &mut geometry.model.graph;
            let slope = (0..n).map(|i| geometry.calculus.along(graph, i, geometry.potential));
            let slope: Vec<Edge> = slope.collect();
            (vec![n], vector(slope))
        }
        _ => (
            vec![n],
            vector(applied_force(&mut geometry.model, &mut geometry.calculus)),
        ),
    }
}

/// Returns the bias forces Γᵢⱼₖ ξʲ ξᵏ.
fn bias(geometry: &mut EquationTables) -> Vec<Edge> {
    let xi = geometry.model.xi.clone();
    let graph = &mut geometry.model.graph;
    let row = |graph: &mut Graph, rows: &[Vec<Edge>]| {
        let inner: Vec<Edge> = rows.iter().map(|row| graph.dot(row, &xi)).collect();
        graph.dot(&inner, &xi)
    };
    geometry
        .connection
        .iter()
        .map(|rows| row(graph, rows))
        .collect()
}

fn outputs(model: &Model) -> Vec<Cell> {
    let mut cells = Vec::new();
    for (place, (name, value)) in model.outputs.iter().enumerate() {
        let parts = match value {
            Value::Scalar(edge) => vec![cell(Vec::new(), *edge)],
            Value::Matrix(rows) => matrix(rows),
            Value::Vector(_) | Value::Pose(..) => vector(value.entries()),
        };
        for part in parts {
            let within: Vec<String> = part.index.iter().map(usize::to_string).collect();
            let label = if within.is_empty() {
                name.clone()
            } else {
                format!("{name}[{}]", within.join(","))
            };
            let index = std::iter::once(place + 1).chain(part.index).collect();
            cells.push(Cell {
                index,
                label,
                ..cell(Vec::new(), part.edge)
            });
        }
    }
    cells
}

/// Creates a cell from indices that are counted from 0.
fn cell(index: Vec<usize>, edge: Edge) -> Cell {
    let index = index.into_iter().map(|i| i + 1).collect();
    Cell {
        index,
        label: String::new(),
        reads: String::new(),
        edge,
    }
}

fn vector(edges: Vec<Edge>) -> Vec<Cell> {
    edges
        .into_iter()
        .enumerate()
        .map(|(i, edge)| cell(vec![i], edge))
        .collect()
}

fn matrix(rows: &[Vec<Edge>]) -> Vec<Cell> {
    let rows = rows.iter().enumerate();
    rows.flat_map(|(i, row)| {
        row.iter()
            .enumerate()
            .map(move |(j, &edge)| cell(vec![i, j], edge))
    })
    .collect()
}

fn cube(slices: &[Vec<Vec<Edge>>]) -> Vec<Cell> {
    let mut cells = Vec::new();
    for (i, rows) in slices.iter().enumerate() {
        for mut part in matrix(rows) {
            part.index.insert(0, i + 1);
            cells.push(part);
        }
    }
    cells
}

fn names(model: &Model, edges: &[Edge]) -> Vec<String> {
    let symbols = model.graph.symbols();
    let name = |edge: &Edge| {
        symbols
            .iter()
            .find(|symbol| symbol.node == edge.node())
            .map(|symbol| symbol.name.clone())
    };
    edges.iter().filter_map(name).collect()
}

/// Returns the name of the rate of a velocity, such as `v_dot[1]` for `v[1]`.
fn rate_name(name: &str) -> String {
    match name.split_once('[') {
        Some((head, rest)) => format!("{head}_dot[{rest}"),
        None => format!("{name}_dot"),
    }
}
