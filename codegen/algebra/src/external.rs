//! External functions: functions that are defined elsewhere, of which only the arguments and components are
//! known.
//!
//! A function f: a ↦ (f₁ … f_m) is called with a list of numbers. Its components are separate nodes over
//! the list, and so are their derivatives ∂fᵢ/∂aⱼ and ∂²fᵢ/∂aⱼ∂aₖ. Modulo p, each of these has a random
//! value determined by the component and the numbers in the list, so whatever is proved with it holds for
//! every function.

/// Signature of an external function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct External {
    /// Name of the function.
    pub name: String,
    /// Names of its arguments.
    pub arguments: Vec<String>,
    /// Number of its components.
    pub components: usize,
}

/// A component of an external function, or one of its derivatives.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, PartialOrd, Ord)]
pub struct Component {
    /// Index of the function among those of the graph.
    pub function: u8,
    /// Index of the component.
    pub component: u8,
    /// Number of arguments of the function.
    arity: u8,
    /// Arguments by which the component is differentiated, counted from 1, ascending; 0 stands for none.
    by: [u8; 2],
}

impl Component {
    /// Largest number of functions, of components, and of arguments.
    pub const MAX_COUNT: usize = 64;

    /// Creates a component that is not differentiated.
    pub fn new(function: usize, component: usize, arity: usize) -> Self {
        let [function, component, arity] = [function, component, arity].map(|n| n as u8);
        Component {
            function,
            component,
            arity,
            by: [0; 2],
        }
    }

    /// Returns the derivative by an argument. Third derivatives are not distinguished from one another,
    /// since not even second derivatives occur in final results.
    pub fn differentiate(self, place: usize) -> Self {
        let place = place as u8 + 1;
        let mut by = match self.by {
            [0, 0] => [0, place],
            [0, first] => [first, place],
            [_, last] => [last.max(place), u8::MAX],
        };
        by.sort_unstable();
        Component { by, ..self }
    }

    /// Order of differentiation; 3 stands for any order above 2.
    pub fn order(self) -> usize {
        match self.by {
            [0, 0] => 0,
            [0, _] => 1,
            [_, u8::MAX] => 3,
            _ => 2,
        }
    }

    /// Argument by which the component is differentiated, if it is differentiated exactly once.
    pub fn differentiated_by(self) -> Option<usize> {
        (self.order() == 1).then(|| usize::from(self.by[1]) - 1)
    }

    /// Number that identifies the component and its derivative.
    pub(super) fn number(self) -> i64 {
        let all = [self.function, self.component, self.by[0], self.by[1]];
        all.into_iter().fold(1, |n, byte| n << 8 | i64::from(byte))
    }

    /// Coefficients `[c, d]` of a function that stands in for the unknown one in numerical evaluations: c +
    /// d Σ wⁿ⁻ʲ aⱼ with the weight w = `STAND_IN_WEIGHT`. The sum is the number that stands for the list, so the
    /// stand-in is linear in it.
    pub(super) fn stand_in(self) -> [f64; 2] {
        let own = f64::from(self.function) + 0.37 * f64::from(self.component);
        let (constant, factor) = (0.3 + 0.7 * own.sin(), 1.0 + 0.4 * own.cos());
        match (self.order(), self.differentiated_by()) {
            (0, _) => [constant, factor],
            (_, Some(place)) => {
                let above = i32::from(self.arity) - 1 - place as i32;
                [factor * STAND_IN_WEIGHT.powi(above), 0.0]
            }
            _ => [0.0, 0.0],
        }
    }
}

/// Weight of the number that stands for the rest of a list, relative to the last number in the list.
pub(super) const STAND_IN_WEIGHT: f64 = 0.618_033_988_749_894_9;
