//! Strokes of constant speed: whether a Stribeck curve through all speeds but one tells the friction at that one.

use crate::fit::data::gather::Material;
use crate::fit::data::rigid;
use crate::law::significant;
use crate::numerics::regression::least_squares;
use crate::numerics::statistics::{mean, root_mean_square};

/// Fewest speeds: of what is left a curve of four constants has to be determined.
const FEWEST_SPEEDS: usize = 6;
/// Speeds of rows that lie no further apart than this share belong to one stroke; strokes of a test are further apart.
const SAME_SPEED: f64 = 0.05;
/// Fewest samples in a row at one speed: on the ramps between strokes fewer are within that share.
const FEWEST_IN_A_ROW: usize = 10;
/// Least share of the samples in motion that stand at a speed: of a swing a fifth does, about its fastest points.
const LEAST_SHARE: f64 = 0.5;
/// Stribeck velocities that are tried over the largest speed, from the narrowest that strokes show to one that is a straight line.
const STRIBECK_SHARES: [f64; 24] = {
    let (mut shares, mut k, mut share) = ([0.0; 24], 0, 0.01);
    while k < 24 {
        (shares[k], share, k) = (share, 1.22 * share, k + 1);
    }
    shares
};

/// Friction at one speed and direction.
struct Plateau {
    /// Which of the speeds, whatever the direction.
    speed: usize,
    velocity: f64,
    friction: f64,
}

/// What leaving out one speed at a time shows, in a sentence; `None` where the motion is none of strokes, or has few speeds.
pub(in crate::fit) fn left_out(material: &Material) -> Option<String> {
    let velocity = material.samples.velocity.as_deref()?;
    let velocity: Vec<f64> = material.rows.iter().map(|row| velocity[*row]).collect();
    let follows = |at: usize| material.rows[at] - material.rows[at - 1] <= material.stride;
    let rows = at_one_speed(&velocity, follows);
    if (rows.len() as f64) < LEAST_SHARE * velocity.len() as f64 {
        return None;
    }
    let friction = material.target_at_velocity();
    let of = |column: &[f64]| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
    let plateaus = plateaus(&of(&velocity), &of(&friction));
    let speeds = plateaus.last().map_or(0, |last| last.speed + 1);
    if speeds < FEWEST_SPEEDS {
        return None;
    }
    let stribeck = error(&plateaus, speeds, true);
    let straight = error(&plateaus, speeds, false);
    let unit = rigid::printed(material.samples.actuator_unit);
    Some(format!(
        "Each of the {speeds} speeds left out in turn: a Stribeck curve through the others misses it by {} {unit}, Coulomb and viscous friction by \
         {} {unit} (root mean square).",
        significant(stribeck, 2),
        significant(straight, 2)
    ))
}

/// Rows at which the velocity stands for a while; `follows` says whether a row comes right after the one before it.
fn at_one_speed(velocity: &[f64], follows: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut rows = Vec::new();
    let mut start = 0;
    for at in 1..=velocity.len() {
        let stays = |at: usize| (velocity[at] - velocity[start]).abs() <= SAME_SPEED * velocity[start].abs();
        if at < velocity.len() && follows(at) && stays(at) {
            continue;
        }
        if at - start >= FEWEST_IN_A_ROW {
            rows.extend(start..at);
        }
        start = at;
    }
    rows
}

/// Mean friction at each speed and direction, slow ones first.
fn plateaus(velocity: &[f64], friction: &[f64]) -> Vec<Plateau> {
    let mut rows: Vec<usize> = (0..velocity.len()).collect();
    rows.sort_by(|a, b| velocity[*a].abs().total_cmp(&velocity[*b].abs()));
    let mut plateaus = Vec::new();
    let of_one_speed = rows.chunk_by(|a, b| velocity[*b].abs() <= (1.0 + SAME_SPEED) * velocity[*a].abs());
    for (speed, rows) in of_one_speed.enumerate() {
        for direction in [1.0, -1.0] {
            let own: Vec<usize> = rows.iter().copied().filter(|row| direction * velocity[*row] > 0.0).collect();
            if own.is_empty() {
                continue;
            }
            let of = |column: &[f64]| mean(&own.iter().map(|row| column[*row]).collect::<Vec<f64>>());
            plateaus.push(Plateau { speed, velocity: of(velocity), friction: of(friction) });
        }
    }
    plateaus
}

