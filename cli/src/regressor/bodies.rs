//! Finds bodies with given base parameters.
//!
//! Many standard parameters π have the same base parameters β = K π. Among those whose pseudo-inertias J = [[tr(Θ)/2 I
//! − Θ, h], [hᵀ, m]] are positive definite, as those of all bodies are, the nearest to given bodies π₀ are found, in
//! the sense of D = Σ tr(J J₀⁻¹) − log det(J J₀⁻¹) − 4 over the links, which depends on no choice of units or axes.
//! Noise may lead to a β that no bodies have: then D + ½ Σ (K π − β)²/r is minimised, with small r. Newton's method is
//! damped for long steps: D is self-concordant, so that J stays positive definite. Sources: P. Wensing, S. Kim, J.-J.
//! Slotine, *Linear matrix inequalities for physically consistent inertial parameter identification*, IEEE RA-L 3
//! (2018) 60; T. Lee, P. Wensing, F. Park, *Geometric robot dynamic identification*, IEEE T-RO 36 (2020) 348; S. Boyd,
//! L. Vandenberghe, *Convex Optimization* (2004), 9.6, 10.3.

use hamel_codegen::tables;
use nalgebra::{DMatrix, DVector, Matrix4, SMatrix, SVector};

/// Parameters of a link: Θxx, Θxy, Θxz, Θyy, Θyz, Θzz, h, m.
const LINK_PARAMETERS: usize = 10;
/// Iteration limit of Newton's method.
const MAX_NEWTON_STEPS: usize = 1000;
/// Square of the last step, in the norm of the second derivative: the remaining error is far below rounding.
const STEP_TOLERANCE: f64 = 1e-20;
/// Values of r relative to the squared scale of a base parameter (β and its terms in π₀), each warm-started from the
/// last.
const SLACK_SCHEDULE: [f64; 7] = [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
/// Smallest scale of a base parameter, relative to the largest.
const MIN_SCALE: f64 = 1e-6;
/// Largest error of K π, relative to the largest sum of absolute terms.
const CONSTRAINT_TOLERANCE: f64 = 1e-10;

/// The map from standard to base parameters: the places and factors of the terms of each β.
pub type Map = [Vec<(usize, f64)>];

/// Reason why no bodies were found.
#[derive(Debug, PartialEq, Eq)]
pub enum NoBodies {
    /// The pseudo-inertia of this link is not positive definite in π₀.
    Nominal(usize),
    /// The iteration does not converge, for example because of a NaN.
    NotConverged,
}

/// Standard parameters of bodies.
#[derive(Debug)]
pub struct Bodies {
    /// Ten for each link, followed by those of joints.
    pub standard: Vec<f64>,
    /// Whether they have the base parameters exactly, or only approximately.
    pub exact: bool,
}

/// Returns the pseudo-inertia of a link's ten parameters, or of a change of them.
fn pseudo_inertia(ten: &[f64]) -> Matrix4<f64> {
    let rows = tables::regressor::pseudo_inertia(std::array::from_fn(|k| ten[k]));
    // It is symmetric: columns equal rows.
    Matrix4::from(rows)
}

/// Returns the inverse of a pseudo-inertia; `None` if it is not positive definite.
fn inverse(ten: &[f64]) -> Option<Matrix4<f64>> {
    pseudo_inertia(ten)
        .cholesky()
        .map(|factor| factor.inverse())
}

/// Returns the gradient of D by the parameters of a link, and its second derivatives.
fn of_link(
    inverse: &Matrix4<f64>,
    nominal: &Matrix4<f64>,
) -> (
    SVector<f64, LINK_PARAMETERS>,
    SMatrix<f64, LINK_PARAMETERS, LINK_PARAMETERS>,
) {
    let units: [Matrix4<f64>; LINK_PARAMETERS] = std::array::from_fn(|k| {
        let mut unit = [0.0; LINK_PARAMETERS];
        unit[k] = 1.0;
        pseudo_inertia(&unit)
    });
    let along = units.map(|unit| inverse * unit);
    let slopes = SVector::from_fn(|k, _| (nominal * units[k]).trace() - along[k].trace());
    let second = SMatrix::from_fn(|i, j| (along[i] * along[j]).trace());
    (slopes, second)
}

/// Derivatives for a joint parameter: r − log r − 1 with r = π/π₀ keeps it positive if π₀ is; otherwise ½ (π − π₀)².
fn of_joint(value: f64, nominal: f64) -> (f64, f64) {
    match nominal > 0.0 {
        true => (1.0 / nominal - 1.0 / value, 1.0 / (value * value)),
        false => (value - nominal, 1.0),
    }
}

/// The optimisation problem.
struct Problem<'a> {
    nominal: &'a [f64],
    /// J₀⁻¹ of the links.
    links: Vec<Matrix4<f64>>,
    k: DMatrix<f64>,
    beta: DVector<f64>,
}

