//! Compiles the calls into Draco, if they are asked for.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "draco")]
    draco();
}

/// Compiles `src/codecs/draco.cpp` and links the installed library.
#[cfg(feature = "draco")]
fn draco() {
    const SOURCE: &str = "src/codecs/draco.cpp";
    println!("cargo::rerun-if-changed={SOURCE}");

    let mut build = cc::Build::new();
    build.cpp(true).std("c++17").file(SOURCE);
    if build.try_expand().is_err() {
        println!(
            "cargo::error=the feature `draco` needs a C++ compiler and the headers of Draco: install \
             Debian's package libdraco-dev, or build without the feature"
        );
        return;
    }
    build.compile("compare_draco");
    println!("cargo::rustc-link-lib=draco");
}
