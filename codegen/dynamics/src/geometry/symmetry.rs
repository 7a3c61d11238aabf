//! Symmetries of the kinetic energy and of the potential, direction by direction.
//!
//! Along ∂ᵢ the metric changes by (L_{∂ᵢ} M)_jk = ∂ᵢM_jk − γᵢⱼˢ M_sk − γᵢₖˢ M_sj. If that is 0, the flow of ∂ᵢ
//! preserves T, and by Noether's theorem dpᵢ/dt = fᵢ − ∂ᵢV with p = M ξ.

use crate::tables::EquationTables;
use hamel_algebra::graph::Edge;

/// Whether M, V and loads are invariant along a direction ∂ᵢ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Symmetry {
    /// Whether ∂ᵢM_jk = 0 for all j, k: the entries of M do not change along ∂ᵢ.
    pub mass_constant: bool,
    /// Whether L_{∂ᵢ} M = 0: the flow of ∂ᵢ preserves T.
    pub keeps_kinetic: bool,
    /// Whether ∂ᵢV = 0.
    pub keeps_potential: bool,
    /// Whether fᵢ = 0 for all applied loads and the model has no constraints.
    pub unloaded: bool,
}

impl Symmetry {
    /// Returns whether pᵢ is conserved.
    pub fn conserves_momentum(&self) -> bool {
        self.keeps_kinetic && self.keeps_potential && self.unloaded
    }
}

/// Returns the symmetries of all directions; `applied` are the generalised forces of the loads.
pub fn symmetries(geometry: &mut EquationTables, applied: &[Edge]) -> Vec<Symmetry> {
    let n = geometry.model.n();
    let zero = geometry.model.graph.zero().node();
    let (mass, gamma) = (&geometry.mass, &geometry.gamma);
    let constrained = geometry.model.is_constrained();
    let graph = &mut geometry.model.graph;
    (0..n)
        .map(|i| {
            let (mut mass_constant, mut keeps_kinetic) = (true, true);
            for j in 0..n {
                for k in 0..=j {
                    let change = geometry.calculus.along(graph, i, mass[j][k]);
                    let first = graph.dot(&gamma[i][j], &mass[k]);
                    let second = graph.dot(&gamma[i][k], &mass[j]);
                    let turned = graph.add(first, second);
                    mass_constant &= change.node() == zero;
                    keeps_kinetic &= graph.sub(change, turned).node() == zero;
                }
            }
            let slope = geometry.calculus.along(graph, i, geometry.potential);
            Symmetry {
                mass_constant,
                keeps_kinetic,
                keeps_potential: slope.node() == zero,
                unloaded: applied.get(i).is_none_or(|force| force.node() == zero) && !constrained,
            }
        })
        .collect()
}