/// Finds the standard parameters of bodies nearest to `nominal` that have the base parameters `beta`, or approximate
/// them if no bodies have them; both lists contain ten for each link, followed by those of joints.
///
/// # Errors
/// See [`NoBodies`].
pub fn nearest(nominal: &[f64], links: usize, map: &Map, beta: &[f64]) -> Result<Bodies, NoBodies> {
    let (tens, _) = nominal.split_at(LINK_PARAMETERS * links);
    let tens = tens.chunks(LINK_PARAMETERS).enumerate();
    let links = tens.map(|(link, ten)| inverse(ten).ok_or(NoBodies::Nominal(link)));
    let mut k = DMatrix::zeros(map.len(), nominal.len());
    for (row, terms) in map.iter().enumerate() {
        for &(place, factor) in terms {
            k[(row, place)] += factor;
        }
    }
    let problem = Problem {
        nominal,
        links: links.collect::<Result<_, _>>()?,
        beta: DVector::from_column_slice(beta),
        k,
    };
    let start = DVector::from_column_slice(nominal);
    let scales = problem.k.abs() * start.abs() + problem.beta.abs();
    let least = scales.amax() * MIN_SCALE;
    let mut near = None;
    for slack in SLACK_SCHEDULE {
        let r = scales.map(|scale| slack * scale.max(least).powi(2));
        let from = near.as_ref().unwrap_or(&start).clone();
        match problem.minimize(from, &r) {
            Some(pi) => near = Some(pi),
            // Keep the previous result, for a larger r.
            None => break,
        }
    }
    let near = near.ok_or(NoBodies::NotConverged)?;
    let none = DVector::zeros(map.len());
    let kept = |pi: &DVector<f64>| {
        let missing = (&problem.beta - &problem.k * pi).amax();
        missing <= CONSTRAINT_TOLERANCE * (problem.k.abs() * pi.abs()).amax()
    };
    let exact = problem.minimize(near.clone(), &none).filter(kept);
    Ok(Bodies {
        exact: exact.is_some(),
        standard: exact.unwrap_or(near).as_slice().to_vec(),
    })
}

