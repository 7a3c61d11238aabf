//! Reports as one HTML page without other files: formulas in MathML, the picture inline, light and dark.

use super::document::{Block, Document};
use hamel_codegen::tables::display::Display;
use hamel_report::plot::{Figure, sheet};
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = "\
:root{color-scheme:light dark;--ink:#1c2128;--soft:#59636e;--rule:#e3e7ec;--ground:#fff}\
@media(prefers-color-scheme:dark){:root{--ink:#e8edf3;--soft:#9aa5b1;--rule:#2a323c;--ground:#11161d}}\
body{font:16px/1.55 system-ui,sans-serif;color:var(--ink);background:var(--ground);max-width:56rem;margin:2rem auto;padding:0 1rem}\
h2{margin-top:2.2rem;border-top:1px solid var(--rule);padding-top:1rem}\
.formulas{overflow-x:auto;margin:.8rem 0;padding:.2rem 0}\
math{font-size:1.08em}.left{text-align:left}mtd{padding:.25em .5em}\
table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:1rem 0;display:block;overflow-x:auto}\
th,td{padding:.2rem .7rem;border-bottom:1px solid var(--rule);text-align:left;vertical-align:top}\
pre{overflow-x:auto;font-size:.85em;line-height:1.4;border:1px solid var(--rule);padding:.7rem}\
svg{max-width:100%;height:auto}p.soft{color:var(--soft)}";

/// Writes the page.
pub fn write(document: &Document, figure: Option<&Figure>) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (document.system) ": equations of motion" }
                style { (PreEscaped(STYLE)) (PreEscaped(sheet())) }
            }
            body {
                main {
                    h1 { (document.system) ": equations of motion" }
                    p.soft { (super::document::SOURCE) }
                    @if let Some(figure) = figure {
                        figure { (PreEscaped(figure.inline())) }
                    }
                    @for section in &document.sections {
                        section {
                            h2 { (section.heading) }
                            @for block in &section.blocks { (markup(block)) }
                        }
                    }
                }
            }
        }
    };
    page.into_string()
}

fn markup(block: &Block) -> Markup {
    match block {
        Block::Paragraph(text) => html! { p { (text) } },
        Block::Lines(text) => html! { pre { (text) } },
        Block::Table(heads, rows) => html! {
            table {
                thead { tr { @for head in heads { th { (head) } } } }
                tbody { @for row in rows { tr { @for cell in row { td { (cell) } } } } }
            }
        },
        Block::Formulas(display) => html! { div.formulas { (PreEscaped(math(display))) } },
    }
}

/// Returns the `math` element of a display.
fn math(display: &Display) -> String {
    let row = |cells: &[String]| -> String {
        let cells = cells.iter().map(|cell| format!("<mtd>{cell}</mtd>"));
        format!("<mtr>{}</mtr>", cells.collect::<String>())
    };
    let inner = match display {
        Display::Matrix { symbol, rows } => {
            let rows: String = rows.iter().map(|cells| row(cells)).collect();
            format!(
                "<mrow>{symbol}<mo>=</mo><mrow><mo>(</mo><mtable>{rows}</mtable><mo>)</mo></mrow></mrow>"
            )
        }
        Display::Equations(list) => {
            let rows = list.iter().map(|[left, right]| {
                format!(
                    "<mtr><mtd>{left}</mtd><mtd><mo>=</mo></mtd><mtd class=\"left\">{right}</mtd></mtr>"
                )
            });
            format!("<mtable>{}</mtable>", rows.collect::<String>())
        }
    };
    format!("<math display=\"block\">{inner}</math>")
}
