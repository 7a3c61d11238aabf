//! Times two functions alternately.

use cpu_time::ThreadTime;

const ROUNDS: usize = 12;
const BATCHES: usize = 41;
/// Approximate duration of a batch, in ns.
const BATCH: f64 = 4e5;
/// Number of inputs of one run.
pub const INPUTS: usize = 32;

/// Returns the time of one call of each function in ns: the lowest of the rounds' medians. The argument of a function
/// is the number of its passes over all inputs.
pub fn by_turns(first: &dyn Fn(u32), second: &dyn Fn(u32)) -> (f64, f64) {
    let (n, m) = (repeats(first), repeats(second));
    let mut best = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        let (mut a, mut b) = (Vec::new(), Vec::new());
        for _ in 0..BATCHES {
            a.push(time(first, n));
            b.push(time(second, m));
        }
        best = (best.0.min(median(a)), best.1.min(median(b)));
    }
    best
}

fn repeats(function: &dyn Fn(u32)) -> u32 {
    let mut count = 1;
    while time(function, count) * f64::from(count) * (INPUTS as f64) < BATCH {
        count *= 2;
    }
    count
}

fn time(function: &dyn Fn(u32), count: u32) -> f64 {
    let start = ThreadTime::now();
    function(count);
    start.elapsed().as_nanos() as f64 / f64::from(count) / INPUTS as f64
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
