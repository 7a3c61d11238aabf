//! Responses of one output of a linear system to one input: to a step, and by frequency with margins.

use super::modes::{ZERO_TOLERANCE, spectrum};
use super::{LinearError, LinearSystem, Matrix, Quadruple};
use nalgebra::{Complex, ComplexField};
use std::f64::consts::{PI, TAU};

/// Least and largest number of intervals of a step response in continuous time.
const INTERVALS: (f64, f64) = (1000.0, 20_000.0);
/// Intervals per period of the fastest oscillation, as far as the largest number allows.
const INTERVALS_PER_PERIOD: f64 = 20.0;
/// Time constants in which a mode fades, to a thousandth.
const FADED: f64 = 7.0;
/// Frequencies per decade.
const FREQUENCIES_PER_DECADE: f64 = 60.0;
/// Real parts below this, relative to the pole or zero, count as zero for the phase.
const AXIS_TOLERANCE: f64 = 1e-9;
/// Phases (degrees) that differ from −180° by less count as equal to it: nothing crosses where systems without damping
/// stay there.
const PHASE_TOLERANCE: f64 = 1e-6;
/// Part of the steady value within which a response has settled.
const SETTLED: f64 = 0.02;

/// One input and one output, without the states between which nothing passes.
#[derive(Clone, Debug)]
pub struct Channel {
    system: LinearSystem,
    /// Poles of the transfer function.
    pub poles: Vec<Complex<f64>>,
    /// Zeros of the transfer function.
    pub zeros: Vec<Complex<f64>>,
}

/// Response of an output to a unit step of an input, from rest.
#[derive(Clone, Debug)]
pub struct StepResponse {
    /// Times (s).
    pub times: Vec<f64>,
    /// The output.
    pub values: Vec<f64>,
    /// Limit of the output; `None` if there is none.
    pub steady: Option<f64>,
    /// Time from a tenth to nine tenths of the limit (s).
    pub rise: Option<f64>,
    /// Time after which the output stays within 2 % of the limit (s).
    pub settling: Option<f64>,
    /// Largest excess over the limit, as a part of it.
    pub overshoot: Option<f64>,
    /// Time and value of the largest output by magnitude.
    pub peak: (f64, f64),
}

/// A frequency (rad/s) with a margin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The frequency.
    pub frequency: f64,
    /// A factor of the gain, or an angle in degrees.
    pub margin: f64,
}

/// Frequency response G(iω), or G(exp(i ω h)) in steps.
#[derive(Clone, Debug)]
pub struct FrequencyResponse {
    /// Angular frequencies ω, ascending (rad/s).
    pub frequencies: Vec<f64>,
    /// |G|.
    pub magnitudes: Vec<f64>,
    /// Phases without jumps of 360° (degrees).
    pub phases: Vec<f64>,
    /// Frequencies at which the phase is −180° up to full turns, with 1/|G|.
    pub gain_margins: Vec<Crossing>,
    /// Frequencies with |G| = 1, with the phase above −180°.
    pub phase_margins: Vec<Crossing>,
    /// Whether the loop closed by u = −y is stable, without which margins have no meaning.
    pub stable_when_closed: bool,
}

impl LinearSystem {
    /// Returns the part between an input and an output, or a state, by their names.
    ///
    /// # Errors
    /// The name is unknown; the QR algorithm does not converge.
    pub fn channel(&self, from: &str, to: &str) -> Result<Channel, LinearError> {
        let place = |names: &[String], name: &str| names.iter().position(|known| known == name);
        let input = place(&self.inputs, from);
        let input =
            input.ok_or_else(|| LinearError::UnknownInput(from.into(), self.inputs.clone()))?;
        let Quadruple { a, b, c, d } = &self.matrices;
        let b = b.columns(input, 1).into_owned();
        let (c, d) = match (place(&self.outputs, to), place(&self.states, to)) {
            (Some(i), _) => (
                c.rows(i, 1).into_owned(),
                d.view((i, input), (1, 1)).into_owned(),
            ),
            (None, Some(i)) => {
                let unit = Matrix::from_fn(1, a.nrows(), |_, j| f64::from(u8::from(i == j)));
                (unit, Matrix::zeros(1, 1))
            }
            (None, None) => {
                let known = [self.outputs.clone(), self.states.clone()].concat();
                return Err(LinearError::UnknownOutput(to.into(), known));
            }
        };
        let whole = Quadruple {
            a: a.clone(),
            b,
            c,
            d,
        };
        let system = LinearSystem {
            matrices: whole.minimal(),
            ..self.clone()
        };
        Ok(Channel {
            poles: system.poles()?,
            zeros: system.zeros()?,
            system,
        })
    }
}

