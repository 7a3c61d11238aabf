//! Retractions and related maps on a whole coordinate vector x, block by block.
//!
//! Lists shorter than the blocks require are processed up to the last complete block; longer lists keep their tail
//! unchanged. The integrators compare lengths before a step and return [`StepError::Shape`](crate::StepError::Shape).
//!
//! All functions that move x are `inline(always)`, down to single entries: the kinds of blocks are constants of a
//! generated system, and a call would pass matrices through memory, which costs a step of `Rkmk4` more than its
//! accelerations.
//!
//! ```
//! use hamel::{Block, manifold, s1};
//!
//! let blocks = [Block::Flat(1), Block::Circle];
//! let mut x = [0.0; 3];
//! manifold::origin(&blocks, &mut x);
//! manifold::retract(&blocks, &mut x, &[2.0, 0.5]);
//! assert_eq!(x, [2.0, 0.5_f64.cos(), 0.5_f64.sin()]);
//! assert!(manifold::defect(&blocks, &x) < 1e-15);
//! ```

use crate::scalar::Scalar;
use crate::store::add;
use crate::system::Block;
use crate::{s1, s3, so3};

/// Returns ν, the number of entries of x.
#[inline]
pub fn coordinates(blocks: &[Block]) -> usize {
    blocks.iter().map(|block| block.coordinates()).sum()
}

/// Returns the number of entries of a chart vector.
#[inline]
pub fn chart(blocks: &[Block]) -> usize {
    blocks.iter().map(|block| block.chart()).sum()
}

/// Sets x, a list of zeros, to the origin of its manifold: 0 (flat), the angle 0 (circle), and the identity (quaternion,
/// rotation).
pub fn origin<S: Scalar>(blocks: &[Block], x: &mut [S]) {
    let mut x = x;
    for block in blocks {
        let Some((here, rest)) = x.split_at_mut_checked(block.coordinates()) else {
            return;
        };
        match block {
            Block::Flat(_) => {}
            Block::Circle | Block::Quaternion => {
                if let Some(first) = here.first_mut() {
                    *first = S::from_f64(1.0);
                }
            }
            Block::Rotation => {
                if let Some(r) = here.first_chunk_mut() {
                    *r = so3::identity();
                }
            }
        }
        x = rest;
    }
}

/// Replaces x by its rate ẋ for the chart rate w: w (flat), θ̇ (−s, c) (circle), ½ q ⊗ (0, ω) (quaternion), R ω̂
/// (rotation).
#[inline(always)]
pub fn rate<S: Scalar>(blocks: &[Block], x: &mut [S], w: &[S]) {
    let (mut x, mut w) = (x, w);
    for block in blocks {
        let (Some((here, x_rest)), Some((along, w_rest))) = (
            x.split_at_mut_checked(block.coordinates()),
            w.split_at_checked(block.chart()),
        ) else {
            return;
        };
        match block {
            Block::Flat(_) => {
                for (entry, w) in here.iter_mut().zip(along) {
                    *entry = *w;
                }
            }
            Block::Circle => {
                if let (Some(p), [theta_dot]) = (here.first_chunk_mut(), along) {
                    *p = s1::rate(*p, *theta_dot);
                }
            }
            Block::Quaternion => {
                if let (Some(q), Some(w)) = (here.first_chunk_mut(), along.first_chunk()) {
                    *q = s3::rate(*q, *w);
                }
            }
            Block::Rotation => {
                if let (Some(r), Some(w)) = (here.first_chunk_mut(), along.first_chunk()) {
                    *r = so3::rate(*r, *w);
                }
            }
        }
        (x, w) = (x_rest, w_rest);
    }
}

/// Replaces x by −Ψ φ of KR18 (8) for the constraints of its blocks: unit length (circle, quaternion) and RᵀR = I
/// (rotation); 0 for flat blocks.
pub fn correction<S: Scalar>(blocks: &[Block], x: &mut [S]) {
    let mut x = x;
    for block in blocks {
        let Some((here, rest)) = x.split_at_mut_checked(block.coordinates()) else {
            return;
        };
        match block {
            Block::Flat(_) => here.fill(S::default()),
            Block::Circle => {
                if let Some(p) = here.first_chunk_mut() {
                    *p = s1::correction(*p);
                }
            }
            Block::Quaternion => {
                if let Some(q) = here.first_chunk_mut() {
                    *q = s3::correction(*q);
                }
            }
            Block::Rotation => {
                if let Some(r) = here.first_chunk_mut() {
                    *r = so3::correction(*r);
                }
            }
        }
        x = rest;
    }
}

