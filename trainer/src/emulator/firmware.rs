//! Finds the firmware's sources and builds them for a target.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::error::{Error, Result, codes};

use super::target::Target;

/// Environment variable that names the firmware folder.
pub const FIRMWARE_VARIABLE: &str = "FRIKAN_FIRMWARE";

/// The package of the firmware that carries a model.
const MODEL_PACKAGE: &str = "frikan-firmware";

/// Where the firmware lies in a checkout.
const FOLDER_IN_CHECKOUT: &str = "tests/firmware";

/// The firmware's sources.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Firmware {
    folder: PathBuf,
    /// Features of what is built; those that it has by default where none are named.
    features: Option<String>,
}

/// The firmware folder: `FRIKAN_FIRMWARE`, or `tests/firmware` of the checkout around the current directory, or of that which this program was built
/// from.
///
/// # Errors
/// `FRK-I006` where there is none.
pub fn firmware_folder() -> Result<PathBuf> {
    let is_firmware = |folder: &PathBuf| folder.join("targets").is_dir() && folder.join("Cargo.toml").is_file();
    if let Some(folder) = env::var_os(FIRMWARE_VARIABLE) {
        let folder = PathBuf::from(folder);
        return Some(&folder).filter(|folder| is_firmware(folder)).cloned().ok_or_else(|| {
            let message = format!("{FIRMWARE_VARIABLE} does not name the folder of the firmware");
            Error::new(&codes::FIRMWARE_NOT_FOUND, message).with_value(folder.display().to_string())
        });
    }
    let here = env::current_dir().map_err(|error| Error::from_io(Path::new("."), &error))?;
    // The checkout that this program was built from is the parent folder of its package.
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).parent();
    let folders = here.ancestors().chain(sources).map(|folder| folder.join(FOLDER_IN_CHECKOUT));
    folders.into_iter().find(is_firmware).ok_or_else(|| {
        let message = format!(
            "no firmware to run: the checkout that this program was built from is gone; start inside another, or name its \
             {FOLDER_IN_CHECKOUT} in {FIRMWARE_VARIABLE}"
        );
        Error::new(&codes::FIRMWARE_NOT_FOUND, message)
    })
}

impl Firmware {
    /// The firmware of [`firmware_folder`].
    ///
    /// # Errors
    /// As [`firmware_folder`].
    pub fn find() -> Result<Self> {
        Ok(Self { folder: firmware_folder()?, features: None })
    }

    /// The same firmware with these features alone, separated by commas; it is built beside the others.
    #[must_use]
    pub fn with_features(&self, features: &str) -> Self {
        Self { features: Some(features.to_owned()), ..self.clone() }
    }

    /// Names of the targets.
    ///
    /// # Errors
    /// `FRK-I001` to `FRK-I003` where the folder cannot be read.
    pub fn target_names(&self) -> Result<Vec<String>> {
        Target::names(&self.folder)
    }

    /// A target by its name.
    ///
    /// # Errors
    /// `FRK-U004` for an unknown name.
    pub fn target(&self, name: &str) -> Result<Target> {
        Target::read(&self.folder, name)
    }

    /// Builds a binary for a target, if it is not up to date, and returns the path of its ELF file.
    ///
    /// # Errors
    /// `FRK-I005` where the cross target is not installed, `FRK-I007` where the build fails.
    pub fn build(&self, target: &Target, binary: &str) -> Result<PathBuf> {
        let mut flags = target.rustflags.clone();
        flags.push(format!("-Clink-arg=-Ltargets/{}", target.name));
        let mut arguments = vec!["build", "--release", "--bin", binary];
        if let Some(features) = &self.features {
            arguments.extend(["--package", MODEL_PACKAGE, "--no-default-features", "--features", features]);
        }
        let folder = self.cargo(&self.folder, target, &flags, &arguments)?;
        Ok(folder.join("release").join(binary))
    }

    /// Checks a package of the workspace for a target with these features alone, separated by commas.
    ///
    /// # Errors
    /// As [`Firmware::build`].
    pub fn check(&self, target: &Target, package: &str, features: &str) -> Result<()> {
        let arguments = ["check", "--package", package, "--no-default-features", "--features", features];
        // What is only checked is no part of a program.
        let checked = self.with_features("checked");
        checked.cargo(&self.folder.join("../.."), target, &[], &arguments).map(|_| ())
    }

    /// Builds the static library for C for a target, if it is not up to date, and returns its path. Its features are those of the library.
    ///
    /// # Errors
    /// As [`Firmware::build`].
    pub fn build_c_library(&self, target: &Target) -> Result<PathBuf> {
        // Flags that concern the linker belong to the firmware that the library goes into.
        let is_for_compiler = |flag: &&String| flag.starts_with("target-cpu");
        let processor = target.rustflags.iter().find(is_for_compiler).map(|processor| format!("-C{processor}"));
        let mut arguments = vec!["rustc", "--package", "frikan-c", "--profile", "drive", "--crate-type", "staticlib"];
        if let Some(features) = &self.features {
            arguments.extend(["--no-default-features", "--features", features]);
        }
        let folder = self.cargo(&self.folder.join("../.."), target, processor.as_slice(), &arguments)?;
        Ok(folder.join("drive").join("libfrikan.a"))
    }

