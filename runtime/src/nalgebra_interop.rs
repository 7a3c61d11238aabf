//! Conversions of states to nalgebra types; the rest of the crate works on plain arrays.
//!
//! nalgebra is re-exported as [`hamel::nalgebra`](crate::nalgebra), so a program may also depend on another version of
//! it.
//!
//! ```
//! use hamel::{Block, nalgebra_interop, so3};
//!
//! let blocks = [Block::Flat(3), Block::Rotation];
//! let mut x = vec![1.0, 2.0, 3.0];
//! x.extend(so3::exp([0.0, 0.0, 0.5]));
//! let position = nalgebra_interop::vector::<f64, 3>(&x, 0).expect("three entries");
//! let attitude = nalgebra_interop::rotation(&blocks, &x, 1).expect("a rotation");
//! assert!((attitude.transpose() * attitude).trace() - 3.0 < 1e-14);
//! assert_eq!(position.norm_squared(), 14.0);
//! ```

use nalgebra::{Matrix3, Quaternion, SVectorView, Vector3};

use crate::s3;
use crate::scalar::Scalar;
use crate::so3::{self, Matrix};
use crate::system::Block;

/// Returns the entries of block `index` in x; `None` if there is no such block or x is too short.
pub fn block<'x, S>(blocks: &[Block], x: &'x [S], index: usize) -> Option<&'x [S]> {
    let kind = blocks.get(index)?;
    let start: usize = blocks.iter().take(index).map(|b| b.coordinates()).sum();
    x.get(start..start.checked_add(kind.coordinates())?)
}

/// Returns the rotation (body to world) of block `index`, a rotation or a quaternion; `None` for other kinds.
pub fn rotation<S>(blocks: &[Block], x: &[S], index: usize) -> Option<Matrix3<S>>
where
    S: Scalar + nalgebra::Scalar,
{
    let entries = block(blocks, x, index)?;
    match blocks.get(index)? {
        Block::Rotation => entries.first_chunk().map(|r| matrix(*r)),
        Block::Quaternion => entries.first_chunk().map(|q| matrix(s3::to_matrix(*q))),
        Block::Flat(_) | Block::Circle => None,
    }
}

/// Returns the quaternion of block `index`; `None` for other kinds.
pub fn quaternion<S>(blocks: &[Block], x: &[S], index: usize) -> Option<Quaternion<S>>
where
    S: Scalar + nalgebra::Scalar,
{
    match (blocks.get(index)?, block(blocks, x, index)?) {
        (Block::Quaternion, &[w, i, j, k]) => {
            Some(Quaternion::from_vector(nalgebra::Vector4::new(i, j, k, w)))
        }
        _ => None,
    }
}

/// Returns a view of the N entries of `list` from `start` on; `None` if the list is too short.
pub fn vector<S: nalgebra::Scalar, const N: usize>(
    list: &[S],
    start: usize,
) -> Option<SVectorView<'_, S, N>> {
    let entries = list.get(start..start.checked_add(N)?)?;
    Some(SVectorView::from_slice(entries))
}

/// Converts nine entries, row by row, to an nalgebra matrix, which is stored by columns.
pub fn matrix<S: nalgebra::Scalar + Copy>(rows: Matrix<S>) -> Matrix3<S> {
    Matrix3::from_row_slice(&rows)
}

/// Converts an nalgebra matrix to nine entries, row by row.
pub fn rows<S: nalgebra::Scalar + Copy>(matrix: &Matrix3<S>) -> Matrix<S> {
    core::array::from_fn(|k| matrix[(k / 3, k % 3)])
}

/// Converts three components to an nalgebra vector.
///
/// ```
/// let axis = hamel::nalgebra_interop::vector3([3.0, 0.0, 4.0]).normalize();
/// assert_eq!(axis, hamel::nalgebra::Vector3::new(0.6, 0.0, 0.8));
/// ```
pub fn vector3<S: nalgebra::Scalar>(components: so3::Vector<S>) -> Vector3<S> {
    Vector3::from(components)
}
