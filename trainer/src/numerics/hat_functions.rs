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
}
