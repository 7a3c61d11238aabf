//! A drawing in pixels with tenths, and its SVG text.

use super::line::Point;
use super::theme;
use super::width::fit;
use crate::code_markup::plain;
use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Polygon, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontStyle, IntoFont, RGBAColor, RGBColor, ShapeStyle, TextStyle};
use std::error::Error;
use std::fmt;

/// Scale of drawings, since `plotters` supports only whole pixels.
pub const SUBPIXELS: f64 = 10.0;

/// The area to draw on.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A picture that could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlotError(String);

impl fmt::Display for PlotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "picture not drawn: {}", self.0)
    }
}

impl Error for PlotError {}

/// The result of drawing.
pub type DrawResult = Result<(), PlotError>;

/// Converts an error of `plotters`.
pub fn draw_error(error: impl fmt::Display) -> PlotError {
    PlotError(error.to_string())
}

/// A finished drawing.
#[derive(Clone, Debug)]
pub struct Figure {
    width: f64,
    height: f64,
    title: String,
    elements: String,
}

impl Figure {
    /// Creates a drawing of this size in pixels; the title is its text alternative.
    ///
    /// # Errors
    /// If `draw` fails.
    pub fn draw(
        width: f64,
        height: f64,
        title: &str,
        draw: impl FnOnce(&Area) -> DrawResult,
    ) -> Result<Self, PlotError> {
        let mut text = String::new();
        {
            let size = ((width * SUBPIXELS) as u32, (height * SUBPIXELS) as u32);
            let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
            draw(&root)?;
            root.present().map_err(draw_error)?;
        }
        // Replaces the outer element.
        let elements = text.split_once(">\n").map_or("", |(_, rest)| rest);
        let elements = compact(elements.trim_end().trim_end_matches("</svg>"));
        Ok(Figure {
            width,
            height,
            title: plain(title),
            elements,
        })
    }

    /// Creates a drawing of this size from its elements, in units of the drawing.
    pub fn of(width: f64, height: f64, title: &str, elements: String) -> Self {
        Figure {
            width,
            height,
            title: plain(title),
            elements,
        }
    }

    /// Returns the text of a separate file.
    pub fn standalone(&self) -> String {
        self.text(&format!("<style>\n{}</style>\n", theme::sheet()))
    }

    /// Returns the text for a page that has the [style sheet](theme::sheet).
    pub fn inline(&self) -> String {
        self.text("")
    }

    fn text(&self, style: &str) -> String {
        let Figure {
            width,
            height,
            title,
            elements,
        } = self;
        let title = escape(title);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"{title}\">\n\
             <title>{title}</title>\n{style}{elements}</svg>\n",
            width * SUBPIXELS,
            height * SUBPIXELS,
        )
    }
}

/// Shortens the text of a drawing: leaves out attributes that repeat a default or the style sheet, and merges
/// consecutive disks of one kind into one path of dots.
fn compact(elements: &str) -> String {
    let text = elements
        .replace(" opacity=\"1\"", "")
        .replace(" font-family=\"sans-serif\"", "")
        .replace(" dy=\"0.5ex\"", " dy=\".5ex\"")
        .replace("0.00000000000001\"", "0\"")
        .replace(" stroke=\"none\" stroke-width=\"10\"/>", "/>")
        .replace(" \"/>", "\"/>");
    let mut short = String::new();
    let mut open = None;
    for line in text.lines() {
        let Some((place, radius, fill)) = disk(line) else {
            if open.take().is_some() {
                short.push_str("\"/>\n");
            }
            short.push_str(line);
            short.push('\n');
            continue;
        };
        if open != Some((radius, fill)) {
            if open.is_some() {
                short.push_str("\"/>\n");
            }
            let width = 2 * radius;
            short.push_str(&format!(
                "<path stroke-linecap=\"round\" stroke=\"{fill}\" stroke-width=\"{width}\" d=\""
            ));
            open = Some((radius, fill));
        }
        short.push_str(&format!("M{place}h0"));
    }
    if open.is_some() {
        short.push_str("\"/>\n");
    }
    short
}

