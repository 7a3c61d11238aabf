//! A frame with its grid, ticks and labels.

use super::figure::{
    Anchor, Area, DrawResult, SUBPIXELS, draw_error, letters, stroke, unit, write,
};
use super::line::Point;
use super::theme;
use super::width::fit;
use crate::number::digits;
use plotters::chart::ChartBuilder;
use plotters::coord::combinators::IntoLogRange;
use plotters::style::TRANSPARENT;

/// The area of a diagram, in pixels.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Left edge.
    pub x: f64,
    /// Upper edge.
    pub y: f64,
    /// From left to right.
    pub width: f64,
    /// From top to bottom.
    pub height: f64,
}

/// A range of values along an edge of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    low: f64,
    high: f64,
    logarithmic: bool,
    /// Labels show values divided by 10 to this power.
    exponent: i32,
}

impl Axis {
    /// Creates an axis for exactly this range.
    pub fn exact(low: f64, high: f64) -> Self {
        let size = low.abs().max(high.abs());
        let power = (size.log10().floor() as i32).clamp(-300, 300);
        Axis {
            low,
            high,
            logarithmic: false,
            exponent: if (-3..5).contains(&power) { 0 } else { power },
        }
    }

    /// Creates an axis for all finite values, with a margin; a constant is in the middle.
    pub fn with_margin(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = extent(values).unwrap_or((0.0, 0.0));
        let size = low.abs().max(high.abs());
        if high - low <= 1e-9 * size || high - low < 1e-300 {
            let margin = if size > 1e-300 { 0.5 * size } else { 1.0 };
            return Axis::exact(low - margin, high + margin);
        }
        let margin = 0.08 * (high - low);
        Axis::exact(low - margin, high + margin)
    }

    /// Creates a logarithmic axis for all positive finite values, with a margin.
    pub fn logarithmic(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = extent(values.filter(|&value| value > 0.0)).unwrap_or((0.1, 1.0));
        // An infinite range would have infinitely many ticks.
        let (low, high) = (low.max(1e-100), high.min(1e100));
        let margin = (high / low).powf(0.04).max(1.5);
        Axis {
            low: low / margin,
            high: high * margin,
            logarithmic: true,
            exponent: 0,
        }
    }

    /// Creates a logarithmic axis for exactly this range of positive values.
    pub fn exact_logarithmic(low: f64, high: f64) -> Self {
        Axis {
            logarithmic: true,
            exponent: 0,
            ..Axis::exact(low, high)
        }
    }

    /// Returns the least value shown.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// Returns the position of a value in the range, from 0 to 1.
    pub fn part(&self, value: f64) -> f64 {
        if self.logarithmic {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// Returns the text of a tick.
    fn label(&self, value: f64) -> String {
        if self.logarithmic {
            let power = value.log10().round() as i32;
            return match power {
                0 => "1".into(),
                1 => "10".into(),
                _ => format!("10{}", superscript(power)),
            };
        }
        if value.abs() < 1e-9 * (self.high - self.low) {
            return "0".into();
        }
        digits(value / 10_f64.powi(self.exponent), 4).replace('-', "−")
    }

    /// Returns the common factor of the labels, such as ` ×10⁻¹³`, or nothing.
    pub fn factor(&self) -> String {
        match self.exponent {
            0 => String::new(),
            power => format!(" ×10{}", superscript(power)),
        }
    }
}

/// Returns the least and the greatest finite value.
fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .filter(|value| value.is_finite())
        .fold(None, |range, value| match range {
            None => Some((value, value)),
            Some((low, high)) => Some((f64::min(low, value), f64::max(high, value))),
        })
}

/// Formats an exponent in superscript digits.
fn superscript(power: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |c: char| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    power.to_string().chars().map(raise).collect()
}

/// A frame with its two axes.
#[derive(Clone, Copy, Debug)]
pub struct Axes {
    /// The frame.
    pub frame: Frame,
    /// Along the lower edge.
    pub across: Axis,
    /// Along the left edge.
    pub up: Axis,
}

/// Width of the labels of the left edge, and height of those of the lower one.
const LABEL_MARGINS: (f64, f64) = (54.0, 26.0);

impl Axes {
    /// Returns the position of a point in the drawing.
    pub fn place(&self, x: f64, y: f64) -> Point {
        let Frame {
            x: left,
            y: top,
            width,
            height,
        } = self.frame;
        (
            left + width * self.across.part(x),
            top + height * (1.0 - self.up.part(y)),
        )
    }

