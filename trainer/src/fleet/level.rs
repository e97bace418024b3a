//! Friction at speeds that all siblings reach, from the curve of each: whatever law describes a joint, its friction there is well known.

use super::measured::Measured;
use super::siblings::Estimate;
use crate::numerics::statistics::quantile;

/// The slow, medium and fast speed as shares of the top speed that siblings share. Chosen by judgement: below the first presliding
/// hides the friction, above the last few samples are left.
const SHARES: [f64; 3] = [0.1, 0.4, 0.9];

/// Share of the siblings that need not reach the shared top speed.
const SLOWER_SHARE: f64 = 0.1;

/// Speeds at which siblings are compared, rad/s or m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Levels(pub [f64; 3]);

impl Levels {
    /// Names of the friction at these speeds.
    pub const NAMES: [&'static str; 3] = ["friction_slow", "friction_medium", "friction_fast"];

    /// Speeds that nearly all of these reach.
    #[must_use]
    pub fn shared(members: &[&Measured]) -> Self {
        let top = quantile(members.iter().map(|member| top_speed(&member.curve)), SLOWER_SHARE);
        Self(SHARES.map(|share| share * top))
    }

    /// Friction against the motion at each speed, mean of the directions that were driven; `None` where the joint was never so fast.
    #[must_use]
    pub fn of(&self, member: &Measured) -> [Option<Estimate>; 3] {
        self.0.map(|speed| {
            let directions = [speed, -speed].map(|velocity| at(&member.curve, velocity));
            let driven: Vec<Estimate> = directions.into_iter().flatten().collect();
            let mean = |of: fn(&Estimate) -> f64| driven.iter().map(of).sum::<f64>() / driven.len() as f64;
            // Errors of the two directions go together where the offset of the torque is at fault: not divided by the root of two.
            (!driven.is_empty()).then(|| Estimate { value: mean(|e| e.value), error: mean(|e| e.error) })
        })
    }
}

/// The highest speed that a curve reaches in all directions that were driven.
fn top_speed(curve: &[[f64; 3]]) -> f64 {
    let (Some(first), Some(last)) = (curve.first(), curve.last()) else { return 0.0 };
    let (backward, forward) = (-first[0], last[0]);
    if backward > 0.0 && forward > 0.0 { backward.min(forward) } else { backward.max(forward) }
}

/// The friction against the motion at a velocity, between the points of a curve.
fn at(curve: &[[f64; 3]], velocity: f64) -> Option<Estimate> {
    let right = curve.iter().position(|point| point[0] >= velocity)?;
    let left = right.checked_sub(1).or((curve[right][0] == velocity).then_some(right))?;
    let [from, to] = [curve[left], curve[right]];
    let share = if to[0] > from[0] { (velocity - from[0]) / (to[0] - from[0]) } else { 0.0 };
    let [friction, error] = [1, 2].map(|of| from[of] + share * (to[of] - from[of]));
    Some(Estimate { value: friction * velocity.signum(), error })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fleet::tests::measured;

    #[test]
    fn friction_is_taken_where_all_siblings_have_been() {
        // Friction 2 + v forward, -(3 - v) backward, known to 0.1.
        let curve = |top: f64| {
            let point = |v: f64| {
                let friction = if v > 0.0 { 2.0 + v } else { -3.0 + v };
                [v, friction, 0.1]
            };
            (-50..=50).map(|i| point(top * f64::from(i) / 50.0)).collect::<Vec<_>>()
        };
        let members: Vec<Measured> =
            [1.0, 2.0, 1.0, 1.5].into_iter().map(|top| Measured { curve: curve(top), ..measured("a", 1.0) }).collect();
        let levels = Levels::shared(&members.iter().collect::<Vec<_>>());
        assert_eq!(levels.0, [0.1, 0.4, 0.9]);
        let [slow, _, fast] = levels.of(&members[0]);
        assert!((slow.unwrap().value - 2.6).abs() < 1e-9 && (slow.unwrap().error - 0.1).abs() < 1e-9);
        assert!((fast.unwrap().value - 3.4).abs() < 1e-9);
        let forward = Measured { curve: curve(1.0)[60..].to_vec(), ..measured("a", 1.0) };
        assert!((levels.of(&forward)[2].unwrap().value - 2.9).abs() < 1e-9);
        assert_eq!(Levels([9.0; 3]).of(&members[0])[0], None);
    }
}