impl Channel {
    /// Returns the response to a unit step until a time, or until all that decays has decayed.
    ///
    /// # Errors
    /// The motion grows beyond all numbers.
    pub fn step_response(&self, until: Option<f64>) -> Result<StepResponse, LinearError> {
        let until = until.unwrap_or_else(|| self.duration());
        let fastest = self.poles.iter().map(|pole| pole.im).fold(0.0, f64::max);
        let (fewest, most) = INTERVALS;
        let intervals = (until * fastest / TAU * INTERVALS_PER_PERIOD)
            .clamp(fewest, most)
            .ceil();
        let (system, count) = match self.system.step {
            Some(h) => (self.system.clone(), (until / h).floor()),
            None => (self.system.discretized(until / intervals)?, intervals),
        };
        let h = system.step.unwrap_or(until);
        let Quadruple { a, b, c, d } = &system.matrices;
        let mut x = Matrix::zeros(a.nrows(), 1);
        let (mut times, mut values) = (Vec::new(), Vec::new());
        for k in 0..=count as usize {
            times.push(k as f64 * h);
            values.push((c * &x + d)[(0, 0)]);
            x = a * x + b;
        }
        if !values.iter().all(|value| value.is_finite()) {
            return Err(LinearError::Overflow);
        }
        let decays = self.poles.iter().all(|&pole| !self.system.persists(pole));
        let one = Complex::new(f64::from(u8::from(self.system.step.is_some())), 0.0);
        let steady = decays
            .then(|| self.transfer(one))
            .flatten()
            .map(|value| value.re);
        let peak = times.iter().copied().zip(values.iter().copied());
        let peak = peak.fold((0.0, 0.0_f64), |most, at| {
            if at.1.abs() > most.1.abs() { at } else { most }
        });
        let limit = steady.filter(|value| value.abs() > SETTLED * AXIS_TOLERANCE * peak.1.abs());
        // Times at which the output, as a part of the limit, passes a value, between samples that hold `beyond`.
        let part = |k: usize, limit: f64| values[k] / limit;
        let passes = |limit: f64, level: f64, k: usize| {
            let (before, after) = (part(k, limit), part(k + 1, limit));
            times[k] + h * ((level - before) / (after - before)).clamp(0.0, 1.0)
        };
        let reaches = |limit: f64, level: f64| {
            let first = (0..values.len()).find(|&k| part(k, limit) >= level)?;
            Some(if first == 0 {
                0.0
            } else {
                passes(limit, level, first - 1)
            })
        };
        let rise = limit.and_then(|limit| Some(reaches(limit, 0.9)? - reaches(limit, 0.1)?));
        let settling = limit.and_then(|limit| {
            let outside = |k: &usize| (part(*k, limit) - 1.0).abs() > SETTLED;
            let Some(last) = (0..values.len()).rev().find(outside) else {
                return Some(0.0);
            };
            let level = 1.0 + SETTLED.copysign(part(last, limit) - 1.0);
            (last + 1 < values.len()).then(|| passes(limit, level, last))
        });
        let highest = limit.map(|limit| {
            (0..values.len())
                .map(|k| part(k, limit))
                .fold(0.0, f64::max)
        });
        let overshoot = highest.map(|highest| (highest - 1.0).max(0.0));
        Ok(StepResponse {
            times,
            values,
            steady,
            rise,
            settling,
            overshoot,
            peak,
        })
    }

    /// Rates of change ln(z)/h of poles, or the poles themselves in continuous time, without those that are zero to
    /// rounding.
    fn rates(&self, of: &[Complex<f64>]) -> Vec<Complex<f64>> {
        let size = match self.system.step {
            Some(h) => 1.0 / h,
            None => self.system.matrices.a.amax(),
        };
        let rate = |&value: &Complex<f64>| match self.system.step {
            Some(h) => value.ln() / h,
            None => value,
        };
        of.iter()
            .map(rate)
            .filter(|rate| rate.modulus().is_finite() && rate.modulus() > ZERO_TOLERANCE * size)
            .collect()
    }

