//! What a fit says about the samples: the law, the residuals, the nuisance columns beside it.

use super::{Fit, Problem};
use crate::law::fitting::projection::Basis;

impl Problem<'_> {
    /// Coefficients of the nuisance columns beside a fitted law.
    pub fn nuisance_coefficients(&self, fit: &Fit) -> Vec<f64> {
        let law = self.law_values(fit);
        let mut rest: Vec<f64> = self.data.target.iter().zip(&law).map(|(y, f)| y - f).collect();
        let products = self.nuisance.remove_from(&mut rest);
        self.nuisance.coefficients(&products)
    }

    /// Standard errors of the coefficients for unit noise, the non-linear constants being given.
    pub fn coefficient_errors(&self, fit: &Fit) -> Vec<f64> {
        let tape = self.tape(&fit.structure);
        let mut basis = Basis::default();
        for mut column in tape.run(&fit.params, &[]).values {
            self.nuisance.remove_from(&mut column);
            basis.push(&column);
        }
        basis.errors()
    }

    /// The law at every sample, without the nuisance columns.
    pub fn law_values(&self, fit: &Fit) -> Vec<f64> {
        let template = fit.structure.template(self.extents.layout());
        self.tape_of(&[template]).run(&fit.params, &[]).values.remove(0)
    }

    /// Residuals of law and nuisance columns together.
    pub fn residuals(&self, fit: &Fit) -> Vec<f64> {
        let mut rest: Vec<f64> = self.data.target.iter().zip(self.law_values(fit)).map(|(y, f)| y - f).collect();
        self.nuisance.remove_from(&mut rest);
        rest
    }
}
