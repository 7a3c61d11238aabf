//! Values, derivatives and substitutions: f(x), ∂f/∂x_v, f with x_v = g.

use super::field::Field;
use super::monomial::{Monomial, Var};
use super::polynomial::Poly;

impl<F: Field> Poly<F> {
    /// Evaluates f with the given value of every variable.
    pub fn eval(&self, value: &dyn Fn(Var) -> F) -> F {
        self.terms().iter().fold(F::zero(), |sum, (monomial, c)| {
            let powers = monomial.powers().iter();
            let product = powers.fold(c.clone(), |product, &(variable, exponent)| {
                let x = value(variable);
                (0..exponent).fold(product, |product, _| product.mul(&x))
            });
            sum.add(&product)
        })
    }

    /// ∂f/∂x_v.
    pub fn derivative(&self, variable: Var) -> Self {
        let terms = self.terms().iter().filter_map(|(monomial, c)| {
            let rest = monomial.div(&Monomial::var(variable))?;
            Some((rest, c.mul(&F::integer(monomial.exponent(variable).into()))))
        });
        Self::from_terms(self.order(), terms.collect())
    }

    /// Replaces some variables by field elements.
    pub fn specialize(&self, value: &dyn Fn(Var) -> Option<F>) -> Self {
        let terms = self.terms().iter().map(|(monomial, c)| {
            let mut coefficient = c.clone();
            let kept = monomial
                .powers()
                .iter()
                .filter(|power| match value(power.0) {
                    Some(x) => {
                        (0..power.1).for_each(|_| coefficient = coefficient.mul(&x));
                        false
                    }
                    None => true,
                });
            let kept: Vec<(Var, u32)> = kept.copied().collect();
            (Monomial::from_powers(kept), coefficient)
        });
        Self::from_terms(self.order(), terms.collect())
    }

    /// Replaces x_v by g.
    pub fn substitute(&self, variable: Var, by: &Self) -> Self {
        let result = self.substitute_limited(variable, by, usize::MAX);
        result.unwrap_or_else(|| Self::from_sorted(self.order(), Vec::new()))
    }

    /// Replaces x_v by g, unless an intermediate result has more than `most` terms.
    pub fn substitute_limited(&self, variable: Var, by: &Self, most: usize) -> Option<Self> {
        // Horner in x_v: f = (… (f_n g + f_{n−1}) g + …) g + f_0.
        let degrees = self.terms().iter().map(|term| term.0.exponent(variable));
        let mut result = Self::from_sorted(self.order(), Vec::new());
        for exponent in (0..=degrees.max().unwrap_or(0)).rev() {
            let power = Monomial::from_powers([(variable, exponent)]);
            let slice = self.terms().iter().filter_map(|(monomial, c)| {
                let rest = monomial.div(&power)?;
                (rest.exponent(variable) == 0).then(|| (rest, c.clone()))
            });
            let slice = Self::from_terms(self.order(), slice.collect());
            result = result.mul_limited(by, most)?.add(&slice);
            if result.terms().len() > most {
                return None;
            }
        }
        Some(result)
    }
}
