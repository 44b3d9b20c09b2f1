#!/usr/bin/env bash
# Counts the instructions of fixed steps, and fails if one takes 1 % more than benchmarks/instructions.txt says: a gate that no
# noise of the machine can trip. Needs valgrind (which has no AVX-512; the kernels stop at AVX2 anyway).
#
#     benchmarks/count_instructions.sh            compare
#     benchmarks/count_instructions.sh --record   write the file anew, after a change that is meant
set -euo pipefail
cd "$(dirname "$0")/.."

command -v valgrind >/dev/null || { echo "valgrind is not installed (Debian: apt-get install valgrind)" >&2; exit 2; }
cargo build --release -p pliant-bench --example windows
program=${CARGO_TARGET_DIR:-target}/release/examples/windows
recorded=benchmarks/instructions.txt
found=$(mktemp)
trap 'rm -f "$found"' EXIT

# What each asks is in crates/pliant-bench/examples/windows.rs. `double` is a body with itself in f64; `two` and `four` are degrees; `star` is a body with itself, those that share a vertex too.
for window in deepest cloth small crowd contacts near close meet earliest apart double two four star edges; do
    # Only what the library does between the call that brings positions and the answer.
    count=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null \
        --toggle-collect='windows::one_step' \
        "$program" "$window" --rounds 1 2>&1 >/dev/null | sed -n 's/.*Collected : \([0-9]*\)$/\1/p')
    [[ $count -gt 0 ]] || { echo "$window: nothing was counted; do the functions have other names?" >&2; exit 2; }
    printf '%-8s %12d\n' "$window" "$count"
done | tee "$found"

if [[ ${1:-} == --record ]]; then
    cp "$found" "$recorded"
    exit
fi
awk 'NR == FNR { was[$1] = $2; next }
     { change = 100 * ($2 / was[$1] - 1); printf "%-8s %+.2f %%\n", $1, change; if (change > 1) failed = 1 }
     END { if (failed) print "more than 1 % above benchmarks/instructions.txt"; exit failed }' "$recorded" "$found"
