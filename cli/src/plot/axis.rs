//! Ticks at round numbers, and how they are labelled.

/// A range with its ticks.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Least value shown.
    pub low: f64,
    /// Largest value shown.
    pub high: f64,
    /// Values of the ticks.
    pub ticks: Vec<f64>,
    /// Labels show values over 10 to this power.
    pub exponent: i32,
    decimals: usize,
}

impl Axis {
    /// An axis over exactly a range, with two ticks at least.
    pub fn exact(low: f64, high: f64, count: f64) -> Self {
        let step = round_step((high - low) / count);
        let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
        if last - first < 1.0 && count < 20.0 {
            return Axis::exact(low, high, count + 1.0);
        }
        let ticks: Vec<f64> = (0..=(last - first) as usize)
            .map(|i| (first + i as f64) * step)
            .collect();
        let size = low.abs().max(high.abs());
        let power = (size.log10().floor() as i32).clamp(-300, 300);
        let exponent = if (-3..5).contains(&power) { 0 } else { power };
        let digits = (step.log10() + 1e-9).floor() as i32 - exponent;
        Axis {
            low,
            high,
            ticks,
            exponent,
            decimals: usize::try_from(-digits).unwrap_or(0).min(12),
        }
    }

    /// An axis over all values with a margin; a constant is in the middle of one.
    pub fn around(values: impl Iterator<Item = f64>, count: f64) -> Self {
        let (low, high) = values
            .filter(|value| value.is_finite())
            .fold((f64::MAX, f64::MIN), |(low, high), v| {
                (low.min(v), high.max(v))
            });
        let (low, high) = if low > high { (0.0, 0.0) } else { (low, high) };
        let size = low.abs().max(high.abs());
        if high - low <= 1e-9 * size || high - low < 1e-300 {
            let margin = if size > 1e-300 { 0.5 * size } else { 1.0 };
            return Axis::exact(low - margin, high + margin, count);
        }
        let margin = 0.08 * (high - low);
        Axis::exact(low - margin, high + margin, count)
    }

    /// Where a value stands in the range, from 0 to 1.
    pub fn place(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// The text of a tick.
    pub fn label(&self, value: f64) -> String {
        let scaled = value / 10_f64.powi(self.exponent);
        let text = format!("{scaled:.*}", self.decimals);
        if text
            .trim_start_matches('-')
            .chars()
            .all(|c| c == '0' || c == '.')
        {
            "0".into()
        } else {
            text.replace('-', "−")
        }
    }

    /// ` ×10⁻¹³`, or nothing.
    pub fn factor(&self) -> String {
        if self.exponent == 0 {
            return String::new();
        }
        const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
        let raise = |c: char| c.to_digit(10).map_or('⁻', |digit| RAISED[digit as usize]);
        let power: String = self.exponent.to_string().chars().map(raise).collect();
        format!(" ×10{power}")
    }
}

/// The least 1, 2 or 5 times a power of ten that is no less.
fn round_step(raw: f64) -> f64 {
    let power = 10_f64.powf(raw.log10().floor());
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|factor| factor * power >= raw * (1.0 - 1e-9))
        .unwrap_or(10.0);
    factor * power
}

#[cfg(test)]
mod tests {
    use super::Axis;

    #[test]
    fn ticks_are_round() {
        let axis = Axis::exact(0.0, 100.0, 5.0);
        assert_eq!(axis.ticks, [0.0, 20.0, 40.0, 60.0, 80.0, 100.0]);
        let axis = Axis::around([-1.0, 1.0].into_iter(), 4.0);
        assert_eq!(
            axis.ticks
                .iter()
                .map(|&t| axis.label(t))
                .collect::<Vec<_>>(),
            ["−1", "0", "1"]
        );
        let axis = Axis::around([0.0, -3.2e-13].into_iter(), 3.0);
        assert_eq!(axis.factor(), " ×10⁻¹³");
        assert_eq!(
            axis.ticks
                .iter()
                .map(|&t| axis.label(t))
                .collect::<Vec<_>>(),
            ["−2", "0"]
        );
        assert_eq!(Axis::around([7.0, 7.0].into_iter(), 3.0).ticks, [5.0, 10.0]);
    }
}
