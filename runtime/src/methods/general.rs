//! A method for any system with energies, chosen at run time.

use crate::error::StepError;
use crate::methods::{BackwardEuler, Cf4, Method, Rk4, Rkmk4, Rkmk8, Rkmk54, SemiImplicitEuler};
use crate::state::State;
use crate::system::Energies;

/// Declares [`General`], the names of its variants, and the calls of the methods.
macro_rules! general {
    ($($(#[$note:meta])* $variant:ident $name:literal,)*) => {
        /// Any method for systems with [`Energies`], as one type; all but [`BackwardEuler`] need [`System`](crate::System)
        /// alone.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum General {
            /// [`Rk4`]
            Rk4 {
                /// λ ≥ 0 in 1/time.
                lambda: f64,
            },
            $($(#[$note])* $variant,)*
        }

        impl General {
            /// All methods, the recommended one first; [`Rk4`] without stabilisation.
            pub const ALL: &[Self] = &[$(Self::$variant,)* Self::Rk4 { lambda: 0.0 }];

            /// Returns the name of the method, for command lines and files.
            pub const fn name(self) -> &'static str {
                match self {
                    Self::Rk4 { .. } => "rk4",
                    $(Self::$variant => $name,)*
                }
            }
        }

        impl<Sys: Energies + ?Sized> Method<Sys> for General {
            fn order(&self) -> u32 {
                match self {
                    Self::Rk4 { lambda } => Method::<Sys>::order(&Rk4 { lambda: *lambda }),
                    $(Self::$variant => Method::<Sys>::order(&$variant),)*
                }
            }

            #[inline]
            fn preserves_constraints(&self) -> bool {
                match self {
                    Self::Rk4 { lambda } => Method::<Sys>::preserves_constraints(&Rk4 { lambda: *lambda }),
                    $(Self::$variant => Method::<Sys>::preserves_constraints(&$variant),)*
                }
            }

            #[inline]
            fn step<U>(
                &self,
                system: &Sys,
                state: &State<Sys>,
                h: f64,
                inputs: &U,
            ) -> Result<State<Sys>, StepError>
            where
                U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
            {
                match self {
                    Self::Rk4 { lambda } => Rk4 { lambda: *lambda }.step(system, state, h, inputs),
                    $(Self::$variant => $variant.step(system, state, h, inputs),)*
                }
            }
        }
    };
}

general! {
    /// [`Rkmk4`]
    Rkmk4 "rkmk4",
    /// [`Cf4`]
    Cf4 "cf4",
    /// [`Rkmk54`]
    Rkmk54 "rkmk54",
    /// [`Rkmk8`]
    Rkmk8 "rkmk8",
    /// [`BackwardEuler`]
    BackwardEuler "backward-euler",
    /// [`SemiImplicitEuler`]
    SemiImplicitEuler "semi-implicit-euler",
}

impl General {
    /// Returns the method of this name; `rk4` is without stabilisation.
    ///
    /// ```
    /// use hamel::methods::General;
    ///
    /// assert_eq!(General::named("rkmk8"), Some(General::Rkmk8));
    /// assert!(General::ALL.contains(&General::Rkmk4));
    /// ```
    pub fn named(name: &str) -> Option<Self> {
        let mut all = Self::ALL.iter().copied();
        all.find(|method| method.name() == name)
    }
}
