//! Divides a run in equal steps into segments between times at which steps have to end.

use super::plan::Spacing;
use hamel::{Grid, StepError};

/// Equal steps up to a time, with samples at the ends of some of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// End time.
    pub end: f64,
    /// Grid of the steps.
    pub grid: Grid,
    /// Number of steps between samples.
    every: u64,
    /// The multiple of the sample interval at which it starts, and this interval.
    first: f64,
    time: f64,
}

impl Segment {
    /// Creates a segment without samples between two times.
    fn without_samples(from: f64, end: f64, step: f64) -> Result<Self, StepError> {
        Ok(Segment {
            end,
            grid: Grid::new(from, end, step)?,
            every: u64::MAX,
            first: 0.0,
            time: 0.0,
        })
    }

    /// Returns the time of the sample after `index` steps, if there is one.
    pub fn sample_time(&self, index: u64) -> Option<f64> {
        let at = match index == self.grid.count() {
            true => self.end,
            false => (self.first + (index / self.every) as f64) * self.time,
        };
        index.is_multiple_of(self.every).then_some(at)
    }

    /// Returns the number of steps from the end of step `done` to the next sample, or to the end.
    pub fn steps_to_sample(&self, done: u64) -> u64 {
        (self.grid.count() - done).min(self.every - done % self.every)
    }
}

/// Divides the time between two times into segments, in steps no longer than `step`. For samples at multiples of a
/// time, all steps between the first and the last of these multiples are equal, with the same number from one to the
/// next; the parts before and after are covered by steps that are no longer.
pub fn segments(
    spacing: &Spacing,
    step: f64,
    from: f64,
    end: f64,
) -> Result<Vec<Segment>, StepError> {
    let Spacing::Every(time) = *spacing else {
        return Ok(vec![Segment::without_samples(from, end, step)?]);
    };
    // A time that is a multiple up to rounding is that multiple.
    let is_near = |multiple: f64, t: f64| (multiple * time - t).abs() <= 4.0 * f64::EPSILON * t;
    let nearest = |t: f64| Some((t / time).round()).filter(|multiple| is_near(*multiple, t));
    let (before, behind) = (nearest(from), nearest(end));
    let first = before.unwrap_or_else(|| (from / time).floor() + 1.0);
    let last = behind.unwrap_or_else(|| (end / time).floor());
    let is_none = last < first || last == first && before.is_some();
    if is_none {
        return Ok(vec![Segment::without_samples(from, end, step)?]);
    }
    let mut all = Vec::new();
    let to = |multiple: f64| match behind {
        Some(behind) if behind == multiple => end,
        _ => multiple * time,
    };
    let mut here = from;
    if before.is_none() {
        here = to(first);
        let mut head = Segment::without_samples(from, here, step)?;
        head.every = head.grid.count();
        all.push(head);
    }
    if last > first {
        let body = Segment::without_samples(here, to(last), step)?;
        here = body.end;
        all.push(Segment {
            every: (body.grid.count() / (last - first) as u64).max(1),
            first,
            time,
            ..body
        });
    }
    if behind.is_none() {
        all.push(Segment::without_samples(here, end, step)?);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the times of samples, and the lengths of steps, of all segments between two times.
    fn cut(time: f64, step: f64, from: f64, end: f64) -> (Vec<f64>, Vec<(u64, f64)>) {
        let all = segments(&Spacing::Every(time), step, from, end).expect("segments");
        assert_eq!(all.last().map(|segment| segment.end), Some(end));
        let samples = all.iter().flat_map(|segment| {
            let steps = 1..=segment.grid.count();
            steps.filter_map(|index| segment.sample_time(index))
        });
        let steps = all.iter().map(|s| (s.grid.count(), s.grid.step()));
        (samples.collect(), steps.collect())
    }

    #[test]
    fn samples_are_at_multiples_of_their_time() {
        // Two steps of 1/8 from sample to sample; the parts before and after are not multiples.
        let (samples, steps) = cut(0.25, 0.125, 0.1875, 1.125);
        assert_eq!(samples, [0.25, 0.5, 0.75, 1.0]);
        assert_eq!(steps, [(1, 0.0625), (6, 0.125), (1, 0.125)]);
        // From one multiple to another there are no other parts.
        let (samples, steps) = cut(0.25, 0.125, 0.25, 0.75);
        assert_eq!(samples, [0.5, 0.75]);
        assert_eq!(steps, [(4, 0.125)]);
        // No sample, one at the end, and one in between.
        assert_eq!(cut(1.0, 0.25, 0.125, 0.5).0, [0.0; 0]);
        assert_eq!(cut(1.0, 0.25, 0.0, 0.5), (vec![], vec![(2, 0.25)]));
        assert_eq!(cut(1.0, 0.25, 0.5, 1.0), (vec![1.0], vec![(2, 0.25)]));
        assert_eq!(cut(1.0, 0.25, 0.5, 1.25).0, [1.0]);
        // A step longer than the whole segment.
        assert_eq!(cut(1.0, 0.25, 0.0, 0.125), (vec![], vec![(1, 0.125)]));
    }

    /// 3 times 0.1 is not 0.3 in binary: no step covers only this difference.
    #[test]
    fn a_multiple_but_for_rounding_is_a_multiple() {
        for n in 1..2000 {
            let end = f64::from(n) / 10.0;
            let (samples, steps) = cut(0.1, 0.02, 0.0, end);
            assert_eq!(samples.len(), n as usize);
            assert_eq!(samples.last(), Some(&end));
            assert!(
                steps.len() == 1 && steps[0].0 == 5 * n as u64,
                "{n} {steps:?}"
            );
            let (samples, steps) = cut(0.1, 0.02, end, end + 0.5);
            assert_eq!(samples.len(), 5, "{n} {samples:?}");
            assert!(steps.iter().all(|(_, step)| *step > 0.019), "{n} {steps:?}");
        }
    }
}