    /// Time in which decaying modes fade, growing ones grow, and the slowest undamped one swings ten times.
    fn duration(&self) -> f64 {
        let rates = self.rates(&self.poles);
        let times = rates
            .iter()
            .map(|rate| match rate.re.abs() > 1e-3 * rate.modulus() {
                true => FADED / rate.re.abs(),
                false => 10.0 * TAU / rate.im.abs(),
            });
        let longest = times.filter(|time| time.is_finite()).fold(0.0, f64::max);
        let growth = rates.iter().map(|rate| rate.re).fold(0.0, f64::max);
        let until = if longest > 0.0 { longest } else { 10.0 };
        if growth * until > 2.0 * FADED {
            2.0 * FADED / growth
        } else {
            until
        }
    }

    /// C (s I − A)⁻¹ B + D; `None` at a pole.
    fn transfer(&self, s: Complex<f64>) -> Option<Complex<f64>> {
        let Quadruple { a, b, c, d } = &self.system.matrices;
        let complex = |m: &Matrix| m.map(|entry| Complex::new(entry, 0.0));
        let mut shifted = complex(&-a);
        (0..a.nrows()).for_each(|i| shifted[(i, i)] += s);
        let value = match a.is_empty() {
            true => Complex::new(d[(0, 0)], 0.0),
            false => (complex(c) * shifted.lu().solve(&complex(b))?)[(0, 0)] + d[(0, 0)],
        };
        (value.re.is_finite() && value.im.is_finite()).then_some(value)
    }

    /// Magnitude and phase (degrees) at a frequency. The phase is that of k Π (s − zero) / Π (s − pole), whose factors
    /// have no jumps except on the imaginary axis or unit circle, which decides about full turns.
    fn at(&self, frequency: f64) -> Option<(f64, f64)> {
        let s = match self.system.step {
            Some(h) => Complex::new((frequency * h).cos(), (frequency * h).sin()),
            None => Complex::new(0.0, frequency),
        };
        let angle = |&root: &Complex<f64>| match self.system.step {
            Some(_) if root.modulus() <= 1.0 + AXIS_TOLERANCE => {
                s.argument() + (1.0 - root / s).argument()
            }
            Some(_) => (-root).argument() + (1.0 - s / root).argument(),
            None if root.re <= AXIS_TOLERANCE * root.modulus() => {
                (s.im - root.im).atan2((-root.re).max(0.0))
            }
            None => PI - (s.im - root.im).atan2(root.re),
        };
        let roots = self.poles.iter().chain(&self.zeros);
        let beyond = 10.0 * roots.map(|root| root.modulus()).fold(1.0, f64::max);
        let sign = self.transfer(Complex::new(beyond, 0.0))?.re;
        let turned = self.zeros.iter().map(angle).sum::<f64>()
            - self.poles.iter().map(angle).sum::<f64>()
            - if sign < 0.0 { PI } else { 0.0 };
        let value = self.transfer(s)?;
        let phase = value.argument() + TAU * ((turned - value.argument()) / TAU).round();
        (value.modulus() > 0.0).then(|| (value.modulus(), phase.to_degrees()))
    }

