//! Lie algebras are recognised by name, in any basis.

use hamel_codegen::algebra::poly::field::Field;
use hamel_codegen::derive::geometry::lie_algebra::LieAlgebra;
use hamel_codegen::derive::geometry::recognise::identify_algebra;
use num_rational::BigRational;

/// Returns an algebra given by its brackets (i, j, k, c): [eᵢ, eⱼ] = c eₖ + …, in a sheared basis.
fn algebra(n: usize, brackets: &[(usize, usize, usize, i64)]) -> LieAlgebra {
    let zero = BigRational::integer(0);
    let mut constants = vec![vec![vec![zero.clone(); n]; n]; n];
    for &(i, j, k, c) in brackets {
        constants[i][j][k] += BigRational::integer(c);
        constants[j][i][k] -= BigRational::integer(c);
    }
    let plain = LieAlgebra::new(constants).expect("a Lie algebra");
    // e'ᵢ = eᵢ + Σ j<i (i + 2 j) eⱼ: names must be independent of the basis.
    let sheared: Vec<Vec<BigRational>> = (0..n)
        .map(|i| {
            let entry = |j: usize| match j.cmp(&i) {
                std::cmp::Ordering::Less => BigRational::integer((i + 2 * j) as i64),
                std::cmp::Ordering::Equal => BigRational::integer(1),
                std::cmp::Ordering::Greater => zero.clone(),
            };
            (0..n).map(entry).collect()
        })
        .collect();
    plain.subalgebra(&sheared).expect("a basis")
}

fn name(n: usize, brackets: &[(usize, usize, usize, i64)]) -> String {
    identify_algebra(&algebra(n, brackets)).text()
}

const SO3: [(usize, usize, usize, i64); 3] = [(0, 1, 2, 1), (1, 2, 0, 1), (2, 0, 1, 1)];

#[test]
fn algebras_are_known_in_any_basis() {
    assert_eq!(name(3, &[]), "R^3");
    assert_eq!(name(3, &SO3), "so(3)");
    assert_eq!(name(5, &SO3), "so(3) ⊕ R^2");
    let split = [(0, 1, 2, 1), (1, 2, 0, 1), (2, 0, 1, -1)];
    assert_eq!(name(3, &split), "sl(2, R)");
    assert_eq!(name(3, &[(2, 0, 1, 1), (2, 1, 0, -1)]), "se(2)");
    assert_eq!(name(3, &[(2, 0, 1, 1), (2, 1, 0, 1)]), "se(1, 1)");
    assert_eq!(name(4, &[(2, 0, 1, 1), (2, 1, 0, -4)]), "se(2) ⊕ R");
    assert_eq!(name(3, &[(0, 1, 2, 5)]), "heisenberg(3)");
    assert_eq!(name(6, &[(0, 1, 4, 1), (2, 3, 4, 1)]), "heisenberg(5) ⊕ R");
    assert_eq!(name(2, &[(0, 1, 1, 1)]), "aff(R)");
    let mut se3 = SO3.to_vec();
    for (i, j, k, c) in SO3 {
        se3.push((i, j + 3, k + 3, c));
        se3.push((i + 3, j, k + 3, c));
    }
    assert_eq!(name(6, &se3), "se(3)");
    let mut two = SO3.to_vec();
    two.extend(SO3.map(|(i, j, k, c)| (i + 3, j + 3, k + 3, c)));
    assert_eq!(name(6, &two), "so(3) ⊕ so(3)");
}

#[test]
fn others_are_described() {
    // Spirals: ad z on [L, L] has a trace.
    let spiral = [(2, 0, 0, 1), (2, 0, 1, 1), (2, 1, 0, -1), (2, 1, 1, 1)];
    assert!(name(3, &spiral).starts_with("Lie algebra of dimension 3"));
}

#[test]
fn constants_without_jacobi_are_no_algebra() {
    let mut constants = vec![vec![vec![BigRational::integer(0); 3]; 3]; 3];
    constants[0][1][0] = BigRational::integer(1);
    constants[1][0][0] = BigRational::integer(-1);
    constants[0][2][1] = BigRational::integer(1);
    constants[2][0][1] = BigRational::integer(-1);
    assert_eq!(LieAlgebra::new(constants), None);
}