/// Parses position, radius and colour of a disk.
fn disk(line: &str) -> Option<(String, u32, &str)> {
    let rest = line.strip_prefix("<circle cx=\"")?;
    let (x, rest) = rest.split_once("\" cy=\"")?;
    let (y, rest) = rest.split_once("\" r=\"")?;
    let (radius, rest) = rest.split_once("\" fill=\"")?;
    let fill = rest.strip_suffix("\"/>")?;
    (fill.starts_with('#') && fill.len() == 7).then_some((
        format!("{x} {y}"),
        radius.parse().ok()?,
        fill,
    ))
}

/// Escapes a text for XML, attributes included.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// Converts a length or coordinate to units of the drawing.
pub fn unit(pixels: f64) -> i32 {
    (pixels * SUBPIXELS).round() as i32
}

/// Converts a point to units of the drawing.
pub fn place((x, y): Point) -> (i32, i32) {
    (unit(x), unit(y))
}

/// Returns a stroke of this width in pixels.
pub fn stroke(colour: impl Color, width: f64) -> ShapeStyle {
    ShapeStyle {
        color: colour.to_rgba(),
        filled: false,
        stroke_width: (width * SUBPIXELS).round() as u32,
    }
}

/// The alignment of a text at its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// To the right of the position.
    Start,
    /// Centred on the position.
    Middle,
    /// To the left of the position.
    End,
}

/// Returns a style of text of this size in pixels, centred vertically.
pub fn letters(size: f64, colour: RGBColor, anchor: Anchor, bold: bool) -> TextStyle<'static> {
    let weight = if bold {
        FontStyle::Bold
    } else {
        FontStyle::Normal
    };
    let across = match anchor {
        Anchor::Start => HPos::Left,
        Anchor::Middle => HPos::Center,
        Anchor::End => HPos::Right,
    };
    // `plotters` writes sizes divided by 1.24.
    let size = size * SUBPIXELS * 1.24;
    let mut style = TextStyle::from(("sans-serif", size, weight).into_font());
    style.color = colour.to_backend_color();
    style.pos = Pos::new(across, VPos::Center);
    style
}

/// Writes a text.
pub fn write(area: &Area, text: &str, at: Point, style: &TextStyle) -> DrawResult {
    let element = Text::new(text.to_string(), place(at), style.clone());
    area.draw(&element).map_err(draw_error)
}

/// Draws a polyline.
pub fn line(area: &Area, points: &[Point], style: ShapeStyle) -> DrawResult {
    let points: Vec<(i32, i32)> = points.iter().copied().map(place).collect();
    area.draw(&PathElement::new(points, style))
        .map_err(draw_error)
}

/// Draws a disk, or a circle.
pub fn circle(area: &Area, at: Point, radius: f64, style: ShapeStyle) -> DrawResult {
    area.draw(&Circle::new(place(at), unit(radius), style))
        .map_err(draw_error)
}

/// Fills a polygon.
pub fn fill(area: &Area, points: &[Point], colour: RGBAColor) -> DrawResult {
    let points: Vec<(i32, i32)> = points.iter().copied().map(place).collect();
    area.draw(&Polygon::new(points, colour)).map_err(draw_error)
}

/// Fills the background, and writes a heading and a sentence below it, cut to the width.
pub fn draw_heading(area: &Area, title: &str, subtitle: &str) -> DrawResult {
    const LEFT_MARGIN: f64 = 24.0;
    const RIGHT_MARGIN: f64 = 10.0;
    area.fill(&theme::GROUND.0).map_err(draw_error)?;
    let widest = f64::from(area.dim_in_pixel().0) / SUBPIXELS - LEFT_MARGIN - RIGHT_MARGIN;
    let head = letters(18.0, theme::INK.0, Anchor::Start, true);
    let title = fit(&plain(title), 18.0, true, widest);
    write(area, &title, (LEFT_MARGIN, 28.0), &head)?;
    let sub = letters(13.0, theme::SOFT.0, Anchor::Start, false);
    let subtitle = fit(&plain(subtitle), 13.0, false, widest);
    write(area, &subtitle, (LEFT_MARGIN, 50.0), &sub)
}