impl Problem<'_> {
    /// Finds the minimum of D + ½ Σ (K π − β)²/r, with K π = β where r is 0; `None` if the method does not converge.
    fn minimize(&self, mut pi: DVector<f64>, r: &DVector<f64>) -> Option<DVector<f64>> {
        let (size, k) = (pi.len(), &self.k);
        let joints = LINK_PARAMETERS * self.links.len()..size;
        for _ in 0..MAX_NEWTON_STEPS {
            // H⁻¹ Kᵀ and H⁻¹ g, by blocks: H does not couple links.
            let mut carried = DMatrix::zeros(size, k.nrows());
            let mut downhill = DVector::zeros(size);
            let mut second = DMatrix::zeros(size, size);
            for (link, nominal) in self.links.iter().enumerate() {
                let first = LINK_PARAMETERS * link;
                let own = inverse(&pi.as_slice()[first..first + LINK_PARAMETERS])?;
                let (g, h) = of_link(&own, nominal);
                let factor = h.cholesky()?;
                let columns: DMatrix<f64> = k.columns(first, LINK_PARAMETERS).transpose();
                second
                    .view_mut((first, first), (LINK_PARAMETERS, LINK_PARAMETERS))
                    .copy_from(&h);
                carried
                    .rows_mut(first, LINK_PARAMETERS)
                    .copy_from(&factor.solve(&columns));
                downhill
                    .rows_mut(first, LINK_PARAMETERS)
                    .copy_from(&factor.solve(&g));
            }
            for place in joints.clone() {
                let (g, h) = of_joint(pi[place], self.nominal[place]);
                second[(place, place)] = h;
                downhill[place] = g / h;
                for row in 0..k.nrows() {
                    carried[(place, row)] = k[(row, place)] / h;
                }
            }
            // H Δ + g + Kᵀ ν = 0 and K Δ − r ν = β − K π.
            let missing = &self.beta - k * &pi;
            let schur = k * &carried + DMatrix::from_diagonal(r);
            let multipliers = schur.cholesky()?.solve(&(missing + k * &downhill));
            let step = &carried * multipliers - downhill;
            let moved = k * &step;
            let stiff = moved.iter().zip(r).filter(|(_, r)| **r > 0.0);
            let length = step.dot(&(&second * &step))
                + stiff.map(|(moved, r)| moved * moved / r).sum::<f64>();
            if !length.is_finite() {
                return None;
            }
            let fraction = match length < 1.0 / 16.0 {
                true => 1.0,
                false => 1.0 / (1.0 + length.sqrt()),
            };
            pi += fraction * step;
            if length <= STEP_TOLERANCE {
                return Some(pi);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::{LINK_PARAMETERS, NoBodies, inverse, nearest, pseudo_inertia};

    /// Θ about the frame's origin, h and m of point masses: a body, if there are four or more in general position.
    fn body(points: &[([f64; 3], f64)]) -> Vec<f64> {
        let mut ten = vec![0.0; LINK_PARAMETERS];
        for &([x, y, z], m) in points {
            let terms = [
                y * y + z * z,
                -x * y,
                -x * z,
                x * x + z * z,
                -y * z,
                x * x + y * y,
                x,
                y,
                z,
                1.0,
            ];
            ten.iter_mut()
                .zip(terms)
                .for_each(|(sum, term)| *sum += m * term);
        }
        ten
    }

    fn two() -> (Vec<f64>, Vec<f64>) {
        let corners = [
            [0.1, 0.0, 0.3],
            [-0.2, 0.1, 0.0],
            [0.0, -0.3, 0.1],
            [0.2, 0.2, -0.2],
        ];
        let first = corners.map(|corner| (corner, 0.4));
        let second = corners.map(|[x, y, z]| ([y + 0.1, z, x], 1.0 + x));
        let nominal = [body(&first), body(&second), vec![0.02, 0.0]].concat();
        let other = [body(&second), body(&first), vec![0.05, -0.1]].concat();
        (nominal, other)
    }

    fn beta(map: &[Vec<(usize, f64)>], pi: &[f64]) -> Vec<f64> {
        let sum = |terms: &Vec<(usize, f64)>| terms.iter().map(|&(k, factor)| factor * pi[k]).sum();
        map.iter().map(sum).collect()
    }

    fn map() -> Vec<Vec<(usize, f64)>> {
        vec![
            vec![(5, 1.0), (19, 0.09), (20, 1.0)],
            vec![(15, 1.0)],
            vec![(16, 1.0), (0, -0.5), (3, 0.5)],
            vec![(17, 1.0)],
            vec![(21, 1.0)],
        ]
    }

    #[test]
    fn those_of_the_nominal_bodies_are_they() {
        let (nominal, _) = two();
        let found = nearest(&nominal, 2, &map(), &beta(&map(), &nominal)).expect("bodies");
        assert!(found.exact);
        for (found, expected) in found.standard.iter().zip(&nominal) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }

    /// D of all links and joints, by its definition.
    fn distance(pi: &[f64], nominal: &[f64]) -> f64 {
        let link = |place: usize| {
            let range = LINK_PARAMETERS * place..LINK_PARAMETERS * (place + 1);
            let ratio =
                pseudo_inertia(&pi[range.clone()]) * inverse(&nominal[range]).expect("a body");
            ratio.trace() - ratio.determinant().ln() - 4.0
        };
        let drive = pi[20] / nominal[20];
        let rest = pi[21] - nominal[21];
        link(0) + link(1) + drive - drive.ln() - 1.0 + rest * rest / 2.0
    }

    /// Other parameters with the same β are further away: free parameters are varied, and the dependent ones keep β.
    #[test]
    fn what_is_found_is_the_nearest() {
        let (nominal, other) = two();
        let wanted = beta(&map(), &other);
        let found = nearest(&nominal, 2, &map(), &wanted).expect("bodies");
        assert!(found.exact);
        let found = found.standard;
        for (found, wanted) in beta(&map(), &found).iter().zip(&wanted) {
            assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
        }
        let least = distance(&found, &nominal);
        assert!(least > 0.01 && least < distance(&other, &nominal));
        // Vary each parameter except the last of each row, which corrects β.
        let last = [20, 15, 16, 17, 21];
        for place in (0..22).filter(|place| !last.contains(place)) {
            for by in [1e-4, -1e-4] {
                let mut moved = found.clone();
                moved[place] += by;
                for (row, &corrected) in map().iter().zip(&last) {
                    let rises = row.iter().filter(|(k, _)| *k == place);
                    moved[corrected] -= rises.map(|(_, factor)| factor * by).sum::<f64>();
                }
                assert!(distance(&moved, &nominal) > least, "{place} {by}");
            }
        }
    }

    /// A negative moment of inertia: the result approximates β.
    #[test]
    fn what_no_bodies_have_is_told() {
        let (nominal, other) = two();
        let mut wanted = beta(&map(), &other);
        wanted[1] = -0.1;
        let found = nearest(&nominal, 2, &map(), &wanted).expect("bodies");
        assert!(!found.exact);
        let reached = beta(&map(), &found.standard);
        assert!(
            reached[1] > 0.0 && reached[1] < 0.1 * nominal[15],
            "{reached:?}"
        );
        for link in found.standard[..2 * LINK_PARAMETERS].chunks(LINK_PARAMETERS) {
            assert!(inverse(link).is_some());
        }
        let mut flat = nominal.clone();
        flat[19] = 0.0;
        let none = |nominal: &[f64], beta: &[f64]| nearest(nominal, 2, &map(), beta).err();
        assert_eq!(none(&flat, &wanted), Some(NoBodies::Nominal(1)));
        wanted[1] = 1e300;
        let found = nearest(&nominal, 2, &map(), &wanted).expect("bodies");
        assert!(!found.exact && found.standard.iter().all(|value| value.is_finite()));
        wanted[1] = f64::NAN;
        assert_eq!(none(&nominal, &wanted), Some(NoBodies::NotConverged));
    }
}
