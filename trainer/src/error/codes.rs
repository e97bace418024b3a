//! Registry of the stable codes: what each means, its usual cause, what to do. Read by `trainer explain`.
//!
//! A code is never reused or renamed. `U` usage, `D` data, `N` not identifiable, `I` input and output, `W` warning.

use super::Class;

/// One entry of the registry.
#[derive(Debug, PartialEq, Eq)]
pub struct Code {
    /// Stable identifier, such as `FRK-D005`.
    pub id: &'static str,
    /// Kind of failure; decides the exit status.
    pub class: Class,
    /// A few words that name the failure.
    pub title: &'static str,
    /// What has happened.
    pub meaning: &'static str,
    /// What is usually behind it.
    pub cause: &'static str,
    /// What to do about it.
    pub remedy: &'static str,
}

/// Declares the codes and [`ALL`], so that none can be missing from the list.
macro_rules! registry {
    ($($name:ident = $id:literal $class:ident $title:literal, $meaning:literal, $cause:literal, $remedy:literal;)*) => {
        $(
            #[doc = concat!("`", $id, "`: ", $title, ".")]
            pub static $name: Code = Code {
                id: $id, class: Class::$class, title: $title, meaning: $meaning, cause: $cause, remedy: $remedy,
            };
        )*
        /// Every code, in order of its identifier.
        pub static ALL: &[&Code] = &[$(&$name),*];
    };
}

/// The code with this identifier; capitals do not matter and `FRK-` may be left out.
#[must_use]
pub fn find(id: &str) -> Option<&'static Code> {
    let wanted = id.trim().to_ascii_uppercase();
    ALL.iter().copied().find(|code| code.id == wanted || code.id.strip_prefix("FRK-") == Some(wanted.as_str()))
}

