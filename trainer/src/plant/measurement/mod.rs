//! From the true motion to the columns that a drive would have recorded. Knows no cause of the motion.

mod noise;
pub mod recording;
pub mod sensors;
