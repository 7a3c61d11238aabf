//! Colours, on light ground and on dark.
//!
//! A picture is drawn in its light colours, as attributes; on a dark page, a style sheet replaces each of them by its
//! counterpart.

use plotters::style::RGBColor;

/// A colour on light ground, and its counterpart on dark.
pub type Pair = (RGBColor, RGBColor);

const fn rgb(code: u32) -> RGBColor {
    RGBColor((code >> 16) as u8, (code >> 8) as u8, code as u8)
}

const fn pair(light: u32, dark: u32) -> Pair {
    (rgb(light), rgb(dark))
}

/// The background.
pub const GROUND: Pair = pair(0xffffff, 0x11161d);
/// Headings.
pub const INK: Pair = pair(0x1c2128, 0xe8edf3);
/// Labels.
pub const SOFT: Pair = pair(0x59636e, 0x9aa5b1);
/// Grid and frame.
pub const GRID: Pair = pair(0xe3e7ec, 0x2a323c);
/// A sphere.
pub const BALL: Pair = pair(0xf4f6f9, 0x1a212a);
/// An ellipsoid.
pub const SHELL: Pair = pair(0x138a5c, 0x56d49c);

/// Colours of lines, in order.
pub const SERIES: [Pair; 10] = [
    pair(0x1f6feb, 0x6cb0ff),
    pair(0xd1660b, 0xffab5e),
    pair(0x138a5b, 0x55d49b),
    pair(0x8b45d6, 0xc8a2ff),
    pair(0xcf2a55, 0xff85a1),
    pair(0x0b8293, 0x5fd3e0),
    pair(0x8a6d0b, 0xe0c25a),
    pair(0x5c6672, 0xaab4c0),
    pair(0x7a4a21, 0xd3a27a),
    pair(0x3f4bb5, 0x9fa8ff),
];

/// Colours from the first to the last time, visible on both grounds.
const RAMP: [[f64; 3]; 4] = [
    [43.0, 124.0, 238.0],
    [139.0, 92.0, 230.0],
    [226.0, 70.0, 140.0],
    [240.0, 140.0, 20.0],
];

/// Returns the colour of the line with this index.
pub fn series(index: usize) -> RGBColor {
    SERIES[index % SERIES.len()].0
}

/// Returns the colour of a time from 0 to 1.
pub fn ramp(time: f64) -> RGBColor {
    let place = time.clamp(0.0, 1.0) * (RAMP.len() - 1) as f64;
    let index = (place as usize).min(RAMP.len() - 2);
    let part = place - index as f64;
    let [r, g, b] = std::array::from_fn(|i| {
        (RAMP[index][i] + part * (RAMP[index + 1][i] - RAMP[index][i])).round() as u8
    });
    RGBColor(r, g, b)
}

/// Formats a colour for SVG.
pub fn code(RGBColor(r, g, b): RGBColor) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// Returns the style sheet of all pictures: fonts, and the counterparts on dark ground.
pub fn sheet() -> String {
    let mut text = String::from(
        "svg text{font-family:system-ui,-apple-system,\"Segoe UI\",\"DejaVu Sans\",sans-serif}\n\
         svg polyline,svg line{stroke-linejoin:round;stroke-linecap:round}\n\
         @media(prefers-color-scheme:dark){\n",
    );
    for (light, dark) in [GROUND, INK, SOFT, GRID, BALL, SHELL]
        .into_iter()
        .chain(SERIES)
    {
        let (light, dark) = (code(light), code(dark));
        text.push_str(&format!(
            "svg [fill=\"{light}\"]{{fill:{dark}}} svg [stroke=\"{light}\"]{{stroke:{dark}}}\n"
        ));
    }
    text.push_str("}\n");
    text
}
