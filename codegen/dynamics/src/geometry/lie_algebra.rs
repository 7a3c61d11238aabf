//! A Lie algebra over Q with its structure constants, `[eᵢ, eⱼ]` = cᵢⱼᵏ eₖ, and its basis-independent properties:
//! derived algebra, centre, Killing form.

use hamel_algebra::echelon::{Echelon, signature};
use num_rational::BigRational;
use num_traits::{One, Zero};

/// Vector of coordinates with respect to the basis.
pub type RationalVector = Vec<BigRational>;

/// Lie algebra given by structure constants `c[i][j][k]` = cᵢⱼᵏ.
#[derive(Clone, Debug, PartialEq)]
pub struct LieAlgebra {
    constants: Vec<Vec<RationalVector>>,
}

impl LieAlgebra {
    /// Creates the algebra with antisymmetric constants that satisfy Jacobi's identity; `None` for other constants.
    pub fn new(constants: Vec<Vec<RationalVector>>) -> Option<Self> {
        let algebra = LieAlgebra { constants };
        let n = algebra.dimension();
        let unit = |i: usize| algebra.unit(i);
        for i in 0..n {
            for j in 0..n {
                let sum = add(&algebra.constants[i][j], &algebra.constants[j][i]);
                if !sum.iter().all(Zero::is_zero) {
                    return None;
                }
                for k in 0..n {
                    let term = |a: usize, b: usize, c: usize| {
                        algebra.bracket(&unit(a), &algebra.constants[b][c])
                    };
                    let sum = add(&add(&term(i, j, k), &term(j, k, i)), &term(k, i, j));
                    if !sum.iter().all(Zero::is_zero) {
                        return None;
                    }
                }
            }
        }
        Some(algebra)
    }

    /// Returns the dimension of the algebra.
    pub fn dimension(&self) -> usize {
        self.constants.len()
    }

    fn unit(&self, i: usize) -> RationalVector {
        let mut unit = vec![BigRational::zero(); self.dimension()];
        unit[i] = BigRational::one();
        unit
    }

