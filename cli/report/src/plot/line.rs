//! Simplifies polylines to the points that can be distinguished.

/// A point of the drawing.
pub type Point = (f64, f64);

/// Keeps the first, least, greatest and last point of every column of pixels.
pub fn by_column(points: &[Point]) -> Vec<Point> {
    let mut kept = Vec::new();
    for column in points.chunk_by(|a, b| a.0.floor() == b.0.floor()) {
        let order = |a: &usize, b: &usize| column[*a].1.total_cmp(&column[*b].1);
        let mut indices = vec![0, column.len() - 1];
        indices.extend((0..column.len()).min_by(order));
        indices.extend((0..column.len()).max_by(order));
        indices.sort_unstable();
        indices.dedup();
        kept.extend(indices.into_iter().map(|index| column[index]));
    }
    kept
}

/// Simplifies by the algorithm of Douglas and Peucker: omits points that lie within a tolerance of the line without
/// them.
pub fn simplify(points: &[Point], tolerance: f64) -> Vec<Point> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[points.len() - 1] = true;
    let mut stack = vec![(0, points.len() - 1)];
    while let Some((first, last)) = stack.pop() {
        let far = (first + 1..last)
            .map(|index| (index, distance(points[index], points[first], points[last])))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, distance)) = far
            && distance > tolerance
        {
            keep[index] = true;
            stack.push((first, index));
            stack.push((index, last));
        }
    }
    points
        .iter()
        .zip(&keep)
        .filter(|(_, keep)| **keep)
        .map(|(&point, _)| point)
        .collect()
}

/// Returns the distance of a point from a segment.
fn distance(point: Point, a: Point, b: Point) -> f64 {
    let (ux, uy) = (b.0 - a.0, b.1 - a.1);
    let (px, py) = (point.0 - a.0, point.1 - a.1);
    let square = ux * ux + uy * uy;
    let along = if square > 0.0 {
        ((px * ux + py * uy) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (px - along * ux).hypot(py - along * uy)
}

#[cfg(test)]
mod tests {
    use super::{by_column, simplify};

    #[test]
    fn corners_stay() {
        let points: Vec<_> = (0..=20)
            .map(|i| {
                (
                    f64::from(i),
                    if i <= 10 {
                        f64::from(i)
                    } else {
                        20.0 - f64::from(i)
                    },
                )
            })
            .collect();
        assert_eq!(
            simplify(&points, 0.1),
            [(0.0, 0.0), (10.0, 10.0), (20.0, 0.0)]
        );
    }

    #[test]
    fn peaks_stay() {
        let points = [
            (0.0, 0.0),
            (0.2, 9.0),
            (0.4, -9.0),
            (0.6, 1.0),
            (0.8, 2.0),
            (1.0, 0.0),
        ];
        assert_eq!(
            by_column(&points),
            [(0.0, 0.0), (0.2, 9.0), (0.4, -9.0), (0.8, 2.0), (1.0, 0.0)]
        );
    }
}