/// Root mean square by which the law of all other speeds misses the friction at each.
fn error(plateaus: &[Plateau], speeds: usize, is_stribeck: bool) -> f64 {
    let top = plateaus.iter().fold(0.0_f64, |top, plateau| top.max(plateau.velocity.abs()));
    let both_ways = [1.0, -1.0].iter().all(|way| plateaus.iter().any(|plateau| way * plateau.velocity > 0.0));
    let row = |plateau: &Plateau, share: Option<f64>| {
        let (v, sign) = (plateau.velocity, plateau.velocity.signum());
        let offset = both_ways.then_some(1.0);
        let extra = share.map(|share| sign * (-v.abs() / (share * top)).exp());
        [sign, v].into_iter().chain(offset).chain(extra).collect::<Vec<f64>>()
    };
    let shares: Vec<Option<f64>> = if is_stribeck { STRIBECK_SHARES.map(Some).to_vec() } else { vec![None] };
    let mut missed = Vec::new();
    for held in 0..speeds {
        let (out, learnt): (Vec<&Plateau>, Vec<&Plateau>) = plateaus.iter().partition(|p| p.speed == held);
        let target: Vec<f64> = learnt.iter().map(|plateau| plateau.friction).collect();
        let fitted = shares.iter().map(|share| {
            let rows: Vec<Vec<f64>> = learnt.iter().map(|plateau| row(plateau, *share)).collect();
            let columns: Vec<Vec<f64>> = (0..rows[0].len()).map(|k| rows.iter().map(|row| row[k]).collect()).collect();
            (*share, least_squares(&columns, &target, &[]))
        });
        let Some((share, fit)) = fitted.min_by(|a, b| a.1.rmse.total_cmp(&b.1.rmse)) else { continue };
        let predicted =
            |plateau: &Plateau| row(plateau, share).iter().zip(&fit.coefficients).map(|(x, c)| x * c).sum::<f64>();
        missed.extend(out.iter().map(|plateau| plateau.friction - predicted(plateau)));
    }
    root_mean_square(&missed)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors of a Stribeck curve and of Coulomb and viscous friction, of strokes both ways with the given friction.
    fn errors(friction: impl Fn(f64) -> f64) -> [f64; 2] {
        let speeds = [0.02, 0.04, 0.07, 0.1, 0.15, 0.25, 0.4, 0.6, 0.9, 1.3];
        let strokes = speeds.iter().flat_map(|speed| [*speed, -speed]);
        let velocity: Vec<f64> =
            strokes.flat_map(|v| (0..200).map(move |i| v * (1.0 + 0.01 * f64::from(i).sin()))).collect();
        let noise = |i: usize| 0.08 * (12.9898 * i as f64).sin();
        let torque: Vec<f64> =
            velocity.iter().enumerate().map(|(i, v)| 0.4 + v.signum() * friction(v.abs()) + noise(i)).collect();
        let plateaus = plateaus(&velocity, &torque);
        assert_eq!(plateaus.len(), 2 * speeds.len());
        [true, false].map(|is_stribeck| error(&plateaus, speeds.len(), is_stribeck))
    }

    #[test]
    fn strokes_stand_at_their_speeds_and_a_swing_hardly_does() {
        let strokes = |i: usize| [1.0, -1.0, 0.5, -0.5][i / 100 % 4] * (0.05 * (i % 100) as f64).min(1.0);
        let swing = |i: usize| (0.02 * i as f64).sin();
        let share = |velocity: &dyn Fn(usize) -> f64| {
            let velocity: Vec<f64> = (0..4000).map(velocity).collect();
            at_one_speed(&velocity, |_| true).len() as f64 / velocity.len() as f64
        };
        assert!(share(&strokes) > 0.75 && share(&swing) < 0.4, "{} {}", share(&strokes), share(&swing));
        // Neighbours of which one was left out are not in a row.
        assert!(at_one_speed(&[1.0; 30], |at| at % 5 != 0).is_empty());
    }

    #[test]
    fn a_speed_that_was_left_out_lies_on_the_stribeck_curve_of_the_others_where_there_is_one() {
        let [stribeck, straight] = errors(|v| 2.3 + (-v / 0.1).exp() + 0.8 * v);
        assert!(stribeck < 0.5 * straight && straight > 0.1, "{stribeck} {straight}");
        let [_, straight] = errors(|v| 2.3 + 0.8 * v);
        assert!(straight < 0.02, "{straight}");
    }
}
