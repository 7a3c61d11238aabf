//! `hamel step`: the response of an output to a unit step of an input, near a state.

use crate::columns::aligned;
use crate::failure::{Failure, print};
use crate::linear::{ChannelArguments, unsteady};
use crate::parse::positive;
use clap::Args;
use hamel_files::number::short;
use hamel_report::plot::{self, Panel};

/// Computes the response of an output to a unit step of an input, in the linearisation at a state.
///
/// The response is exact at each sample, by the exponential of the matrices. It prints the limit, the time from 10 % to
/// 90 % of it, the time after which the output stays within 2 % of it, the overshoot, and the peak.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel step crane.eom --from F --to swing --plot swing.svg
  hamel step crane.eom --from F --to \"h(v)\" --until 20 --out response.csv
  hamel step crane.eom --from F --to swing --step 0.01 --until 5")]
pub struct Arguments {
    #[command(flatten)]
    channel: ChannelArguments,
    /// Length of the response; by default, until all that decays has decayed.
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true)]
    until: Option<f64>,
}

/// Computes the response, writes it and prints its figures.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (linear, channel, title) = arguments.channel.open()?;
    let response = channel.step_response(arguments.until);
    let response = response.map_err(hamel_engine::Error::from)?;
    let end = response.times.last().copied().unwrap_or(0.0);
    let or_none = |value: Option<f64>| value.map_or("none".into(), short);
    let figures = [
        ("limit", or_none(response.steady)),
        ("rise time (s)", or_none(response.rise)),
        ("settling time (s)", or_none(response.settling)),
        (
            "overshoot (%)",
            or_none(response.overshoot.map(|part| 100.0 * part)),
        ),
        ("peak", short(response.peak.1)),
        ("time of the peak (s)", short(response.peak.0)),
    ];
    let figures: Vec<Vec<String>> = figures.map(|(name, value)| vec![name.into(), value]).into();
    let columns = [
        ("t", response.times.as_slice()),
        ("y", response.values.as_slice()),
    ];
    let mut panel = Panel::new("response to a unit step");
    panel.lines.push(("y".into(), response.values.clone()));
    let heading = format!(
        "\x1b[1m{title}\x1b[0m  unit step, {} s, {} samples\n",
        short(end),
        response.times.len()
    );
    let written = arguments
        .channel
        .write(&columns, title, vec![panel], plot::run)?;
    print(&(heading + &aligned(&figures, "  ") + &unsteady(&linear) + &written))
}
