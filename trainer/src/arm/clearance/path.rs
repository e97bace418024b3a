//! Distances along a motion. Between two instants a distance changes by no more than the solids travel, which is bounded by how fast the joints turn
//! and how far from their axes the solids reach: the distance at one instant says when to look again (conservative advancement, Mirtich 1996).

use rayon::prelude::*;

use super::room::{Pair, Room};

/// What the closest distance along a motion may be off, m: as little as an arm repeats.
const RESOLUTION_M: f64 = 5e-4;

/// A motion that starts again where it ends.
pub struct Path<'a> {
    /// Positions of all joints at a time, rad or m.
    pub position: &'a (dyn Fn(f64) -> Vec<f64> + Sync),
    /// Speed that each joint does not exceed, rad/s or m/s.
    pub speeds: &'a [f64],
    /// Time after which it starts again, s.
    pub period_s: f64,
}

/// Where two solids come closest.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearest {
    /// Link that comes close.
    pub link: String,
    /// What it comes close to: another link, or an obstacle.
    pub to: String,
    /// Whether that is an obstacle.
    pub is_obstacle: bool,
    /// Distance, m.
    pub distance: f64,
    /// When, s.
    pub time: f64,
}

impl Room<'_> {
    /// Whether no pair comes closer than the clearance at any time.
    #[must_use]
    pub fn is_clear(&self, path: &Path<'_>) -> bool {
        self.pairs.par_iter().all(|pair| self.keeps(pair, path))
    }

    /// Each distance that is looked at is more than the clearance c by a margin m or more. Until it can have shrunk from d to c nothing is looked at; as
    /// it is c + m again at the next instant, it is never below c + m / 2 between the two. The rounding of the library is far less than that.
    fn keeps(&self, pair: &Pair, path: &Path<'_>) -> bool {
        let speed = pair.speed(path.speeds);
        let mut time = 0.0;
        while time < path.period_s {
            let distance = self.distance(pair, &self.poses(&(path.position)(time)));
            if distance < self.kept() {
                return false;
            }
            time += (distance - self.clearance_m) / speed;
        }
        true
    }

    /// The closest that a link comes to obstacles (or, where `to_obstacles` is false, to other links), within half a millimetre; `None` where there
    /// is no such pair.
    #[must_use]
    pub fn nearest(&self, path: &Path<'_>, to_obstacles: bool) -> Option<Nearest> {
        let mut nearest: Option<(f64, f64, &Pair)> = None;
        for pair in self.pairs.iter().filter(|pair| self.is_obstacle(pair) == to_obstacles) {
            let speed = pair.speed(path.speeds);
            let mut time = 0.0;
            while time < path.period_s {
                let distance = self.distance(pair, &self.poses(&(path.position)(time)));
                let least = nearest.map_or(f64::INFINITY, |(least, _, _)| least).min(distance);
                if nearest.is_none_or(|(least, _, _)| distance < least) {
                    nearest = Some((distance, time, pair));
                }
                time += (distance - least + RESOLUTION_M) / speed;
            }
        }
        let (distance, time, pair) = nearest?;
        let [link, to] = self.names(pair);
        Some(Nearest { link, to, is_obstacle: to_obstacles, distance, time })
    }
}
