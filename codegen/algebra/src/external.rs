//! Functions that are given elsewhere: of them is known what they take and what they give, and nothing else.
//!
//! A function with several components, f: a ↦ (f₁ … f_m), is called with a list of numbers. Its components are nodes of
//! their own over the list, and so are their derivatives ∂fᵢ/∂aⱼ, ∂²fᵢ/∂aⱼ∂aₖ. Modulo p each has a random value that belongs
//! to it and to the numbers in the list: what is proved with it holds for every function.

/// What is known of a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct External {
    /// Its name.
    pub name: String,
    /// The names of what it takes.
    pub arguments: Vec<String>,
    /// The number of its components.
    pub components: usize,
}

/// A component of a function, or a derivative of it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, PartialOrd, Ord)]
pub struct Component {
    /// The function, by its place among those of the graph.
    pub function: u8,
    /// The component.
    pub component: u8,
    /// How many numbers the function takes.
    arity: u8,
    /// By which numbers of the list it is differentiated, counted from 1, ascending; 0 stands for none.
    by: [u8; 2],
}

impl Component {
    /// The most functions, components and arguments that there can be.
    pub const MOST: usize = 64;

    /// A component, not differentiated.
    pub fn new(function: usize, component: usize, arity: usize) -> Self {
        let [function, component, arity] = [function, component, arity].map(|n| n as u8);
        Component {
            function,
            component,
            arity,
            by: [0; 2],
        }
    }

    /// Its derivative by a number of the list. Third derivatives are not told apart from one another: nothing asks for
    /// the second ones in the end.
    pub fn by(self, place: usize) -> Self {
        let place = place as u8 + 1;
        let mut by = match self.by {
            [0, 0] => [0, place],
            [0, first] => [first, place],
            [_, last] => [last.max(place), u8::MAX],
        };
        by.sort_unstable();
        Component { by, ..self }
    }

    /// How often it is differentiated: 3 stands for more than twice.
    pub fn order(self) -> usize {
        match self.by {
            [0, 0] => 0,
            [0, _] => 1,
            [_, u8::MAX] => 3,
            _ => 2,
        }
    }

    /// The place in the list by which it is differentiated once.
    pub fn first(self) -> Option<usize> {
        (self.order() == 1).then(|| usize::from(self.by[1]) - 1)
    }

    /// A number of its own.
    pub(super) fn number(self) -> i64 {
        let all = [self.function, self.component, self.by[0], self.by[1]];
        all.into_iter().fold(1, |n, byte| n << 8 | i64::from(byte))
    }

    /// One function that it may be, c + d Σ wⁿ⁻ʲ aⱼ with the weight w: of what stands for a list (`WEIGHT`) it is the linear
    /// function with these coefficients.
    pub(super) fn likeness(self) -> [f64; 2] {
        let own = f64::from(self.function) + 0.37 * f64::from(self.component);
        let (constant, factor) = (0.3 + 0.7 * own.sin(), 1.0 + 0.4 * own.cos());
        match (self.order(), self.first()) {
            (0, _) => [constant, factor],
            (_, Some(place)) => {
                let above = i32::from(self.arity) - 1 - place as i32;
                [factor * WEIGHT.powi(above), 0.0]
            }
            _ => [0.0, 0.0],
        }
    }
}

/// What the number of the rest of a list counts, beside the last number in it.
pub(super) const WEIGHT: f64 = 0.618_033_988_749_894_9;
