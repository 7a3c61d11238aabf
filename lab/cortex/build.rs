//! Tells the linker where the memory map is: it starts in the folder of the workspace, not in that of this package.

fn main() {
    println!("cargo:rerun-if-changed=memory.x");
    println!("cargo:rustc-link-search={}", env!("CARGO_MANIFEST_DIR"));
}
