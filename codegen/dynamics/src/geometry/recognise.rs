//! Recognition of the Lie algebra of given structure constants, up to a linear change of basis over R.
//!
//! | algebra | is recognised by |
//! |---|---|
//! | Rᵏ | no brackets |
//! | so(3), sums of it | Killing's form negative definite, dimension 3, 6, 9 |
//! | sl(2, R) | dimension 3, Killing's form of signature (2, 1) |
//! | se(3) = so(3) ⋉ R³ | dimension 6, L = \[L, L\], Killing's form of signature (0, 3), its kernel abelian |
//! | se(2) = so(2) ⋉ R² | dimension 3, \[L, L\] abelian of dimension 2, where ad z turns (tr = 0, det > 0) |
//! | se(1, 1) | the same with det < 0 |
//! | Heisenberg's h(2m + 1) | \[L, L\] of dimension 1, equal to the centre |
//! | aff(R) | dimension 2, not abelian |
//!
//! In dimensions up to 9, an algebra with a negative definite form is a sum of copies of so(3), except for su(3) in
//! dimension 8: 6 = 3 + 3, 9 = 3 + 3 + 3. A perfect algebra with Levi part so(3) and an abelian radical of
//! dimension 3 is se(3), because the only nontrivial real representation of so(3) in dimension 3 without a fixed
//! vector is the rotation of vectors.

use super::lie_algebra::LieAlgebra;
use hamel_algebra::echelon::Echelon;
use num_rational::BigRational;
use num_traits::{Signed, Zero};

/// Name of a Lie algebra, or its invariants if it is none of the known ones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AlgebraName {
    /// Direct sum of these, in reading order; Rᵏ last.
    Sum(Vec<String>),
    /// None of the known ones.
    Unnamed {
        /// Dimension dim L.
        dimension: usize,
        /// Derived series dim L, dim \[L, L\] …
        derived: Vec<usize>,
        /// Dimension of the centre.
        centre: usize,
        /// Numbers of positive and negative squares of Killing's form.
        killing: (usize, usize),
    },
}

impl AlgebraName {
    /// Returns the name as text, such as `so(3) ⊕ R^3`.
    pub fn text(&self) -> String {
        match self {
            AlgebraName::Sum(parts) => parts.join(" ⊕ "),
            AlgebraName::Unnamed {
                dimension,
                derived,
                centre,
                killing: (plus, minus),
            } => {
                let series: Vec<String> = derived.iter().map(usize::to_string).collect();
                format!(
                    "Lie algebra of dimension {dimension} (derived series {}, centre {centre}, Killing form +{plus} −{minus})",
                    series.join(", ")
                )
            }
        }
    }
}

/// Returns the name of an abelian algebra: `R`, or `R^3` in dimension 3.
pub fn abelian_name(dimension: usize) -> String {
    match dimension {
        1 => "R".into(),
        _ => format!("R^{dimension}"),
    }
}

/// Identifies a Lie algebra by its invariants, and returns its name.
pub fn identify_algebra(algebra: &LieAlgebra) -> AlgebraName {
    let unnamed = || AlgebraName::Unnamed {
        dimension: algebra.dimension(),
        derived: algebra.derived_series(),
        centre: algebra.centre().len(),
        killing: algebra.killing_signature(),
    };
    let Some((core, summand)) = algebra.without_abelian_summand() else {
        return unnamed();
    };
    let mut parts = match core.dimension() {
        0 => Vec::new(),
        _ => match indecomposable(&core) {
            Some(parts) => parts,
            None => return unnamed(),
        },
    };
    if summand > 0 {
        parts.push(abelian_name(summand));
    }
    AlgebraName::Sum(parts)
}

/// Returns the names of the summands of an algebra without abelian summand; `None` if it is not a known one.
fn indecomposable(algebra: &LieAlgebra) -> Option<Vec<String>> {
    let n = algebra.dimension();
    let (derived, centre) = (algebra.derived_algebra(), algebra.centre());
    let (plus, minus) = algebra.killing_signature();
    let one = |name: &str| Some(vec![name.to_string()]);
    if minus == n && n.is_multiple_of(3) && n <= 9 {
        return Some(vec!["so(3)".into(); n / 3]);
    }
    if derived.len() == 1 && centre.len() == 1 {
        let mut both = derived;
        both.extend(centre);
        let same = Echelon::new(both).rank() == 1;
        return same.then(|| vec![format!("heisenberg({n})")]);
    }
    match (n, derived.len()) {
        (2, 1) => one("aff(R)"),
        (3, 3) if (plus, minus) == (2, 1) => one("sl(2, R)"),
        (3, 2) if algebra.is_abelian_on(&derived) => match turning(algebra)? {
            (trace, determinant) if trace.is_zero() && determinant.is_positive() => one("se(2)"),
            (trace, determinant) if trace.is_zero() && determinant.is_negative() => one("se(1, 1)"),
            _ => None,
        },
        (6, 6) if (plus, minus) == (0, 3) => {
            let radical = Echelon::new(algebra.killing_form()).null_space(n);
            algebra
                .is_abelian_on(&radical)
                .then(|| vec!["se(3)".into()])
        }
        _ => None,
    }
}

/// Returns trace and determinant, on \[L, L\] (abelian, dimension 2 of 3), of ad z for any vector z outside.
///
/// As ad z maps into \[L, L\], they are the trace of ad z and the sum of its principal 2×2 minors.
fn turning(algebra: &LieAlgebra) -> Option<(BigRational, BigRational)> {
    let derived = algebra.derived_algebra();
    let outside = algebra.basis().into_iter().find(|vector| {
        let mut rows = derived.clone();
        rows.push(vector.clone());
        Echelon::new(rows).rank() == 3
    })?;
    let m = algebra.adjoint(&outside);
    let (mut trace, mut minors) = (BigRational::zero(), BigRational::zero());
    for i in 0..3 {
        trace += &m[i][i];
        for j in 0..i {
            minors += &m[i][i] * &m[j][j] - &m[i][j] * &m[j][i];
        }
    }
    Some((trace, minors))
}
