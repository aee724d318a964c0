#!/bin/bash
# The jump of HOAP-1, figures 9 and 10 of the paper: a strip of snapshots, the loci of COG and ZMP,
# and a clip at a fifth of the speed. Needs a built program: AYUMI, or build/release/app/ayumi.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

ayumi=${AYUMI:-build/release/app/ayumi}
out=${1:-out/hoap1_jump}
"$ayumi" simulate patterns/hoap1_jump.json -o "$out" --force
"$ayumi" plot "$out" -o "$out/fig10_loci.svg" --force
"$ayumi" preview "$out" -o "$out/fig9_snapshots.png" --force
"$ayumi" preview "$out" -o "$out/jump.mp4" --speed 0.2 --force
echo "Figures in $out"
