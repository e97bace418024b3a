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

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::arm::chain::Chain;
    use crate::joint::{Obstacle, Surroundings};
    use crate::robot::parse;

    /// A ball of 1 cm on an arm of a metre, and a slide with a rod on it behind a second joint.
    const ARM: &str = r#"<robot name="r"><link name="base"/>
        <link name="swing"><collision><origin xyz="0 0 1"/><geometry><sphere radius="0.01"/></geometry></collision></link>
        <link name="side"/><link name="slide"><collision><origin xyz="0.1 0 0" rpy="0.3 1 0"/><geometry><capsule radius="0.02" length="0.3"/></geometry></collision></link>
        <joint name="a" type="revolute"><parent link="base"/><child link="swing"/><axis xyz="0 1 0"/><limit lower="-2" upper="2"/></joint>
        <joint name="b" type="revolute"><origin xyz="0 0.3 0.2"/><parent link="swing"/><child link="side"/><axis xyz="0.6 0 0.8"/><limit lower="-2" upper="2"/></joint>
        <joint name="c" type="prismatic"><origin xyz="0.2 0.1 0" rpy="1 0 0"/><parent link="side"/><child link="slide"/><axis xyz="0 0 1"/><limit lower="-0.3" upper="0.5"/></joint></robot>"#;
    const RANGES: [[f64; 2]; 3] = [[-2.0, 2.0], [-2.0, 2.0], [-0.3, 0.5]];

    fn with_room<T>(obstacles: &[([f64; 3], [f64; 3])], clearance_m: f64, with: impl FnOnce(&Room<'_>) -> T) -> T {
        let named = |(centre_m, size_m): &([f64; 3], [f64; 3])| Obstacle {
            name: "plate".to_owned(),
            centre_m: *centre_m,
            size_m: *size_m,
            rpy_rad: [0.0; 3],
        };
        let obstacles = obstacles.iter().map(named).collect();
        let robot = parse(ARM).unwrap();
        let chain = Chain::of(&robot, &[]).unwrap();
        let around = Surroundings { obstacles, clearance_m, ..Surroundings::default() };
        with(&Room::of(&robot, &chain, &RANGES, &around, 1).unwrap())
    }

    #[test]
    fn nothing_passes_through_a_thin_plate_between_two_instants() {
        let position = |time: f64| vec![0.5 + 1.4 * (TAU * time).sin(), 0.0, 0.0];
        let path = Path { position: &position, speeds: &[TAU * 1.4, 0.0, 0.0], period_s: 1.0 };
        // Half a millimetre thin, across the way of the ball where that is fastest.
        let [sine, cosine] = [0.5_f64.sin(), 0.5_f64.cos()];
        let plate = ([sine, 0.0, cosine + 0.02], [0.0005, 0.2, 0.2]);
        with_room(&[plate], 0.001, |room| {
            let pair = room.pairs.iter().find(|pair| room.names(pair) == ["swing", "plate"]).unwrap();
            // Instants as far apart as those that a motion is judged at see nothing of it.
            let seen = |index: usize| room.distance(pair, &room.poses(&position((index as f64 + 0.5) / 100.0)));
            assert!((0..100).map(seen).all(|distance| distance > room.kept()));
            assert!(!room.is_clear(&path));
            let nearest = room.nearest(&path, true).unwrap();
            assert_eq!((nearest.link.as_str(), nearest.to.as_str(), nearest.distance), ("swing", "plate", 0.0));
        });
        // Beside the way of the ball it is clear.
        with_room(&[([sine, 0.2, cosine], [0.0005, 0.2, 0.2])], 0.02, |room| {
            assert!(room.is_clear(&path));
            let nearest = room.nearest(&path, true).unwrap();
            assert!((nearest.distance - 0.09).abs() < 1e-3, "{nearest:?}");
        });
    }

    #[test]
    fn no_distance_changes_faster_than_is_reckoned_with() {
        let rates = [3.0, 5.0, 7.0];
        let size = [1.8, 1.9, 0.39];
        let position = |time: f64| -> Vec<f64> {
            let middle = |joint: usize| 0.5 * (RANGES[joint][0] + RANGES[joint][1]);
            (0..3).map(|joint| middle(joint) + size[joint] * (rates[joint] * time + joint as f64).sin()).collect()
        };
        let speeds: Vec<f64> = (0..3).map(|joint| size[joint] * rates[joint]).collect();
        let step = 1e-3;
        with_room(&[([0.5, 0.4, 0.3], [0.2, 0.3, 0.1])], 0.001, |room| {
            assert_eq!(room.pairs.len(), 3);
            for pair in &room.pairs {
                let bound = pair.speed(&speeds);
                let distances: Vec<f64> = (0..6000)
                    .map(|index| room.distance(pair, &room.poses(&position(f64::from(index) * step))))
                    .collect();
                let changes = distances.windows(2).map(|pair| (pair[1] - pair[0]).abs() / step);
                let fastest = changes.fold(0.0, f64::max);
                // Rounding of the library, 20 micrometres.
                assert!(fastest < bound + 2e-5 / step, "{:?}: {fastest} of {bound}", room.names(pair));
                assert!(fastest > 0.2 * bound, "{:?}: {fastest} of {bound}", room.names(pair));
            }
        });
    }
}
