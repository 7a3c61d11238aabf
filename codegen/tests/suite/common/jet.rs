//! Numbers with first and second derivatives, for references that use no law of mechanics except m r̈ = f.

use std::ops::{Add, Mul, Neg, Sub};

/// Largest number of variables, including the time.
pub const MAX_VARIABLES: usize = 8;

/// A value, its gradient and its Hessian.
#[derive(Clone, Copy)]
pub struct Jet<const N: usize = MAX_VARIABLES> {
    /// The value.
    pub value: f64,
    /// Its first derivatives.
    pub slopes: [f64; N],
    /// Its second derivatives.
    pub bends: [[f64; N]; N],
}

impl<const N: usize> Jet<N> {
    /// Returns a constant.
    pub fn number(value: f64) -> Self {
        Jet {
            value,
            slopes: [0.0; N],
            bends: [[0.0; N]; N],
        }
    }

    /// Returns the variable with this index.
    pub fn variable(place: usize, value: f64) -> Self {
        let mut jet = Jet::number(value);
        jet.slopes[place] = 1.0;
        jet
    }

    /// Returns f(self), given f, f′ and f″ at the value.
    fn of(self, [value, first, second]: [f64; 3]) -> Self {
        let bend = |i: usize, j: usize| {
            second * self.slopes[i] * self.slopes[j] + first * self.bends[i][j]
        };
        Jet {
            value,
            slopes: self.slopes.map(|slope| first * slope),
            bends: std::array::from_fn(|i| std::array::from_fn(|j| bend(i, j))),
        }
    }

    /// Returns the product, by Leibniz's rule.
    fn product(&self, other: &Self) -> Self {
        let (a, b) = (self, other);
        let bend = |i: usize, j: usize| {
            a.bends[i][j] * b.value
                + a.slopes[i] * b.slopes[j]
                + a.slopes[j] * b.slopes[i]
                + a.value * b.bends[i][j]
        };
        Jet {
            value: a.value * b.value,
            slopes: std::array::from_fn(|i| a.slopes[i] * b.value + a.value * b.slopes[i]),
            bends: std::array::from_fn(|i| std::array::from_fn(|j| bend(i, j))),
        }
    }

    /// Returns the sine.
    pub fn sin(self) -> Self {
        let (s, c) = self.value.sin_cos();
        self.of([s, c, -s])
    }

    /// Returns the cosine.
    pub fn cos(self) -> Self {
        let (s, c) = self.value.sin_cos();
        self.of([c, -s, -c])
    }

    /// Returns the first derivative along a direction.
    pub fn along(&self, direction: &[f64]) -> f64 {
        let pairs = self.slopes.iter().zip(direction);
        pairs.map(|(slope, v)| slope * v).sum()
    }

    /// Returns the second derivative along a direction.
    pub fn curvature(&self, direction: &[f64]) -> f64 {
        let rows = self.bends.iter().zip(direction);
        rows.map(|(row, a)| {
            let pairs = row.iter().zip(direction);
            a * pairs.map(|(bend, b)| bend * b).sum::<f64>()
        })
        .sum()
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Jet {
            value: self.value + other.value,
            slopes: std::array::from_fn(|i| self.slopes[i] + other.slopes[i]),
            bends: std::array::from_fn(|i| {
                std::array::from_fn(|j| self.bends[i][j] + other.bends[i][j])
            }),
        }
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.product(&other)
    }
}

impl<const N: usize> Mul<f64> for Jet<N> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.of([factor * self.value, factor, 0.0])
    }
}

/// Returns the sum of two vectors.
pub fn sum(a: [Jet; 3], b: [Jet; 3]) -> [Jet; 3] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// Returns a constant vector.
pub fn constant(v: [f64; 3]) -> [Jet; 3] {
    v.map(Jet::number)
}

/// Rotates a vector about a unit axis, by Rodrigues' formula.
pub fn turned(v: [Jet; 3], axis: [f64; 3], angle: Jet) -> [Jet; 3] {
    let (s, c) = (angle.sin(), angle.cos());
    let along = (0..3).fold(Jet::number(0.0), |total, i| total + v[i] * axis[i]);
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let across = v[k] * axis[j] - v[j] * axis[k];
        v[i] * c + across * s + along * (Jet::number(1.0) - c) * axis[i]
    })
}
