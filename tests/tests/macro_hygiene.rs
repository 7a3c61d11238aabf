//! Hygiene of the macro: the expansion is independent of the names in scope, and fragments passed by a `macro_rules!`
//! are read as they were matched.
#![deny(warnings)]
#![forbid(unsafe_code)]

/// Items with the names of those of Rust and of the runtime, such as `Ok` with `anyhow`.
mod shadowed {
    #![allow(dead_code, non_snake_case, reason = "they are there to be in the way")]

    mod core {}
    mod std {}
    mod hamel {}
    struct Option;
    struct Result;
    struct State;
    struct Vec;
    struct Range;
    struct Scalar;
    struct System;
    struct Singular;
    trait Clone {}
    trait Copy {}
    trait Debug {}
    trait Default {}
    trait From {}
    trait PartialEq {}
    fn Ok() {}
    fn Err() {}
    fn Some() {}

    // With parameters, fallible pivots, rotors, slopes, a split and an invariant.
    ::hamel::rigid_eom! {
        pub system Shade {
            param m = 2, J: sym3 = diag(1, 2, 3);
            coord x, q: S1, R: SO3;
            velocity v, w, o: vec3;
            rate x = v, q = w, R = R * hat(o);
            particle mass m at [x, 0, q.s];
            frame b = pose(R, [0, 0, 0]);
            body on b { mass m; inertia J about com; }
            kinetic w^2;
            input f;
            generalized force v = f;
            invariant energy when f = 0;
            output e = sqrt(x^2 + 1);
            generate all, linearize, e_slopes;
        }
    }
    ::hamel::rigid_eom! {
        pub system Block {
            param m = 2;
            coord x;
            velocity v;
            rate x = v;
            particle mass m at [x, 0, 0];
            generate all, splitting;
        }
    }
}

/// Systems and parameters with names that the expansion uses.
mod named {
    ::hamel::rigid_eom! {
        pub system Option {
            param new = 1, default = 2, clone = 3, into = 4, k = 5, xi = 6, S = 7, out = 8;
            param Ok = 9, Err = 10, core = 11, hamel = 12, f64 = 13, Vec = 14, State = 15;
            coord q, r;
            velocity w, o;
            rate q = w, r = o;
            kinetic new * w^2 + default * o^2;
            potential (clone + into + k + xi + S + out) * q;
            potential (Ok + Err + core + hamel + f64 + Vec + State) * r;
            input Self_;
            generalized force w = Self_;
            output fmt = q;
        }
    }
    ::hamel::rigid_eom! {
        pub system State { coord q; velocity w; rate q = w; kinetic w^2; invariant energy; }
    }
}

/// Docs, a visibility and parts of values as fragments of a macro by example.
mod fragments {
    macro_rules! pendulum {
        ($(#[$docs:meta])* $public:vis $name:ident, $q:ident, $e:expr, $l:literal, $t:tt) => {
            ::hamel::rigid_eom! {
                $(#[$docs])*
                $public system $name {
                    param m = $l, j = -$e^2;
                    coord $q;
                    velocity w;
                    rate $q = w;
                    particle mass -m * $t at [$q, 0, 0];
                    potential -$e * $q^2 + 3 * j * $q;
                    output half = 6 / $e + 1;
                }
            }
        };
    }
    pendulum!(
        /// The docs of a comment,
        #[doc = "and of an attribute."]
        pub Made,
        q,
        1 + 2,
        -1.5,
        (3 - 1)
    );
    // Without docs and without a visibility.
    pendulum!(Private, theta, 1, -2, 1);
    pub fn private(theta: f64) -> [f64; 1] {
        Private::default().potential_force(&[theta])
    }

    macro_rules! chosen {
        ($name:ident, $kind:ty, $path:path, $block:block) => {
            ::hamel::rigid_eom! {
                pub system $name {
                    coord q, a: $kind;
                    velocity w, v;
                    rate q = w, a = v;
                    kinetic w^2 + v^2;
                    output chosen = if $path < 1 $block else { $path };
                }
            }
        };
    }
    chosen!(Chosen, S1, q, { 2 - 3 });
}

#[test]
fn what_a_macro_by_example_matched_is_kept_together() {
    let parameters = fragments::MadeParameters::<f64>::default();
    assert_eq!([parameters.m, parameters.j], [-1.5, -9.0]);
    // V = -3 q² - 27 q
    let made = fragments::Made::<f64>::default();
    assert_eq!(made.potential_force(&[2.0]), [-39.0]);
    assert_eq!(made.mass_matrix(&[2.0]), [[3.0]]);
    assert_eq!(made.half(), 3.0);
    assert_eq!(fragments::private(1.0), [-5.0]);
    let chosen = fragments::Chosen::<f64>::default();
    assert_eq!(chosen.chosen(&[0.5, 1.0, 0.0]), -1.0);
    assert_eq!(chosen.chosen(&[1.5, 1.0, 0.0]), 1.5);
}

#[test]
fn names_in_scope_change_nothing() {
    let option = named::Option::<f64>::default();
    assert_eq!(option.potential_force(&[0.0, 0.0]), [33.0, 84.0]);
    let shade = shadowed::Shade::<f64>::default();
    let energy = shade.energy(&[0.0; 12], &[0.0; 5]);
    assert_eq!(energy, 0.0);
}

/// Descriptions can be inside functions, and a name can be used again in another block.
#[test]
fn descriptions_stand_in_functions() {
    let m = 3.0;
    hamel::rigid_eom! { system Here { param m = 2; coord x; velocity v; rate x = v; kinetic m * v^2 / 2; } }
    let outer = Here::<f64>::default().mass_matrix(&[0.0]);
    {
        hamel::rigid_eom! { system Here { coord x; velocity v; rate x = v; kinetic 2 * v^2; } }
        assert_eq!(Here::<f64>::default().mass_matrix(&[0.0]), [[4.0]]);
    }
    assert_eq!(outer, [[2.0]]);
    assert_eq!(m, 3.0);
}

/// Numbers in Rust's syntax.
#[test]
fn numbers_are_those_of_rust() {
    hamel::rigid_eom! {
        system Numbers {
            param a = 1., b = 1_000, c = 1e3, d = 2.5E-1, e = 007, f = 1_0.0_1e0_1;
            coord x;
            velocity v;
            rate x = v;
            kinetic (a + b + c + d + e + f) * v^2;
        }
    }
    let of = NumbersParameters::<f64>::default();
    let numbers = [of.a, of.b, of.c, of.d, of.e, of.f];
    assert_eq!(numbers, [1.0, 1000.0, 1000.0, 0.25, 7.0, 100.1]);
}
