//! How large an effect is beyond what base, common columns and the other effects of its set could take, and how sure that is: two that cancel
//! each other are small, however large each is.

use crate::diagnose::infer::candidates::Candidates;
use crate::diagnose::infer::side::Side;
use crate::diagnose::infer::weighing::Weighing;
use crate::inference::evidence::Candidate;
use crate::inference::sets::Member;
use crate::numerics::least_squares::{orthonormal, project_out, weighted};
use crate::numerics::statistics::root_mean_square;

/// Standard deviations below its mean that a normal variable exceeds with 95 %.
const EXCEEDED_WITH_95: f64 = 1.645;

/// Torque of an effect, root mean square over the weighed rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Size {
    pub torque: f64,
    /// What it exceeds with 95 %.
    pub least: f64,
}

/// What sizes are taken from.
pub(crate) struct Sizing<'a> {
    pub candidates: &'a Candidates,
    pub real: &'a Side<'a>,
    /// Exponent of the evidence, which is that of the precision of a coefficient.
    pub temper: f64,
}

impl Sizing<'_> {
    /// Sizes of the members of a set. Members that do not exceed `least`, N m, with 95 % are left out one after the other, the smallest first,
    /// and the others are as large as they are without them: what several explain alike goes to the one that is left.
    pub fn of_set(&self, weighing: &Weighing, weighed: &[Candidate], members: &[Member], least: f64) -> Vec<Size> {
        let mut sizes = self.of(weighing, weighed, members);
        let mut left: Vec<usize> = (0..members.len()).collect();
        loop {
            let small = (0..left.len()).filter(|place| sizes[left[*place]].least < least);
            let Some(smallest) = small.min_by(|a, b| sizes[left[*a]].torque.total_cmp(&sizes[left[*b]].torque)) else {
                return sizes;
            };
            left.remove(smallest);
            let kept: Vec<Member> = left.iter().map(|&place| members[place]).collect();
            left.iter().zip(self.of(weighing, weighed, &kept)).for_each(|(&place, size)| sizes[place] = size);
        }
    }

    /// Sizes of the members of a set, each beyond all others.
    fn of(&self, weighing: &Weighing, weighed: &[Candidate], members: &[Member]) -> Vec<Size> {
        let own = weighing.own(weighed, members);
        let model = weighing.model(weighed, members);
        let of_member = |member: &Member| {
            let places = self.candidates.places(std::slice::from_ref(member));
            let others: Vec<Member> = members.iter().copied().filter(|other| other != member).collect();
            let of_others =
                self.candidates.places(&others).into_iter().map(|place| self.candidates.real[place].clone());
            let beside: Vec<Vec<f64>> = self.real.columns.iter().cloned().chain(of_others).collect();
            let basis = orthonormal(&beside, &self.real.runs);
            let beyond: Vec<Vec<f64>> = places.iter().map(|&place| self.beyond(&basis, place)).collect();
            let coefficients: Vec<f64> = places.iter().map(|&place| own[place]).collect();
            let torque = weighted(&beyond, &coefficients);
            let size = root_mean_square(&torque);
            // Change of the size with each coefficient.
            let slope = |column: &Vec<f64>| {
                let product: f64 = column.iter().zip(&torque).map(|(a, b)| a * b).sum();
                product / (torque.len() as f64 * size).max(f64::MIN_POSITIVE)
            };
            let slopes: Vec<(usize, f64)> = places.iter().copied().zip(beyond.iter().map(slope)).collect();
            let deviation = model.as_ref().map_or(f64::INFINITY, |model| model.deviation(&slopes) / self.temper.sqrt());
            Size { torque: size, least: size - EXCEEDED_WITH_95 * deviation }
        };
        members.iter().map(of_member).collect()
    }

    /// A column at the weighed rows, less what base and other effects, of that basis, take of it.
    fn beyond(&self, basis: &[Vec<f64>], place: usize) -> Vec<f64> {
        let mut column = self.candidates.real[place].clone();
        project_out(&mut column, basis, &self.real.runs);
        self.real.on_rows(&column)
    }
}