    /// Draws grid and labels; those of the lower edge only if requested.
    ///
    /// # Errors
    /// If the drawing library fails.
    pub fn draw(&self, area: &Area, labels_below: bool) -> DrawResult {
        let Frame {
            x,
            y,
            width,
            height,
        } = self.frame;
        let below = if labels_below { LABEL_MARGINS.1 } else { 0.0 };
        let part = area.clone().shrink(
            (unit(x - LABEL_MARGINS.0), unit(y)),
            (unit(width + LABEL_MARGINS.0), unit(height + below)),
        );
        let text = letters(12.0, theme::SOFT.0, Anchor::Start, false);
        let lines = (
            (width / 62.0).clamp(2.0, 8.0) as usize,
            (height / 34.0).clamp(2.0, 9.0) as usize,
        );
        let (across, up) = (self.across, self.up);
        macro_rules! mesh {
            ($x:expr, $y:expr) => {
                ChartBuilder::on(&part)
                    .x_label_area_size(unit(below))
                    .y_label_area_size(unit(LABEL_MARGINS.0))
                    .build_cartesian_2d($x, $y)
                    .map_err(draw_error)?
                    .configure_mesh()
                    .x_labels(lines.0)
                    .y_labels(lines.1)
                    .x_label_formatter(&|value| across.label(*value))
                    .y_label_formatter(&|value| up.label(*value))
                    .label_style(text)
                    .axis_style(stroke(theme::GRID.0, 1.0))
                    .bold_line_style(stroke(theme::GRID.0, 1.0))
                    .light_line_style(TRANSPARENT)
                    .set_all_tick_mark_size((4.0 * SUBPIXELS) as u32)
                    .draw()
                    .map_err(draw_error)
            };
        }
        let (x, y) = (across.low..across.high, up.low..up.high);
        match (across.logarithmic, up.logarithmic) {
            (false, false) => mesh!(x, y),
            (true, true) => mesh!(x.log_scale(), y.log_scale()),
            (false, true) => mesh!(x, y.log_scale()),
            (true, false) => mesh!(x.log_scale(), y),
        }
    }

    /// Writes a name above the frame.
    ///
    /// # Errors
    /// If the drawing library fails.
    pub fn name(&self, area: &Area, name: &str) -> DrawResult {
        let style = letters(12.0, theme::INK.0, Anchor::Start, true);
        let name = fit(name, 12.0, true, self.frame.width);
        write(area, &name, (self.frame.x, self.frame.y - 13.0), &style)
    }

    /// Writes the name of the lower edge below it.
    ///
    /// # Errors
    /// If the drawing library fails.
    pub fn write_x_label(&self, area: &Area, name: &str) -> DrawResult {
        let style = letters(12.0, theme::SOFT.0, Anchor::Middle, false);
        let at = (
            self.frame.x + 0.5 * self.frame.width,
            self.frame.y + self.frame.height + 38.0,
        );
        write(area, name, at, &style)
    }
}

#[cfg(test)]
mod tests {
    use super::Axis;

    #[test]
    fn labels_are_round() {
        let axis = Axis::exact(0.0, 100.0);
        assert_eq!([axis.label(20.0), axis.label(1e-12)], ["20", "0"]);
        let axis = Axis::with_margin([0.0, -3.2e-13].into_iter());
        assert_eq!(axis.factor(), " ×10⁻¹³");
        assert_eq!(axis.label(-2e-13), "−2");
        let axis = Axis::logarithmic([1e-12, 0.0, f64::NAN, 1.0].into_iter());
        assert_eq!([axis.label(1e-9), axis.label(1.0)], ["10⁻⁹", "1"]);
        assert!(axis.low < 1e-12 && axis.high > 1.0);
        assert!((axis.part(1e-6) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_constant_is_in_the_middle() {
        let axis = Axis::with_margin([7.0, 7.0].into_iter());
        assert_eq!(axis.part(7.0), 0.5);
        assert_eq!(Axis::with_margin(std::iter::empty()).part(0.0), 0.5);
    }
}
