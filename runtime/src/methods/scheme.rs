//! Coefficients of splitting schemes: compositions of kicks and free motion (drifts).
//!
//! A step is kick b₀ h, drift a₀ h, kick b₁ h, …, drift, kick. Both lists of coefficients are palindromes, so that the
//! schemes are symmetric: a step back returns to the start. The last kick of a step and the first of the next are at
//! the same point. Sources: G. Strang, SIAM J. Numer. Anal. 5 (1968) 506; M. Suzuki, Phys. Lett. A 146 (1990) 319; W.
//! Kahan, R.-C. Li, Math. Comp. 66 (1997) 1089; S. Blanes, P. C. Moan, J. Comput. Appl. Math. 142 (2002) 313.

/// Row of the table: everything that is known of a scheme.
struct Row {
    /// Name, for command lines and files.
    name: &'static str,
    /// Order, provided that the free flow is exact.
    order: u32,
    /// Number of drifts.
    drifts: usize,
    /// Drifts of the first half; those in the middle follow from the sum.
    first_drifts: &'static [f64],
    /// Kicks of the first half, likewise; empty for compositions of Strang steps, whose kicks follow from the drifts.
    first_kicks: &'static [f64],
}

macro_rules! schemes {
    ($($(#[$doc:meta])* $id:ident $name:literal $order:literal $drifts:literal [$first_drifts:expr] [$first_kicks:expr];)*) => {
        /// A splitting scheme.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum Scheme {
            $($(#[$doc])* $id,)*
        }

        impl Scheme {
            /// All schemes.
            pub const ALL: &[Self] = &[$(Self::$id),*];

            const fn row(self) -> Row {
                match self {
                    $(Self::$id => Row {
                        name: $name,
                        order: $order,
                        drifts: $drifts,
                        first_drifts: $first_drifts,
                        first_kicks: $first_kicks,
                    },)*
                }
            }
        }
    };
}

// To add a scheme, add a row: documentation, identifier, name, order, number of drifts, and the first halves of the drifts and
// of the kicks.
schemes! {
    /// Order 2, one kick per step.
    Strang "splitting2" 2 1 [&[]] [&[]];
    /// Order 4, composed of five steps of [`Strang`](Self::Strang).
    Suzuki4 "suzuki" 4 5 [&[SUZUKI; 2]] [&[]];
    /// Order 6, composed of nine steps of [`Strang`](Self::Strang).
    KahanLi6 "kahan-li" 6 9 [&KAHAN_LI] [&[]];
    /// Order 4, six kicks per step, with small error constants; needs the free flow in closed form.
    #[default]
    Nystrom4 "splitting" 4 6 [&NYSTROM_4.1] [&NYSTROM_4.0];
    /// Order 6, eleven kicks per step; needs the free flow in closed form.
    Nystrom6 "splitting6" 6 11 [&NYSTROM_6.1] [&NYSTROM_6.0];
    /// Order 8, composed of seventeen steps of [`Strang`](Self::Strang).
    KahanLi8 "kahan-li8" 8 17 [&KAHAN_LI_8] [&[]];
}

/// Suzuki's coefficient 1/(4 − ∛4).
const SUZUKI: f64 = 0.414_490_771_794_375_77;

/// Kahan and Li's coefficients of nine stages, the first five.
const KAHAN_LI: [f64; 5] = [
    0.392_161_444_007_314_1,
    0.332_599_136_789_359_43,
    -0.706_246_172_557_639_3,
    0.082_213_596_293_550_8,
    0.798_543_990_934_83,
];

/// Kahan and Li's coefficients of seventeen stages, the first eight.
const KAHAN_LI_8: [f64; 8] = [
    0.130_202_483_088_890_1,
    0.561_162_981_775_108_4,
    -0.389_474_962_644_847_3,
    0.158_841_906_555_155_6,
    -0.395_903_894_133_237_57,
    0.184_539_640_978_315_7,
    0.258_374_387_686_322_04,
    0.295_011_723_609_310_3,
];

/// Kicks and drifts in the first half of Blanes and Moan's SRKN₆ᵇ; those in the middle follow from the sums.
const NYSTROM_4: ([f64; 3], [f64; 2]) = (
    [
        0.082_984_406_417_405_2,
        0.396_309_801_498_368,
        -0.039_056_304_922_348_6,
    ],
    [0.245_298_957_184_271, 0.604_872_665_711_08],
);

/// Kicks and drifts in the first half of Blanes and Moan's SRKN₁₁ᵇ; those in the middle follow from the sums.
const NYSTROM_6: ([f64; 5], [f64; 5]) = (
    [
        0.041_464_998_518_262_4,
        0.198_128_671_918_067,
        -0.040_006_192_104_153_3,
        0.075_253_984_301_580_7,
        -0.011_511_387_420_688_7,
    ],
    [
        0.123_229_775_946_271,
        0.290_553_797_799_558,
        -0.127_049_212_625_417,
        -0.246_331_761_062_075,
        0.357_208_872_795_928,
    ],
);

/// Returns entry `index` of a palindrome of `count` entries whose sum is 1, given those of its first half.
fn entry(first: &[f64], index: usize, count: usize) -> f64 {
    let mirrored = index.min(count.saturating_sub(1).saturating_sub(index));
    first.get(mirrored).copied().unwrap_or_else(|| {
        let sum = first.iter().sum::<f64>();
        match count % 2 {
            0 => 0.5 - sum,
            _ => 1.0 - 2.0 * sum,
        }
    })
}

impl Scheme {
    /// Returns the name of the scheme, for command lines and files.
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Returns the order p, provided that the free flow is exact.
    pub const fn order(self) -> u32 {
        self.row().order
    }

    /// Returns the number of drifts in a step, which is also its number of kicks if the last one is shared with the
    /// next step.
    pub const fn drifts(self) -> usize {
        self.row().drifts
    }

    /// Returns whether the scheme keeps its order with a free flow of order 2: true for compositions of
    /// [`Strang`](Self::Strang) steps.
    pub const fn composes_steps(self) -> bool {
        self.row().first_kicks.is_empty()
    }

    /// Returns aᵢ, the length of drift `index` as a fraction of h; `index` is in `0..drifts()`.
    pub fn drift(self, index: usize) -> f64 {
        entry(self.row().first_drifts, index, self.drifts())
    }

    /// Returns bᵢ, the length of kick `index` as a fraction of h; `index` is in `0..=drifts()`.
    pub fn kick(self, index: usize) -> f64 {
        let count = self.drifts() + 1;
        if !self.composes_steps() {
            return entry(self.row().first_kicks, index, count);
        }
        let mirrored = index.min(self.drifts().saturating_sub(index));
        let before = mirrored.checked_sub(1).map_or(0.0, |i| self.drift(i));
        0.5 * (before + self.drift(mirrored))
    }
}

#[cfg(test)]
mod tests {
    use super::Scheme;

    #[test]
    fn parts_add_up_to_the_step_and_read_the_same_backwards() {
        for &scheme in Scheme::ALL {
            let count = scheme.drifts();
            let sum: f64 = (0..count).map(|i| scheme.drift(i)).sum();
            assert!((sum - 1.0).abs() < 1e-15, "{scheme:?}");
            let sum: f64 = (0..=count).map(|i| scheme.kick(i)).sum();
            assert!((sum - 1.0).abs() < 1e-15, "{scheme:?}");
            for index in 0..count {
                assert_eq!(scheme.drift(index), scheme.drift(count - 1 - index));
                assert_eq!(scheme.kick(index), scheme.kick(count - index));
            }
        }
    }

    /// Checks that the kicks at the times cᵢ integrate forces that are polynomials in time exactly: the conditions of
    /// order 2 and 3 include Σ bᵢ cᵢ = 1/2 and Σ bᵢ cᵢ² = 1/3.
    #[test]
    fn times_of_kicks_satisfy_the_conditions_of_quadrature() {
        for &scheme in Scheme::ALL {
            let (mut time, mut sums) = (0.0, [0.0; 4]);
            for index in 0..=scheme.drifts() {
                for (power, sum) in sums.iter_mut().enumerate() {
                    *sum += scheme.kick(index) * f64::powi(time, power as i32);
                }
                if index < scheme.drifts() {
                    time += scheme.drift(index);
                }
            }
            let known = scheme.order().min(4) as usize;
            for (power, sum) in sums.iter().enumerate().take(known) {
                let exact = 1.0 / (power as f64 + 1.0);
                assert!((sum - exact).abs() < 1e-13, "{scheme:?} {power}");
            }
        }
    }
}
