//! Lists of numbers whose length is known at run time; short ones need no allocation.

use hamel::Store;
use std::ops::Deref;

/// Largest length of a list that needs no allocation: the coordinates of a free body or of a robot's arm.
const SHORT: usize = 12;

/// List of numbers whose length is known at run time.
#[derive(Clone, Debug)]
pub enum Numbers {
    /// A length, and an array that begins with the numbers.
    Short(usize, [f64; SHORT]),
    /// A list of any length.
    Long(Vec<f64>),
}

impl Numbers {
    /// Repeats a number `length` times.
    #[inline]
    pub fn filled(number: f64, length: usize) -> Self {
        match length <= SHORT {
            true => Numbers::Short(length, [number; SHORT]),
            false => Numbers::Long(vec![number; length]),
        }
    }
}

impl AsRef<[f64]> for Numbers {
    #[inline]
    fn as_ref(&self) -> &[f64] {
        match self {
            Numbers::Short(length, list) => list.get(..*length).unwrap_or(list),
            Numbers::Long(list) => list,
        }
    }
}

impl AsMut<[f64]> for Numbers {
    #[inline]
    fn as_mut(&mut self) -> &mut [f64] {
        match self {
            Numbers::Short(length, list) => &mut list[..SHORT.min(*length)],
            Numbers::Long(list) => list,
        }
    }
}

impl Store<f64> for Numbers {
    #[inline]
    fn zeros(length: usize) -> Self {
        Numbers::filled(0.0, length)
    }
}

impl Deref for Numbers {
    type Target = [f64];

    #[inline]
    fn deref(&self) -> &[f64] {
        self.as_ref()
    }
}

impl From<&[f64]> for Numbers {
    #[inline]
    fn from(list: &[f64]) -> Self {
        let mut numbers = Numbers::filled(0.0, list.len());
        numbers.as_mut().copy_from_slice(list);
        numbers
    }
}

#[cfg(test)]
mod tests {
    use super::{Numbers, SHORT};

    #[test]
    fn lists_of_any_length_are_kept() {
        for length in [0, 1, SHORT - 1, SHORT, SHORT + 1, 100] {
            let list: Vec<f64> = (0..length).map(|i| i as f64 - 0.5).collect();
            let mut numbers = Numbers::from(list.as_slice());
            assert_eq!(&*numbers, list);
            if let Some(last) = numbers.as_mut().last_mut() {
                *last = 7.0;
                assert_eq!(numbers[length - 1], 7.0);
            }
            assert_eq!(numbers.clone().len(), length);
        }
    }
}
