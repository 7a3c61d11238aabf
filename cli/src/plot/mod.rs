//! Plots as SVG, written by hand: lines over time, and the path of a body axis on a sphere.
//!
//! The text is deterministic. Colours follow the reader's light or dark scheme.

mod axis;
mod chart;
mod line;
mod sphere;

use chart::Area;

/// Lines over time that share a vertical axis.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What is drawn.
    pub title: String,
    /// Names and values, one value for every time of the picture.
    pub lines: Vec<(String, Vec<f64>)>,
}

impl Panel {
    /// A panel without lines.
    pub fn new(title: &str) -> Self {
        Panel {
            title: title.to_string(),
            lines: Vec::new(),
        }
    }
}

/// A curve of unit vectors over the times of the picture.
#[derive(Clone, Debug)]
pub struct Path {
    /// What is drawn.
    pub title: String,
    /// Unit vectors in world axes.
    pub points: Vec<[f64; 3]>,
}

/// All that is drawn.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Heading.
    pub title: String,
    /// A sentence below it.
    pub subtitle: String,
    /// Times of all values, ascending.
    pub time: Vec<f64>,
    /// Panels from top to bottom; the last one is lower.
    pub panels: Vec<Panel>,
    /// The sphere beside them, if there is one.
    pub path: Option<Path>,
}

/// Colours of lines in turn; on light and on dark ground.
const COLOURS: [(&str, &str); 8] = [
    ("#1f6feb", "#6cb0ff"),
    ("#d1660b", "#ffab5e"),
    ("#138a5b", "#55d49b"),
    ("#8b45d6", "#c8a2ff"),
    ("#cf2a55", "#ff85a1"),
    ("#0b8293", "#5fd3e0"),
    ("#8a6d0b", "#e0c25a"),
    ("#5c6672", "#aab4c0"),
];

const HEAD: f64 = 66.0;
const TITLE: f64 = 26.0;
const GAP: f64 = 22.0;
const FOOT: f64 = 50.0;
const LEFT: f64 = 62.0;
const LABELS: f64 = 62.0;

/// The SVG text of a picture.
pub fn svg(picture: &Picture) -> String {
    let wide = if picture.path.is_some() { 590.0 } else { 800.0 };
    let upper = if picture.panels.len() > 2 {
        140.0
    } else {
        200.0
    };
    let height_of = |index: usize| {
        if index + 1 == picture.panels.len() {
            92.0
        } else {
            upper
        }
    };
    let mut charts = String::new();
    let mut top = HEAD;
    for (index, panel) in picture.panels.iter().enumerate() {
        top += TITLE;
        let area = Area {
            x: LEFT,
            y: top,
            width: wide - LEFT - LABELS,
            height: height_of(index),
        };
        let last = index + 1 == picture.panels.len();
        charts.push_str(&chart::panel(panel, &picture.time, &area, last));
        top += area.height + GAP;
    }
    let height = top - GAP + FOOT;
    let mut width = wide;
    if let Some(path) = &picture.path {
        width += 380.0;
        let end = picture.time.last().copied().unwrap_or(0.0);
        charts.push_str(&sphere::sphere(
            path,
            end,
            wide + 180.0,
            (HEAD + height) / 2.0 - 8.0,
            140.0,
        ));
    }
    let title = escape(&picture.title);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"{title}\">\n\
         <title>{title}</title>\n<style>\n{}</style>\n\
         <rect class=\"ground\" width=\"{width}\" height=\"{height}\" rx=\"12\"/>\n\
         <text class=\"head\" x=\"24\" y=\"34\">{title}</text>\n\
         <text class=\"sub\" x=\"24\" y=\"55\">{}</text>\n{charts}</svg>\n",
        style(),
        escape(&picture.subtitle)
    )
}

fn style() -> String {
    let scheme = |ground: &str,
                  ink: &str,
                  soft: &str,
                  grid: &str,
                  ball: &str,
                  indent: &str,
                  pick: fn(&(&'static str, &'static str)) -> &'static str| {
        let mut text = format!(
            "{indent}.ground{{fill:{ground}}} text{{fill:{soft}}} .head,.name{{fill:{ink}}} .grid,.frame,.mesh{{stroke:{grid}}} .zero,.rim,.pole{{stroke:{soft}}} .ball{{fill:{ball}}} .halo{{stroke:{ground}}}\n"
        );
        for (index, colours) in COLOURS.iter().enumerate() {
            let colour = pick(colours);
            text.push_str(&format!(
                "{indent}.s{index}{{stroke:{colour}}} .l{index}{{fill:{colour}}}\n"
            ));
        }
        text
    };
    let mut text = String::from(
        "text{font:12px system-ui,-apple-system,\"Segoe UI\",\"DejaVu Sans\",sans-serif}\n\
         .head{font-size:18px;font-weight:600} .sub{font-size:13px} .name{font-weight:600} .label{font-weight:600}\n\
         .grid,.frame,.zero,.mesh,.rim,.pole,.line,.lead,.path{fill:none;stroke-linejoin:round;stroke-linecap:round}\n\
         .grid,.frame{stroke-width:1} .zero{stroke-width:1;stroke-dasharray:2 4} .line{stroke-width:1.8} .lead{stroke-width:1;opacity:.6}\n\
         .mesh{stroke-width:.8} .rim{stroke-width:1} .pole{stroke-width:1.4} .path{stroke-width:2.2} .behind{opacity:.45;stroke-width:1.2}\n\
         .halo{paint-order:stroke;stroke-width:4;stroke-linejoin:round}\n",
    );
    text.push_str(&scheme(
        "#ffffff",
        "#1c2128",
        "#59636e",
        "#e3e7ec",
        "#f4f6f9",
        "",
        |colours| colours.0,
    ));
    text.push_str("@media(prefers-color-scheme:dark){\n");
    text.push_str(&scheme(
        "#11161d",
        "#e8edf3",
        "#9aa5b1",
        "#2a323c",
        "#1a212a",
        "  ",
        |colours| colours.1,
    ));
    text.push_str("}\n");
    text
}

/// The number of a colour for the line with this index.
fn colour(index: usize) -> usize {
    index % COLOURS.len()
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::{Panel, Path, Picture, svg};

    #[test]
    fn the_same_picture_is_the_same_text() {
        let time: Vec<f64> = (0..=100).map(|i| f64::from(i) * 0.1).collect();
        let mut panel = Panel::new("a < b");
        panel
            .lines
            .push(("w[1]".into(), time.iter().map(|t| t.sin()).collect()));
        let mut flat = Panel::new("energy");
        flat.lines.push(("E".into(), vec![0.0; time.len()]));
        let points = time.iter().map(|t| [t.cos(), t.sin(), 0.0]).collect();
        let picture = Picture {
            title: "T & V".into(),
            subtitle: "a picture".into(),
            time,
            panels: vec![panel, flat],
            path: Some(Path {
                title: "axis".into(),
                points,
            }),
        };
        let text = svg(&picture);
        assert_eq!(text, svg(&picture.clone()));
        assert!(text.contains("T &amp; V") && text.contains("a &lt; b") && text.contains("w[1]"));
        assert!(!text.contains("NaN") && !text.contains("inf"));
    }

    #[test]
    fn what_is_not_finite_is_left_out() {
        let mut panel = Panel::new("p");
        panel
            .lines
            .push(("a".into(), vec![f64::NAN, f64::INFINITY]));
        let picture = Picture {
            title: "t".into(),
            subtitle: String::new(),
            time: vec![0.0, 1.0],
            panels: vec![panel],
            path: None,
        };
        let text = svg(&picture);
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    }
}
