//! Angles and rotations; rounded multiples of a right angle become exact.

use crate::decimal::Decimal;
use hamel_language::expression::call;
use hamel_language::syntax::ast::Expr;
use std::f64::consts::FRAC_PI_2;

/// An angle in radians.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Angle {
    /// A multiple of π/2, by a factor from −1 to 2.
    Right(i8),
    /// An angle that is not a multiple of π/2, as a decimal number of radians.
    Decimal(Decimal),
}

impl Angle {
    /// Reads an angle: the multiple of π/2 if one lies within the tolerance (rad), else the decimal itself.
    pub(crate) fn read(number: &Decimal, tolerance: f64) -> Self {
        let quarters = (number.value / FRAC_PI_2).round();
        let near = (number.value - quarters * FRAC_PI_2).abs() <= tolerance;
        // More than two full turns are not meant as a right angle.
        if !near || quarters.abs() > 8.0 {
            return Angle::Decimal(number.clone());
        }
        match (quarters as i8).rem_euclid(4) {
            3 => Angle::Right(-1),
            quarters => Angle::Right(quarters),
        }
    }

    /// Whether the angle is exactly zero.
    pub(crate) fn is_zero(&self) -> bool {
        match self {
            Angle::Right(quarters) => *quarters == 0,
            Angle::Decimal(number) => number.is_zero(),
        }
    }

    /// Returns the angle as it is written in a description.
    pub(crate) fn expr(&self) -> Expr {
        let pi = Expr::name("pi");
        match self {
            Angle::Right(0) => 0.into(),
            Angle::Right(1) => pi / 2,
            Angle::Right(2) => pi,
            Angle::Right(_) => -pi / 2,
            Angle::Decimal(number) => number.into(),
        }
    }
}

/// Rotation by roll, pitch and yaw about fixed axes, R = R_z(yaw) R_y(pitch) R_x(roll).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rotation(pub(crate) [Angle; 3]);

impl Rotation {
    /// Returns the identity.
    pub(crate) fn identity() -> Self {
        Rotation(std::array::from_fn(|_| Angle::Right(0)))
    }

    /// Returns the rotation as it is written in a description; `None` for the identity.
    pub(crate) fn expr(&self) -> Option<Expr> {
        let turns: Vec<(&str, &Angle)> = ["rotx", "roty", "rotz"]
            .into_iter()
            .zip(&self.0)
            .filter(|(_, angle)| !angle.is_zero())
            .collect();
        match turns.as_slice() {
            [] => None,
            [(function, angle)] => Some(call(function, [angle.expr()])),
            _ => Some(call("rpy", self.0.iter().map(Angle::expr))),
        }
    }

    /// Returns the rotation matrix, with entries −1, 0 and 1, if all angles are multiples of a right angle.
    pub(crate) fn exact(&self) -> Option<[[i8; 3]; 3]> {
        let mut product = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
        for (axis, angle) in self.0.iter().enumerate() {
            let (c, s) = match angle {
                Angle::Right(0) => (1, 0),
                Angle::Right(1) => (0, 1),
                Angle::Right(2) => (-1, 0),
                Angle::Right(_) => (0, -1),
                Angle::Decimal(number) if number.is_zero() => (1, 0),
                Angle::Decimal(_) => return None,
            };
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut turn = [[0; 3]; 3];
            turn[axis][axis] = 1;
            turn[j][j] = c;
            turn[k][k] = c;
            turn[j][k] = -s;
            turn[k][j] = s;
            // Roll acts first, so later rotations multiply from the left.
            let mut next = [[0; 3]; 3];
            for row in 0..3 {
                for column in 0..3 {
                    next[row][column] = (0..3).map(|i| turn[row][i] * product[i][column]).sum();
                }
            }
            product = next;
        }
        Some(product)
    }
}

#[cfg(test)]
mod tests {
    use super::{Angle, Rotation};
    use crate::decimal::Decimal;

    fn angle(text: &str) -> Angle {
        Angle::read(&Decimal::parse(text).expect("a number"), 1e-9)
    }

    #[test]
    fn right_angles_are_found() {
        for (written, text) in [
            ("1.57079632679", "pi / 2"),
            ("-1.5707963267948966", "-pi / 2"),
            ("3.14159265359", "pi"),
            ("-3.14159265359", "pi"),
            ("4.71238898038469", "-pi / 2"),
            ("6.28318530718", "0"),
            ("1e-17", "0"),
            ("1.57079", "1.57079"),
            ("0.3", "0.3"),
        ] {
            assert_eq!(angle(written).expr().to_string(), text);
        }
    }

    /// In URDF, roll about x acts on a point first, then yaw about the fixed z axis.
    #[test]
    fn roll_comes_before_yaw() {
        let turned = Rotation([
            angle("1.570796326794897"),
            angle("0"),
            angle("1.570796326794897"),
        ]);
        // Roll takes e_y to e_z, where yaw leaves it; yaw takes e_x to e_y.
        assert_eq!(turned.exact(), Some([[0, 0, 1], [1, 0, 0], [0, 1, 0]]));
        let text = turned.expr().map(|rotation| rotation.to_string());
        assert_eq!(text.as_deref(), Some("rpy(pi / 2, 0, pi / 2)"));
        assert_eq!(
            Rotation([angle("0.1"), angle("0"), angle("0")]).exact(),
            None
        );
    }
}
