//! The solution nearest to a guess is found if there is one.

use hamel_algebra::nearest_solution::{NearestPointProblem, find_nearest};

/// A point on a circle about the origin, with its distance from a guess in a diagonal metric.
struct Circle {
    radius: f64,
    guess: [f64; 2],
    weights: [f64; 2],
}

impl NearestPointProblem for Circle {
    fn directions(&self) -> usize {
        2
    }
    fn residuals(&self, x: &[f64]) -> Vec<f64> {
        vec![x[0] * x[0] + x[1] * x[1] - self.radius * self.radius]
    }
    fn jacobian(&self, x: &[f64]) -> Vec<Vec<f64>> {
        vec![vec![2.0 * x[0], 2.0 * x[1]]]
    }
    fn error(&self, x: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let entry = |k: usize| self.weights[k] * (x[k] - self.guess[k]);
        let slopes = vec![vec![self.weights[0], 0.0], vec![0.0, self.weights[1]]];
        (vec![entry(0), entry(1)], slopes)
    }
    fn retract(&self, x: &[f64], step: &[f64]) -> Vec<f64> {
        vec![x[0] + step[0], x[1] + step[1]]
    }
}

/// Compares with the least distance of many points of the circle.
#[test]
fn the_nearest_point_of_a_circle_is_found() {
    let mut random = hamel_algebra::residue_pair::Random::new(11);
    let mut number = || (random.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
    for _ in 0..50 {
        let circle = Circle {
            radius: 0.3 + number().abs(),
            guess: [2.0 * number(), 2.0 * number()],
            weights: [1.0 + number().abs(), 1.0 + 2.0 * number().abs()],
        };
        let x = find_nearest(&circle, &circle.guess).expect("a point");
        let distance = |x: &[f64]| circle.error(x).0.iter().map(|e| e * e).sum::<f64>().sqrt();
        let least = (0..5_000)
            .map(|k| {
                let angle = k as f64 * std::f64::consts::TAU / 5_000.0;
                distance(&[circle.radius * angle.cos(), circle.radius * angle.sin()])
            })
            .fold(f64::INFINITY, f64::min);
        assert!(circle.residuals(&x)[0].abs() < 1e-11);
        // The points are 1e-3 apart, and the distance is stationary at the minimum.
        assert!(distance(&x) < least + 1e-7, "{} {least}", distance(&x));
        // The distance is stationary along the circle.
        let (error, slopes) = circle.error(&x);
        let slope = error[1] * slopes[1][1] * x[0] - error[0] * slopes[0][0] * x[1];
        assert!(slope.abs() < 1e-12, "{slope}");
    }
}

#[test]
fn where_there_is_no_solution_none_is_found() {
    struct Unsolvable;
    impl NearestPointProblem for Unsolvable {
        fn directions(&self) -> usize {
            1
        }
        fn residuals(&self, x: &[f64]) -> Vec<f64> {
            vec![x[0] * x[0] + 1.0]
        }
        fn jacobian(&self, x: &[f64]) -> Vec<Vec<f64>> {
            vec![vec![2.0 * x[0]]]
        }
        fn error(&self, x: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
            (vec![x[0] - 0.4], vec![vec![1.0]])
        }
        fn retract(&self, x: &[f64], step: &[f64]) -> Vec<f64> {
            vec![x[0] + step[0]]
        }
    }
    assert_eq!(find_nearest(&Unsolvable, &[0.4]), None);
}
