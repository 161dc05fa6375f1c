//! Asks the linker for a small program, where the compiler's own linker builds it for this machine.

use std::env;
use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if is_release_for_this_machine() && is_own_linker() {
        // Functions of the same machine code are one function.
        println!("cargo::rustc-link-arg-bins=-Wl,--icf=all");
        if !is_glibc_before(2, 36) {
            // Addresses that are moved when the program starts are listed in a fraction of the room.
            println!("cargo::rustc-link-arg-bins=-Wl,-z,pack-relative-relocs");
        }
    }
}

/// Whether a release is built that is not to be shipped, for Linux on the same kind of machine, with no linker chosen by hand.
fn is_release_for_this_machine() -> bool {
    let is = |key: &str, value: &str| env::var(key).is_ok_and(|found| found == value);
    let flags = env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default();
    is("PROFILE", "release")
        && is("DEBUG", "false")
        && is("TARGET", "x86_64-unknown-linux-gnu")
        && is("HOST", "x86_64-unknown-linux-gnu")
        && env::var_os("RUSTC_LINKER").is_none()
        && !flags.contains("link")
}

/// Whether the compiler brings its own linker, which it uses then; linkers of others lack these options.
fn is_own_linker() -> bool {
    let Some(compiler) = env::var_os("RUSTC") else { return false };
    let Ok(found) = Command::new(compiler).args(["--print", "sysroot"]).output() else {
        return false;
    };
    let root = String::from_utf8_lossy(&found.stdout);
    let tools = Path::new(root.trim()).join("lib/rustlib/x86_64-unknown-linux-gnu/bin");
    tools.join("gcc-ld/ld.lld").exists()
}

/// Whether the C library of this machine is older; also where its version is not known.
fn is_glibc_before(major: u32, minor: u32) -> bool {
    let Ok(found) = Command::new("getconf").arg("GNU_LIBC_VERSION").output() else { return true };
    let text = String::from_utf8_lossy(&found.stdout);
    let version = text.trim().rsplit(' ').next().and_then(|version| version.split_once('.'));
    let numbers = version.and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
    numbers.is_none_or(|numbers: (u32, u32)| numbers < (major, minor))
}
