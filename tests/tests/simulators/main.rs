//! The simulator gets its model back: MuJoCo logs a joint and a simulation of it, the diagnosis finds what is missing, the export patches
//! the simulator's own file, and MuJoCo or Drake runs it on a motion that nobody has seen. Other formats are read by their own programs.
//! `tests/setup.sh` installs these under `target/simulators`; without one its tests say so and do nothing.

mod arm;
mod family;
mod foreign;
mod mujoco;
mod others;
mod programs;