/// Returns the largest violation of the constraints of the blocks: | |x|² − 1 | (circle, quaternion) and
/// max |RᵀR − I| (rotation).
pub fn defect<S: Scalar>(blocks: &[Block], x: &[S]) -> S {
    let mut largest = S::default();
    let mut x = x;
    for block in blocks {
        let Some((here, rest)) = x.split_at_checked(block.coordinates()) else {
            break;
        };
        let defect = match block {
            Block::Flat(_) => None,
            Block::Circle => here.first_chunk().map(|p| s1::defect(*p)),
            Block::Quaternion => here.first_chunk().map(|q| s3::defect(*q)),
            Block::Rotation => here.first_chunk().map(|r| so3::defect(*r)),
        };
        largest = defect.map_or(largest, |defect| Scalar::max(largest, defect));
        x = rest;
    }
    largest
}

/// Moves x along the chart vector u: x + u (flat), turned by u (circle), q ⊗ exp(u) (quaternion),
/// R exp(û) (rotation).
#[inline(always)]
pub fn retract<S: Scalar>(blocks: &[Block], x: &mut [S], u: &[S]) {
    let (mut x, mut u) = (x, u);
    for block in blocks {
        let (Some((here, x_rest)), Some((along, u_rest))) = (
            x.split_at_mut_checked(block.coordinates()),
            u.split_at_checked(block.chart()),
        ) else {
            return;
        };
        match block {
            Block::Flat(_) => add(here, along),
            Block::Circle => {
                if let (Some(p), [u]) = (here.first_chunk_mut(), along) {
                    *p = s1::retract(*p, *u);
                }
            }
            Block::Quaternion => {
                if let (Some(q), Some(u)) = (here.first_chunk_mut(), along.first_chunk()) {
                    *q = s3::retract(*q, *u);
                }
            }
            Block::Rotation => {
                if let (Some(r), Some(u)) = (here.first_chunk_mut(), along.first_chunk()) {
                    *r = so3::retract(*r, *u);
                }
            }
        }
        (x, u) = (x_rest, u_rest);
    }
}

/// Replaces the chart rate w by u̇: the rate of the chart vector u for which x, moved along u, has the chart rate w.
///
/// This is [`so3::dexpinv`] on quaternions and rotations, and w itself elsewhere.
#[inline(always)]
pub fn dexpinv<S: Scalar>(blocks: &[Block], u: &[S], w: &mut [S]) {
    let (mut u, mut w) = (u, w);
    for block in blocks {
        let (Some((along, u_rest)), Some((rate, w_rest))) = (
            u.split_at_checked(block.chart()),
            w.split_at_mut_checked(block.chart()),
        ) else {
            return;
        };
        if let Block::Quaternion | Block::Rotation = block
            && let (Some(u), Some(w)) = (along.first_chunk(), rate.first_chunk_mut())
        {
            *w = so3::dexpinv(*u, *w);
        }
        (u, w) = (u_rest, w_rest);
    }
}

/// Removes the drift off the manifold that rounding causes: scales circles and quaternions to unit norm, and applies
/// one Newton polar step to rotations. Flat blocks keep their values.
#[inline(always)]
pub fn normalise<S: Scalar>(blocks: &[Block], x: &mut [S]) {
    let mut x = x;
    for block in blocks {
        let Some((here, rest)) = x.split_at_mut_checked(block.coordinates()) else {
            return;
        };
        match block {
            Block::Flat(_) => {}
            Block::Circle => {
                if let Some(p) = here.first_chunk_mut() {
                    *p = s1::normalise(*p);
                }
            }
            Block::Quaternion => {
                if let Some(q) = here.first_chunk_mut() {
                    *q = s3::normalise(*q);
                }
            }
            Block::Rotation => {
                if let Some(r) = here.first_chunk_mut() {
                    *r = so3::polar(*r);
                }
            }
        }
        x = rest;
    }
}