registry! {
    EMPTY_FILE = "FRK-D001" Data "empty file",
        "The file holds no bytes, or only blank lines and comments.",
        "The recorder was stopped before it wrote, or the disk was full.",
        "Record again, or check that the right file is named.";
    TOO_FEW_ROWS = "FRK-D002" Data "too few rows",
        "The recording has a header but too few rows of data to filter, split and fit.",
        "A header without data, a recording cut short, or an extract made for a look at the columns.",
        "Record at least a few seconds of motion: several hundred rows, both directions, several speeds.";
    LINE_TOO_LONG = "FRK-D003" Data "line too long",
        "A line, or a quoted field that never closes, is longer than one mebibyte; reading stopped there.",
        "The file is not a text table (binary log, one line of JSON), or a quotation mark is left open.",
        "Export the recording as CSV with one line a sample.";
    NOT_UTF8 = "FRK-D004" Data "not UTF-8 text",
        "A field holds bytes that are not UTF-8.",
        "The file is binary, UTF-16 (some spreadsheets' `Unicode text`), or a header uses an old code page.",
        "Save as CSV UTF-8; unit suffixes need ASCII letters only.";
    NOT_A_NUMBER = "FRK-D005" Data "text in place of a number",
        "A field of a numeric column cannot be read as a number. A decimal point is expected; a decimal comma only where columns are separated by semicolon or tab.",
        "A missing-value mark such as `n/a`, a repeated header in the middle of joined files, or an empty field.",
        "Remove or repair the row. Rows are not repaired silently, since a skipped row shifts every derivative.";
    NOT_FINITE = "FRK-D006" Data "NaN or infinite value",
        "A field reads as NaN or as an infinity.",
        "An estimator that had not started, a division by a zero time step, or a joint that did not report.",
        "Cut the recording to where every channel is valid, or remove the column if it is not needed.";
    RAGGED_ROW = "FRK-D007" Data "wrong number of fields",
        "A row does not have as many fields as the header.",
        "The recording was cut off while writing, or a text field holds the separator without quotation marks.",
        "Remove the broken row; the last one is the usual place.";
    DUPLICATE_COLUMN = "FRK-D008" Data "column given twice",
        "Two columns have the same name, or two columns give the same quantity (as `position_rad` and `position_deg`).",
        "Tables joined side by side, or a log that repeats a channel in several units.",
        "Remove one, or choose with `[columns]` in joint.toml.";
    MISSING_COLUMN = "FRK-D009" Data "missing column",
        "A quantity that the task needs is neither recorded nor derivable from what is recorded.",
        "The column has another name, or lacks its unit: `velocity` instead of `velocity_rad_s`. Or the joint, a servo or one under a PD command, reports no torque.",
        "Rename the column to `<quantity>_<unit>`, or map it in joint.toml: `[columns] velocity = { name = \"dq\", unit = \"deg/s\" }`. A joint that reports no torque but was told a reference position, a duty or a voltage has `[actuator]` there, of which the torque follows: docs/servos.md; `trainer init` proposes both.";
    UNKNOWN_UNIT = "FRK-D010" Data "unknown or unfitting unit",
        "A column is named as a known quantity but its unit suffix is not one of that quantity.",
        "A unit outside the list, a slash or power written differently, or a linear unit on a rotary quantity.",
        "Use one of the units that the message lists, or map the column in joint.toml.";
    TIME_NOT_INCREASING = "FRK-D011" Data "time does not increase",
        "A time stamp is not later than the one before it.",
        "Samples written twice or out of order, a counter that wrapped around, or two recordings joined in one file.",
        "Sort or remove the repeated rows; pass joined recordings as separate files.";
    MIXED_AXIS = "FRK-D012" Data "rotary and linear columns mixed",
        "One column measures the joint in radians and another in metres.",
        "Columns of two joints in one file, or a wrong unit suffix.",
        "Keep one joint in a file; name other joints' channels freely (`joint2_position`).";
    NO_KNOWN_COLUMN = "FRK-D013" Data "no recognised column",
        "No column is named `<quantity>_<unit>` as this program reads it.",
        "A file that is not a recording, a missing header line, or names of another tool.",
        "Add a header such as `time_s,position_rad,torque_Nm`, or map the columns in joint.toml.";
    MISSING_PARAMETER = "FRK-D014" Data "missing joint parameter",
        "A column can only be used with a parameter of the drive, which joint.toml does not give.",
        "`position_count` needs `[drive] counts_per_turn`; a rigid body in N m beside a current needs `[drive] torque_constant_Nm_A`.",
        "Write the parameter into joint.toml and pass it with `--joint`.";
    BAD_JOINT_FILE = "FRK-D015" Data "joint.toml cannot be used",
        "joint.toml is not valid TOML, or a key or value is outside what is understood.",
        "A misspelt key, a number without its unit's magnitude (zero, negative, infinite), or a missing bracket.",
        "Correct the line that the message names.";
    NO_MOTION = "FRK-D016" Data "too little motion",
        "The velocity hardly changes over the recording, so friction cannot be separated from an offset.",
        "The joint stood still or ran at one constant speed, or the wrong column is mapped.",
        "Record both directions and several speeds, slow ones included.";
    SEGMENTS_TOO_SHORT = "FRK-D017" Data "no stretch long enough",
        "After removing clock gaps and the edges of the filter nothing is left.",
        "Many gaps in the clock, or a recording shorter than a few filter lengths.",
        "Record longer without gaps, or at a higher rate.";
    RECORDINGS_DISAGREE = "FRK-D018" Data "recordings do not match",
        "Recordings that are to be used together have different axes, actuator quantities or channels.",
        "Files of different joints or with different columns.",
        "Fit each joint by itself; give every file the same columns.";
    FILE_TOO_LARGE = "FRK-D019" Data "file too large",
        "A file that is small by nature, such as joint.toml or a model image, is far larger than it can be.",
        "The wrong file is named.",
        "Check the path.";
    BAD_IMAGE = "FRK-D020" Data "model image refused",
        "The `.frk` file is truncated, corrupted, of another version, too large or inconsistent.",
        "An interrupted copy, a text-mode transfer, or a newer trainer.",
        "Copy or fit the image again; `trainer show` prints the header of a good one.";
    BAD_URDF = "FRK-D021" Data "URDF cannot be used",
        "The URDF file is not valid XML, lacks the joint, or its links have no mass.",
        "A xacro file that has not been expanded, a joint of another name, or links for display only.",
        "Expand xacro first; name the joint under `[rigid_body] joint`; or give inertia and gravity yourself.";
    BAD_KEY = "FRK-D022" Data "key file cannot be used",
        "The key file does not hold 64 hexadecimal digits, which are the 32 bytes of a key.",
        "Another file is named, or the key was made in another form.",
        "`openssl rand -hex 32 > drive.key` makes one.";
    NOT_MEASURED = "FRK-D023" Data "torque was not measured",
        "The torque, force or current is zero in every row, the same in every row although the speed changes, or smaller than any number that a converter gives.",
        "A channel that was never connected or not enabled, a constant that stands for a missing signal, or the wrong column.",
        "Record the torque, or map its column in joint.toml.";
    WRONG_SIGN = "FRK-D024" Data "torque of the wrong sign",
        "As it is recorded, friction drives the joint: beside inertia, gravity, offset and recorded couplings, what is left of the torque has the direction opposite to the motion, inertia does not contradict it, and the actuator takes up energy all in all. Compensated in a drive, it would be positive feedback.",
        "A motor mounted the other way round, a torque that is that of the load on the motor, or a sign convention of the drive.",
        "Turn the sign in joint.toml: `[columns] torque = { name = \"torque_Nm\", unit = \"Nm\", scale = -1 }`. Where another joint or a load drives this one all the time, record it moving alone.";
    WRONG_UNIT = "FRK-D025" Data "position and velocity in different units",
        "The recorded velocity is the derivative of the position times the factor between two units (or the two have opposite directions), or gravity shows that a position in rad is in degrees. Which of the columns is wrong cannot be told; inertia, gravity and friction would all be wrong by that factor.",
        "Degrees, turns or rpm in a column that says rad or rad/s; a clock in ms, us or ns in a column that says s; a velocity on the motor side.",
        "Name the column by its real unit (`position_deg`, `time_ms`, `velocity_rpm`), or map it in joint.toml with `unit`, `side` and `scale`.";
    IMPLAUSIBLE_CLOCK = "FRK-D026" Data "clock in another unit",
        "The time advances by less than a microsecond a row, or by more than a second without a velocity that confirms it. No motion is sampled like that, and filters on that clock would be as long as memory is large.",
        "Milli-, micro- or nanoseconds in a column that says s, or a row counter in place of the time.",
        "Name the column by its real unit: `time_ms`, `time_us`, `time_ns`; a row counter has to be multiplied by the sample period.";
    LOST_SIGN = "FRK-D027" Data "torque without its sign",
        "The torque is never below zero, while one law describes it once every sample has the sign that the motion asks for: its size was recorded, not its direction.",
        "A drive that logs the magnitude of the current, a wattmeter, or an `abs` in the log.",
        "Log the signed current or torque. A constant load that keeps the torque above zero is told apart and is not meant.";
    BAD_MODEL_FILE = "FRK-D030" Data "simulator's model file cannot be used",
        "The file of `export --into` is not valid XML, lacks the joint, or does not say the inertia of its bodies.",
        "A xacro or a file with includes that has not been expanded, a joint of another name, or bodies that have their inertia from geometries.",
        "Name the joint by `--joint-name` as the file does; give `--inertia-of-model` where bodies have their inertia from geometries.";
    SEVERAL_JOINTS = "FRK-D040" Data "several joints",
        "The recording holds the states of several joints, and nothing says which of them is meant.",
        "A bag or a table of a whole arm: `/joint_states/elbow/position`, `/joint_states/wrist/position` and so on.",
        "Name the joint in joint.toml, `name = \"elbow\"`, or map its columns under `[columns]`.";
    CUT_SHORT = "FRK-D041" Data "file cut short",
        "The file ends before its own structure says that it ends.",
        "A copy or a recording that was interrupted.",
        "Copy the file again. Where the recording itself was interrupted, convert what is whole with the tool that wrote it.";
    DAMAGED = "FRK-D042" Data "damaged file",
        "The file contradicts its own format: lengths, types or checksums in it do not fit together.",
        "A transfer in text mode, a failing disk, or a file that only has the ending of this format.",
        "Copy the file again, or export it once more with the tool that wrote it.";
    FORMAT_NOT_READ = "FRK-D043" Data "format that is not read",
        "The file is of a format that this program does not read, or was built without.",
        "A bag in SQLite, MATLAB 7.3, HDF5, a spreadsheet, or a compression other than gzip.",
        "Convert it as the message says; CSV, NumPy, MATLAB 5 to 7, JSON, Parquet and MCAP are read.";
    BAD_TASKS = "FRK-D044" Data "list of tasks cannot be used",
        "A line of the list is not a task as `trainer plan` writes it.",
        "The wrong file is named, or the list was edited, cut short or sorted: line N has to be task N.",
        "Write the list again with `trainer plan`; results of tasks that are the same are kept.";
    SIMULATION_DIVERGED = "FRK-D045" Data "simulation diverged",
        "The simulation reaches a torque or a speed that is a hundred times that of the recording: it computes nothing about this joint.",
        "A time step that is too long for the controller or the friction, or a column in another unit.",
        "Halve the time step, take a softer controller or an implicit integrator; compare the units of both files.";
    BAD_BAM_FILE = "FRK-D046" Data "parameters of BAM cannot be used",
        "The JSON is no parameter file of Rhoban's BAM, or it lacks a parameter of its friction model or has one that no servo can have.",
        "Another JSON file, a file of another version of BAM, or one that was edited by hand.",
        "Take a file as BAM writes it (`params/ACTUATOR/m1.json` to `m6.json`); the message names the parameter.";
    NO_CLEAR_MOTION = "FRK-D047" Data "no motion keeps clear",
        "No posture or no motion of the arm within its limits was found in which its links keep the distance `clearance_m` from the obstacles of arm.toml, from what is fixed to the base and from each other. The message names the two that are too close most often.",
        "An obstacle in another frame than that of the robot's base, its whole edges given as halves or the other way round, narrow limits, a table that reaches into the mount of the arm, or a `link_radius_m` that is too large.",
        "Compare `centre_m` and `size_m` of the obstacle with the robot, widen `[limits]`, or lower `clearance_m` or `link_radius_m`.";
    NOT_IDENTIFIABLE = "FRK-N001" NotIdentifiable "not identifiable",
        "Two or more parameters change the prediction in the same way on this recording, or the law is worth no more on rows that it has not seen than a constant torque, a spring or Coulomb friction alone. No image is written; `--force` writes it all the same.",
        "One speed, one acceleration, a small range of positions, a single frequency, or a joint that does not slide.",
        "Excite more: several speeds, both directions, two frequencies, a range beyond +-60 degrees.";
    NOT_CONVERGED = "FRK-N002" NotIdentifiable "not converged",
        "The optimiser stopped before the gradient became small.",
        "A target that is almost all noise, or inputs that are collinear.",
        "Look at the report's residuals; fewer inputs or a cleaner recording usually help.";
    NOT_PHYSICAL = "FRK-N003" NotIdentifiable "not physical",
        "The law that the recording asks for has a negative inertia, or friction that drives the joint.",
        "A torque of the wrong sign, a column that is not what it is taken for, or a force from outside: a spring, another joint.",
        "Look at sign and columns. No image is written; `--force` writes it all the same.";
    DIVERGED = "FRK-N004" NotIdentifiable "simulation diverged",
        "The simulated joint left all bounds under the recorded commands.",
        "A gain, an inertia or a delay that is not that of the joint, a reference of the wrong sign or unit, or a position loop that is unstable with these constants.",
        "Check `[actuator]`, `[payload]` and `[rigid_body]` of joint.toml, and sign and unit of the reference.";
    NO_SCALE = "FRK-N005" NotIdentifiable "constant of the actuator not determined",
        "The recordings leave a constant of the actuator open: torque, inertia and friction may all be larger by the same factor, or two constants act alike.",
        "Neither torque constant nor gain is known, and no payload, inertia or gravity torque; or all recordings have one gain and one payload.",
        "Weigh the payload (`[payload] mass_kg, distance_m`), give a constant, or record a second time with another gain or payload and fit both.";
    INPUT_OUTPUT = "FRK-I001" InputOutput "file cannot be read or written",
        "The operating system refused to read or write a file.",
        "Missing rights, a full disk, or a device that went away.",
        "The message is that of the operating system. Nothing was left half written.";
    FILE_NOT_FOUND = "FRK-I002" InputOutput "no such file",
        "The file or the folder it should go into does not exist.",
        "A misspelt path, or a relative path from another folder.",
        "Check the path.";
    IS_A_DIRECTORY = "FRK-I003" InputOutput "a folder where a file is needed",
        "The path names a folder.",
        "A pattern that matched a folder, or a forgotten file name.",
        "Name the file inside the folder.";
    EMULATOR_MISSING = "FRK-I004" InputOutput "emulator not installed",
        "The program that emulates the target cannot be started.",
        "QEMU for this processor family is not installed.",
        "Install the package that the message names, or run tests/setup.sh of a checkout.";
    CROSS_TARGET_MISSING = "FRK-I005" InputOutput "cross target not installed",
        "The Rust compiler cannot build for the target's processor.",
        "The target's library was never added to the toolchain.",
        "`rustup target add` with the triple that the message names, or run tests/setup.sh of a checkout.";
    FIRMWARE_NOT_FOUND = "FRK-I006" InputOutput "firmware not found",
        "The firmware that runs an image on an emulated target is built from a checkout, and there is none around.",
        "The trainer was started outside a checkout.",
        "Change into a checkout, or name its `tests/firmware` in the environment variable FRIKAN_FIRMWARE.";
    FIRMWARE_BUILD = "FRK-I007" InputOutput "firmware cannot be built",
        "The compiler or the linker refused the firmware. A panic that has become reachable is refused by the linker.",
        "A change in the runtime, or a toolchain that is older than the workspace asks for.",
        "The message holds the compiler's own words.";
    EMULATION_FAILED = "FRK-I008" InputOutput "emulation failed",
        "The emulated drive did not answer, faulted, or refused the image.",
        "An image of another format version, or one larger than the target's room for cells.",
        "`trainer verify` without `--target` tells whether the image itself is sound.";
    USAGE = "FRK-U001" Usage "usage",
        "An argument is missing, unknown or contradicts another.",
        "A misspelt option, or options that exclude each other.",
        "`trainer <command> --help` lists what is understood.";
    UNKNOWN_INPUT = "FRK-U002" Usage "unknown input",
        "`--inputs` names a channel that no recording has.",
        "A misspelt name; channels that are not standard keep the name of their column.",
        "Use one of the names that the message lists.";
    UNKNOWN_TOPIC = "FRK-U003" Usage "nothing to explain",
        "`trainer explain` was given neither a code nor the name of an effect.",
        "A misspelt name.",
        "`trainer explain` without argument lists both.";
    UNKNOWN_TARGET = "FRK-U004" Usage "unknown target",
        "`--target` names a processor for which there is no firmware.",
        "A misspelt name.",
        "Use one of the names that the message lists.";
    UNSUITABLE_FORM = "FRK-U005" Usage "form does not suit the model",
        "The form that `--to` names cannot hold what is in this image.",
        "A model with correction terms or with a network, exported to a form that has neither memory nor tables of tables.",
        "Take `bin`, `hex`, `uf2`, `elf` or `c-header`, which hold every image, and the library on the drive.";
    REPEATED_ROWS = "FRK-W001" Warning "rows written twice",
        "Rows that have the stamp of the row before, or that repeat position, velocity and torque of the row before while the joint moves, say nothing new. They were left out.",
        "A logger that writes the last message again when no new one has come, a clock that is coarser than the sampling, or messages that arrive twice.",
        "Nothing has to be done where they are few. A clock with more digits keeps rows of one stamp apart.";
    HELD_SAMPLES = "FRK-W002" Warning "samples held for several rows",
        "A channel is new only every so many rows, however fast the joint moves. Between them the recording says nothing: the rows in which it is new were used, at their own rate.",
        "A sensor or a field bus that is slower than the log, or a log that was resampled without interpolation.",
        "Record at the rate of the slowest channel, or make the sensor as fast as the log. Fast effects cannot be seen behind the lower rate.";
    WRAPPED_POSITION = "FRK-W003" Warning "position that starts anew after a turn",
        "The position jumps by a whole turn of the encoder while the motion goes on. The turns were put together again.",
        "A single-turn encoder, or an angle that is normalised to 0..360 or -180..180 degrees.",
        "Nothing has to be done. Above half a turn from one row to the next the direction could not be told.";
    REZEROED_POSITION = "FRK-W004" Warning "position set anew in the run",
        "The position jumps once, further than the joint can move in a row, while the motion before and after goes on. What follows was shifted back and the motion is taken as interrupted there; the zero is that of the beginning.",
        "A homing or zeroing command in the run, a drive that was restarted, or two recordings joined in one file.",
        "Where the later zero is the right one, cut the recording there: gravity depends on it.";
    FROZEN_TORQUE = "FRK-W005" Warning "torque stands still while the joint moves",
        "The torque is exactly zero, or exactly the same, for many rows in which the joint moves and its other rows say that the torque had to change. These rows were left out.",
        "A channel that dropped out, a field bus that lost its connection, or a sensor that was being zeroed.",
        "Record again where it is much of the recording. A torque that stands at a limit, or a drive that is switched off and coasts, is not meant.";
    TURNED_TORQUE = "FRK-W006" Warning "torque with the sign turned for a while",
        "In one stretch the torque is the negative of what all other rows say of the same joint. The stretch was left out.",
        "A drive whose direction was changed in the run, or recordings of two conventions joined in one file.",
        "Cut the recording there, or turn the sign of the stretch before it is used.";
    CONTRADICTING_VELOCITY = "FRK-W007" Warning "velocity that contradicts the position",
        "The recorded velocity is not the derivative of the position: it does not change, comes late, has another scale or nothing to do with it. It was left out, and the position is differentiated.",
        "A channel that is not filled, a slow filter in the drive, a velocity on the motor side, or the velocity of another joint.",
        "Nothing has to be done where the position is good. Otherwise map the right column in joint.toml, with its unit and side.";
    ONE_DIRECTION = "FRK-W008" Warning "motion in one direction only",
        "The joint never turns round. A Coulomb torque in one direction cannot be separated from an offset, nor from a constant load.",
        "A conveyor, a spindle, or an excerpt of a longer motion.",
        "Record both directions. What is found holds for the recorded direction only.";
    SIGN_BIT = "FRK-W009" Warning "sign read as a digit",
        "The numbers of a channel jump by a power of two of their own step whenever they pass zero: negative ones were read as large positive ones. They were put back.",
        "A register of sign and magnitude, or of two's complement, that was read as a number without a sign.",
        "Nothing has to be done. Reading the register with its sign saves the detour.";
    CLOCK = "FRK-W010" Warning "clock",
        "Rows, rate and jitter of the clock. A jitter of more than half a period is told as a warning: values are then interpolated further than they lie apart.",
        "A log that is written when the computer has time, or stamps of arrival in place of stamps of measurement.",
        "Log the time at which each value was measured, by the clock of the drive.";
    GAPS = "FRK-W011" Warning "gaps of the clock",
        "The clock jumps by more than three periods. The motion is taken as interrupted there: no filter reaches across.",
        "Messages that were lost, pauses between strokes, or several runs in one file.",
        "Nothing has to be done where the stretches between are longer than a second.";
    RESOLUTION = "FRK-W012" Warning "resolution of a channel",
        "The step in which a channel is recorded, told apart from what it travels from row to row, and how many of them its range has. Fewer than 256 are told as a warning.",
        "A coarse encoder or converter, few digits in the log, or a range that is much larger than what was used.",
        "More digits in the log, or a motion that uses more of the range.";
    CONSTANT_CHANNEL = "FRK-W013" Warning "channel that never changes",
        "Every row of a channel has the same value: nothing that depends on it can be seen.",
        "A sensor that is not connected, a channel that is not enabled, or a quantity that was held on purpose.",
        "Connect or enable it, leave the column out, or change it in another recording.";
    AT_LIMIT = "FRK-W014" Warning "actuator at its limit",
        "The actuator stands exactly at its largest or smallest value in many rows: the drive gave no more there, or the converter could not show more.",
        "A limit of torque or current, or a converter at the end of its range.",
        "Accelerate less, or raise the limit. State the drive's limit in joint.toml: `[drive] torque_limit_Nm`.";
    MOTION = "FRK-W015" Warning "motion",
        "What was driven: travel, top speed, shares of the time at rest and in slow motion, and how often the joint turns round. A joint that never turns round is told as a warning.",
        "A conveyor, a spindle, or an excerpt of a longer motion.",
        "Friction over speed wants several speeds in both directions; effects near rest want reversals and slow motion.";
    TEMPERATURE_RANGE = "FRK-W016" Warning "temperature",
        "The range of the temperature. Less than 5 K are told as a warning: what friction does over temperature can then not be seen.",
        "A recording that is short, or that was taken after the joint had warmed up.",
        "Record the same motion cold and warm.";
    UNIDENTIFIED = "FRK-W017" Warning "cannot be identified",
        "By the Fisher information of the recording, what this constant or effect adds to the torque may be off by as much as all the friction there is: others make up for it, or the noise hides it.",
        "One speed, one direction, a joint that does not slide, a channel that hardly changes.",
        "Record what the message asks for.";
    ACTUATOR_TORQUE = "FRK-W018" Warning "torque of the actuator",
        "The joint reports no torque: what its actuator makes of its commands by `[actuator]` of joint.toml stands for it, with the constants that are told.",
        "A servo, or a joint under a PD command, a current, a duty or a voltage.",
        "Nothing has to be done. A wrong constant shows as a wrong torque: docs/servos.md.";
    NEARLY_NAMED = "FRK-W020" Warning "column that nearly has a known name",
        "A column has almost the name of a quantity that no other column gives. It is kept as a channel by its name.",
        "A slip of the pen, capitals, or a missing `_`.",
        "Rename the column as the message says, or map it under `[columns]` of joint.toml.";
    UNKNOWN_KEY = "FRK-W021" Warning "unknown key of joint.toml",
        "joint.toml has a table or key that no command reads.",
        "A slip of the pen, or a key of another version.",
        "Correct it as the message says, or remove it.";
}

#[cfg(test)]
mod tests;