    /// Returns the bracket `[a, b]`.
    pub fn bracket(&self, a: &[BigRational], b: &[BigRational]) -> RationalVector {
        let n = self.dimension();
        let mut result = vec![BigRational::zero(); n];
        for (i, x) in a.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
            for (j, y) in b.iter().enumerate().filter(|(_, y)| !y.is_zero()) {
                let scale = x * y;
                for (entry, constant) in result.iter_mut().zip(&self.constants[i][j]) {
                    *entry += &scale * constant;
                }
            }
        }
        result
    }

    /// Returns a basis of the span of `[a, b]` over a ∈ `left`, b ∈ `right`.
    pub fn bracket_span(
        &self,
        left: &[RationalVector],
        right: &[RationalVector],
    ) -> Vec<RationalVector> {
        let all = left
            .iter()
            .flat_map(|a| right.iter().map(|b| self.bracket(a, b)));
        Echelon::new(all.collect()).rows
    }

    /// Returns the basis vectors e₁ … eₙ, by their coordinates.
    pub fn basis(&self) -> Vec<RationalVector> {
        (0..self.dimension()).map(|i| self.unit(i)).collect()
    }

    /// Returns a basis of the derived algebra `[L, L]`.
    pub fn derived_algebra(&self) -> Vec<RationalVector> {
        let basis = self.basis();
        self.bracket_span(&basis, &basis)
    }

    /// Returns whether `[a, b]` = 0 for all a, b of a subspace.
    pub fn is_abelian_on(&self, subspace: &[RationalVector]) -> bool {
        self.bracket_span(subspace, subspace).is_empty()
    }

    /// Returns a basis of the centre {z : `[z, eⱼ]` = 0 for all j}.
    pub fn centre(&self) -> Vec<RationalVector> {
        let n = self.dimension();
        let mut rows = Vec::new();
        for j in 0..n {
            for k in 0..n {
                rows.push((0..n).map(|i| self.constants[i][j][k].clone()).collect());
            }
        }
        Echelon::new(rows).null_space(n)
    }

    /// Returns the matrix of ad z = `[z, ·]`, `m[k][j]`.
    pub fn adjoint(&self, z: &[BigRational]) -> Vec<RationalVector> {
        let columns: Vec<RationalVector> =
            self.basis().iter().map(|e| self.bracket(z, e)).collect();
        (0..self.dimension())
            .map(|k| columns.iter().map(|column| column[k].clone()).collect())
            .collect()
    }

    /// Returns Killing's form K(eᵢ, eⱼ) = tr(ad eᵢ ad eⱼ) = cᵢₛᵗ cⱼₜˢ.
    pub fn killing_form(&self) -> Vec<RationalVector> {
        let n = self.dimension();
        let c = &self.constants;
        (0..n)
            .map(|i| {
                (0..n)
                    .map(|j| {
                        let mut trace = BigRational::zero();
                        for s in 0..n {
                            for t in 0..n {
                                trace += &c[i][s][t] * &c[j][t][s];
                            }
                        }
                        trace
                    })
                    .collect()
            })
            .collect()
    }

    /// Returns the numbers of positive and negative squares of Killing's form.
    pub fn killing_signature(&self) -> (usize, usize) {
        signature(&self.killing_form())
    }

    /// Returns the dimensions of L, `[L, L]`, `[[L, L], [L, L]]` … until they repeat.
    pub fn derived_series(&self) -> Vec<usize> {
        let mut space = self.basis();
        let mut dimensions = vec![space.len()];
        loop {
            let next = self.bracket_span(&space, &space);
            if next.len() == space.len() {
                return dimensions;
            }
            dimensions.push(next.len());
            space = next;
        }
    }

    /// Splits L = I ⊕ Rᵏ so that I has no abelian summand; returns I and k.
    ///
    /// The summand is spanned by vectors of the centre that are independent modulo `[L, L]`. Any subspace that
    /// contains `[L, L]` is an ideal.
    pub fn without_abelian_summand(&self) -> Option<(LieAlgebra, usize)> {
        let derived = self.derived_algebra();
        let independent = |known: &[RationalVector], vector: &RationalVector| {
            let mut rows = known.to_vec();
            rows.push(vector.clone());
            Echelon::new(rows).rank() > known.len()
        };
        // Extend [L, L] by the summand from the centre, then by what is left of L.
        let mut spanned = derived.clone();
        let mut summand = 0;
        for vector in self.centre() {
            if independent(&spanned, &vector) {
                spanned.push(vector);
                summand += 1;
            }
        }
        let mut ideal = derived;
        for vector in self.basis() {
            if independent(&spanned, &vector) {
                spanned.push(vector.clone());
                ideal.push(vector);
            }
        }
        Some((self.subalgebra(&ideal)?, summand))
    }

    /// Returns the subalgebra with a given basis; `None` if brackets leave its span.
    pub fn subalgebra(&self, basis: &[RationalVector]) -> Option<LieAlgebra> {
        let coordinates = |vector: &RationalVector| {
            let rows = (0..self.dimension()).map(|k| {
                let mut row: RationalVector = basis.iter().map(|b| b[k].clone()).collect();
                row.push(vector[k].clone());
                row
            });
            hamel_algebra::echelon::solution(rows.collect())
        };
        let constants: Option<Vec<Vec<RationalVector>>> = basis
            .iter()
            .map(|a| {
                basis
                    .iter()
                    .map(|b| coordinates(&self.bracket(a, b)))
                    .collect()
            })
            .collect();
        Some(LieAlgebra {
            constants: constants?,
        })
    }
}

fn add(a: &[BigRational], b: &[BigRational]) -> RationalVector {
    a.iter().zip(b).map(|(x, y)| x + y).collect()
}
