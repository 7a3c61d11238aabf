#!/usr/bin/env bash
# Measures time and memory of rustc for the forward dynamics of a description, in release and dev profiles.
#
#     lab/compile.sh FILE.eom
#
# Only the forward dynamics: FILE must contain `generate accel;`. `HAMEL` is the path of the command `hamel`.
set -euo pipefail
file=$(realpath "$1")
cd "$(dirname "$0")/.."
hamel=${HAMEL:-target/release/hamel}
out="$PWD/target/compile"
mkdir -p "$out/src"

"$hamel" emit "$file" > "$out/src/model.rs"
name=$(grep -o 'pub struct [A-Za-z0-9_]*<S>' "$out/src/model.rs" | sed 's/pub struct //; s/<S>//')
# A generic function is compiled when its address is taken.
signature=$(sed -n '/pub fn accel(/,/{$/p' "$out/src/model.rs" | tr -d '\n' |
    sed -E "s/.*\(/fn(/; s/&self/\&$name<f64>/; s/[a-z_]+: &/\&/g; s/\bS\b/f64/g; s/,( *)\)/)/; s/ *\{ *$//")
printf 'include!("model.rs");\npub static ACCEL: %s = %s::accel;\n' "$signature" "$name" > "$out/src/lib.rs"
cat > "$out/Cargo.toml" <<END
[package]
name = "compiled"
version = "0.0.0"
edition = "2024"
[workspace]
[dependencies]
hamel = { path = "../../runtime", default-features = false, features = ["std"] }
END
grep -c 'let ' "$out/src/model.rs" | sed 's/$/ statements/'
for profile in release dev; do
    build=(cargo build --quiet --profile "$profile" --manifest-path "$out/Cargo.toml" --target-dir "$out/rust")
    "${build[@]}"
    touch "$out/src/lib.rs"
    python3 - "$profile" "${build[@]}" <<'END'
import resource, subprocess, sys
subprocess.run(sys.argv[2:], check=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(f"{sys.argv[1]}: {used.ru_utime:.1f} s of the processor, {used.ru_maxrss / 1024:.0f} MB")
END
done