    /// Runs cargo in `folder` for a target and returns the folder of what it built.
    fn cargo(&self, folder: &Path, target: &Target, flags: &[String], arguments: &[&str]) -> Result<PathBuf> {
        let toolchain = Toolchain::find(target)?;
        // A program has one place in its folder, whatever its features.
        let features = self.features.as_deref().map_or(String::new(), |features| format!("-{features}"));
        let target_folder = self.folder.join("target").join(format!("{}{features}", target.name));
        let flags = [flags, &toolchain.flags(target)].concat();

        let mut cargo = Command::new(&toolchain.cargo);
        cargo.current_dir(folder).args(arguments).arg("--locked");
        cargo.args(["--target", &target.triple]).arg("--target-dir").arg(&target_folder);
        cargo.args(toolchain.arguments());
        cargo.env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"));
        // A build that is started from a build or a test must not take over its wrapper or its flags.
        for variable in ["RUSTC_WRAPPER", "RUSTC_WORKSPACE_WRAPPER", "CARGO_BUILD_TARGET", "CARGO_MAKEFLAGS"] {
            cargo.env_remove(variable);
        }
        cargo.envs(toolchain.environment().iter().copied());
        let output = cargo.output().map_err(|error| {
            let message = format!("cargo cannot be started: {error}");
            Error::new(&codes::FIRMWARE_BUILD, message).with_value(toolchain.cargo.to_string_lossy())
        })?;
        if !output.status.success() {
            let message = format!(
                "the firmware cannot be built for {} ({}):\n{}",
                target.name,
                output.status,
                String::from_utf8_lossy(&output.stderr).trim_end()
            );
            return Err(Error::new(&codes::FIRMWARE_BUILD, message));
        }
        Ok(target_folder.join(&target.triple))
    }
}

/// The compiler that builds the firmware.
struct Toolchain {
    cargo: OsString,
    /// Build `core` from its sources and link with GCC: Debian's compiler has no cross targets, but its sources.
    from_source: bool,
}

/// Where Debian keeps its compiler, apart from rustup's.
const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_CARGO: &str = "/usr/bin/cargo";

impl Toolchain {
    /// The compiler in use where it has the target, else Debian's where it has the sources of the library.
    fn find(target: &Target) -> Result<Self> {
        let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
        if printed_path(&rustc, &["--print", "target-libdir", "--target", &target.triple])
            .is_some_and(|path| path.is_dir())
        {
            return Ok(Self { cargo: env::var_os("CARGO").unwrap_or_else(|| "cargo".into()), from_source: false });
        }
        let sources = printed_path(DEBIAN_RUSTC.as_ref(), &["--print", "sysroot"])
            .map(|sysroot| sysroot.join("lib/rustlib/src/rust/library/core"));
        let linker = target.gcc.first().is_some_and(|gcc| Command::new(gcc).arg("--version").output().is_ok());
        if sources.is_some_and(|path| path.is_dir()) && Path::new(DEBIAN_CARGO).is_file() && linker {
            return Ok(Self { cargo: DEBIAN_CARGO.into(), from_source: true });
        }
        let message = format!(
            "the compiler has no target {0}: install it with `rustup target add {0}`, or everything with tests/setup.sh",
            target.triple
        );
        Err(Error::new(&codes::CROSS_TARGET_MISSING, message))
    }

    fn flags(&self, target: &Target) -> Vec<String> {
        let Some((linker, arguments)) = target.gcc.split_first().filter(|_| self.from_source) else {
            return Vec::new();
        };
        let link_arguments = arguments.iter().map(String::as_str).chain(["-nostartfiles", "-nostdlib"]);
        let link_arguments = link_arguments.map(|argument| format!("-Clink-arg={argument}"));
        std::iter::once(format!("-Clinker={linker}")).chain(link_arguments).collect()
    }

    fn arguments(&self) -> &'static [&'static str] {
        if self.from_source { &["-Zbuild-std=core"] } else { &[] }
    }

    fn environment(&self) -> &'static [(&'static str, &'static str)] {
        if self.from_source { &[("RUSTC", DEBIAN_RUSTC), ("RUSTC_BOOTSTRAP", "1")] } else { &[] }
    }
}

/// The path that a compiler prints, if it runs.
fn printed_path(rustc: &std::ffi::OsStr, arguments: &[&str]) -> Option<PathBuf> {
    let output = Command::new(rustc).args(arguments).output().ok()?;
    output.status.success().then(|| PathBuf::from(String::from_utf8_lossy(&output.stdout).trim()))
}