    /// Returns the frequency response in a range, or around all poles and zeros.
    ///
    /// # Errors
    /// It has no value in the range; the QR algorithm does not converge.
    pub fn frequency_response(
        &self,
        range: Option<(f64, f64)>,
    ) -> Result<FrequencyResponse, LinearError> {
        let roots = [self.rates(&self.poles), self.rates(&self.zeros)].concat();
        let sizes = roots
            .iter()
            .map(|root| root.modulus())
            .filter(|&size| size > 0.0);
        let bounds = sizes.fold(None, |found: Option<(f64, f64)>, size| {
            let (low, high) = found.unwrap_or((size, size));
            Some((low.min(size), high.max(size)))
        });
        // Zeros that rounding has moved are not shown.
        let bounds = bounds.map_or((1.0, 1.0), |(low, high)| (low.max(1e-6 * high), high));
        let decade = |bound: f64, round: fn(f64) -> f64| 10.0_f64.powf(round(bound.log10()));
        let (low, high) = range.unwrap_or((
            decade(bounds.0 / 3.0, f64::floor),
            decade(bounds.1 * 3.0, f64::ceil),
        ));
        let high = self.system.step.map_or(high, |h| high.min(PI / h));
        let decades = (high / low).log10();
        if !(decades > 0.0 && decades.is_finite()) {
            return Err(LinearError::NoResponse);
        }
        let count = (decades * FREQUENCIES_PER_DECADE).ceil();
        let mut frequencies: Vec<f64> = (0..=count as usize)
            .map(|k| low * (high / low).powf(k as f64 / count))
            .collect();
        // Sharp peaks stand at the imaginary parts.
        for root in roots.iter().filter(|root| root.im > 0.0) {
            let near = (0..40)
                .flat_map(|k| [1.0, -1.0].map(|sign| sign * 10.0_f64.powf(-0.25 * f64::from(k))));
            frequencies.extend(
                near.map(|off| root.im * (1.0 + off))
                    .filter(|at| (low..=high).contains(at)),
            );
        }
        frequencies.sort_by(f64::total_cmp);
        frequencies.dedup();
        let values = frequencies
            .iter()
            .filter_map(|&at| self.at(at).map(|(size, phase)| (at, size, phase)));
        let values: Vec<(f64, f64, f64)> = values.collect();
        if values.len() < 2 {
            let Quadruple { a, d, .. } = &self.system.matrices;
            return Err(match a.is_empty() && d[(0, 0)] == 0.0 {
                true => LinearError::Unconnected,
                false => LinearError::NoResponse,
            });
        }
        let turns = |phase: f64| ((phase + 180.0) / 360.0).round();
        let above = |phase: f64| phase + 180.0 - 360.0 * turns(phase);
        let gains = self.crossings(&values, |_, phase| above(phase), 90.0);
        let gain_margins = gains.filter_map(|at| {
            Some(Crossing {
                frequency: at,
                margin: 1.0 / self.at(at)?.0,
            })
        });
        let units = self.crossings(&values, |size, _| size.ln(), f64::INFINITY);
        let phase_margins = units.filter_map(|at| {
            Some(Crossing {
                frequency: at,
                margin: above(self.at(at)?.1),
            })
        });
        let Quadruple { a, b, c, d } = &self.system.matrices;
        let closed = a - b * c / (1.0 + d[(0, 0)]);
        Ok(FrequencyResponse {
            gain_margins: gain_margins.collect(),
            phase_margins: phase_margins.collect(),
            stable_when_closed: closed.iter().all(|entry| entry.is_finite())
                && spectrum(&closed)?
                    .into_iter()
                    .all(|pole| !self.system.persists(pole)),
            frequencies: values.iter().map(|value| value.0).collect(),
            magnitudes: values.iter().map(|value| value.1).collect(),
            phases: values.iter().map(|value| value.2).collect(),
        })
    }

    /// Frequencies at which a function of magnitude and phase changes its sign without a jump of this size, by
    /// bisection.
    fn crossings<'a>(
        &'a self,
        values: &'a [(f64, f64, f64)],
        of: impl Fn(f64, f64) -> f64 + Copy + 'a,
        jump: f64,
    ) -> impl Iterator<Item = f64> + 'a {
        let signed = values
            .iter()
            .map(move |&(at, size, phase)| (at, of(size, phase)));
        let signed: Vec<(f64, f64)> = signed
            .filter(|(_, value)| value.abs() > PHASE_TOLERANCE)
            .collect();
        let pairs: Vec<[(f64, f64); 2]> =
            signed.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        let changes = pairs.into_iter().filter(move |[before, after]| {
            before.1 * after.1 < 0.0 && (before.1 - after.1).abs() < jump
        });
        changes.filter_map(move |[(mut low, first), (mut high, _)]| {
            for _ in 0..100 {
                let middle = (low * high).sqrt();
                let (size, phase) = self.at(middle)?;
                *if of(size, phase) * first > 0.0 {
                    &mut low
                } else {
                    &mut high
                } = middle;
            }
            let (size, phase) = self.at(low)?;
            (of(size, phase).abs() < 1e-3).then_some(low)
        })
    }
}
