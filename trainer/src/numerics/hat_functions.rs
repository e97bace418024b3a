//! Hat functions over speed, dense where friction bends.

/// Place of a knot over speed as a share of the top speed, by a square law: dense at low speed, where friction bends.
pub(crate) fn speed_knot(j: usize, knots: usize) -> f64 {
    (j as f64 / (knots - 1) as f64).powi(2)
}

/// Hat functions over speed as a share of the top speed, linear between knots, so exact for Coulomb and viscous friction. The last
/// two continue beyond the top speed, which only most samples stay below.
pub(crate) fn speed_hats(share: f64, knots: usize) -> impl Iterator<Item = f64> {
    let last = knots - 1;
    let knot = move |j: usize| speed_knot(j, knots);
    let after = ((share.sqrt() * last as f64) as usize + 1).min(last);
    let rise = (share - knot(after - 1)) / (knot(after) - knot(after - 1));
    (0..knots).map(move |j| match after.checked_sub(j) {
        Some(0) => rise,
        Some(1) => 1.0 - rise,
        _ => 0.0,
    })
}

/// Hats over speed by which the error of a friction law is described. Chosen by judgement: half of the finest curve that a diagnosis learns
/// of a simulation; more leave few rows to each, fewer miss what is wrong near rest.
const LAW_ERROR_KNOTS: usize = 17;

/// Hats over speed with the sign of the velocity by which the error of a friction law is described: those of the rows at which the joint speeds
/// up, then those at which it slows down, or of all rows where there is no acceleration. `top_speed` is that of the law.
pub(crate) fn law_error_hats(velocity: &[f64], acceleration: Option<&[f64]>, top_speed: f64) -> Vec<Vec<f64>> {
    let over = |counts: &dyn Fn(usize) -> bool| {
        let mut columns = vec![vec![0.0; velocity.len()]; LAW_ERROR_KNOTS];
        for (row, velocity) in velocity.iter().enumerate().filter(|(row, _)| counts(*row)) {
            let hats = speed_hats(velocity.abs() / top_speed.max(f64::MIN_POSITIVE), LAW_ERROR_KNOTS);
            columns.iter_mut().zip(hats).for_each(|(column, hat)| column[row] = velocity.signum() * hat);
        }
        columns
    };
    let Some(acceleration) = acceleration else { return over(&|_| true) };
    let speeds_up = |row: usize| acceleration[row] * velocity[row] > 0.0;
    [over(&speeds_up), over(&|row| !speeds_up(row))].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spline_holds_coulomb_and_viscous_friction_exactly() {
        let (knots, top_speed) = (9, 3.0);
        let at_knots: Vec<f64> = (0..knots).map(|j| 2.0 + 1.2 * top_speed * (j as f64 / 8.0).powi(2)).collect();
        for speed in [0.0, 1e-9, 0.02, 0.4, 0.75, 2.9, 3.0, 3.3, 9.0] {
            let torque: f64 = speed_hats(speed / top_speed, knots).zip(&at_knots).map(|(hat, f)| hat * f).sum();
            assert!((torque - (2.0 + 1.2 * speed)).abs() < 1e-9, "{torque} at {speed}");
        }
    }

    #[test]
    fn the_hats_of_an_error_add_up_to_the_sign_of_the_velocity() {
        let (velocity, acceleration) = ([0.5, -0.2, 0.0, -1.0], [1.0, 1.0, -1.0, -2.0]);
        let columns = law_error_hats(&velocity, Some(&acceleration), 1.0);
        let sum = |columns: &[Vec<f64>], row: usize| columns.iter().map(|column| column[row]).sum::<f64>();
        let (up, down) = columns.split_at(LAW_ERROR_KNOTS);
        let signs = [(1.0, 0.0), (0.0, -1.0), (0.0, 1.0), (-1.0, 0.0)];
        for (row, (speeding_up, slowing_down)) in signs.into_iter().enumerate() {
            assert!((sum(up, row) - speeding_up).abs() < 1e-12 && (sum(down, row) - slowing_down).abs() < 1e-12);
        }
        assert_eq!(law_error_hats(&velocity, None, 1.0).len(), LAW_ERROR_KNOTS);
    }
}
