//! `hamel bode`: the frequency response of an output to an input near a state, with gain and phase margins.

use crate::columns::aligned;
use crate::failure::{Failure, print};
use crate::linear::{ChannelArguments, unsteady};
use crate::parse::{Expected, positive};
use clap::Args;
use hamel_engine::linear::Crossing;
use hamel_files::number::short;
use hamel_report::plot::{self, Panel};

/// Computes the frequency response of an output to an input, in the linearisation at a state.
///
/// G(s) = C (s I − A)⁻¹ B + D at s = i ω, or at exp(i ω H) with --step H. The phase has no jumps of 360°. Margins are
/// those of the loop that u = −y closes: 1/|G| where the phase is −180° up to full turns, and the phase above −180°
/// where |G| = 1.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel bode crane.eom --from F --to swing --plot swing.svg
  hamel bode crane.eom --from F --to \"h(v)\" --range 0.1,100 --out response.csv
  hamel bode crane.eom --from F --to swing --step 0.01")]
pub struct Arguments {
    #[command(flatten)]
    channel: ChannelArguments,
    /// Least and largest angular frequency (rad/s); by default, around all poles and zeros.
    #[arg(long, value_name = "LOW,HIGH", value_parser = range, allow_negative_numbers = true)]
    range: Option<(f64, f64)>,
}

/// Computes the response, writes it and prints its margins.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (linear, channel, title) = arguments.channel.open()?;
    let response = channel.frequency_response(arguments.range);
    let response = response.map_err(hamel_engine::Error::from)?;
    let decibels: Vec<f64> = response
        .magnitudes
        .iter()
        .map(|size| 20.0 * size.log10())
        .collect();
    let of = &response.frequencies;
    let [low, high] = [of.first(), of.last()].map(|at| short(at.copied().unwrap_or(0.0)));
    let mut text = format!(
        "\x1b[1m{title}\x1b[0m  {low} to {high} rad/s, {} frequencies\n",
        of.len()
    );
    let table = |names: [&str; 3], crossings: &[Crossing], show: &dyn Fn(f64) -> Vec<String>| {
        let heading = [names[0], "rad/s", names[1], names[2]]
            .map(String::from)
            .to_vec();
        let row =
            |at: &Crossing| [vec![String::new(), short(at.frequency)], show(at.margin)].concat();
        let lines: Vec<Vec<String>> = std::iter::once(heading)
            .chain(crossings.iter().map(row))
            .collect();
        match crossings.is_empty() {
            true => format!("\n  {}: none\n", names[0]),
            false => format!("\n{}", aligned(&lines, "  ")),
        }
    };
    text += &table(
        ["gain margins", "factor", "dB"],
        &response.gain_margins,
        &|factor| vec![short(factor), short(20.0 * factor.log10())],
    );
    text += &table(
        ["phase margins", "degrees", ""],
        &response.phase_margins,
        &|angle| vec![short(angle)],
    );
    text += match response.stable_when_closed {
        true => "\nwith u = −y the loop is stable\n",
        false => "\nwith u = −y the loop is not stable\n",
    };
    let columns = [
        ("omega", of.as_slice()),
        ("magnitude", response.magnitudes.as_slice()),
        ("decibels", decibels.as_slice()),
        ("degrees", response.phases.as_slice()),
    ];
    let panel = |title: &str, values: &[f64]| Panel {
        lines: vec![("G".into(), values.to_vec())],
        ..Panel::new(title)
    };
    let panels = vec![
        panel("magnitude (dB)", &decibels),
        panel("phase (degrees)", &response.phases),
    ];
    let written = arguments
        .channel
        .write(&columns, title, panels, plot::bode)?;
    print(&(text + &unsteady(&linear) + &written))
}

/// Parses `0.1,100`.
fn range(text: &str) -> Result<(f64, f64), Expected> {
    let (low, high) = text.split_once(',').ok_or(Expected::Range)?;
    let (low, high) = (positive(low.trim())?, positive(high.trim())?);
    (low < high).then_some((low, high)).ok_or(Expected::Range)
}
