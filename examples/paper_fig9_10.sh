#!/bin/bash
# The jump of HOAP-1, Figs. 9 and 10 of the paper: a strip of snapshots, the curves of COG and ZMP, and
# a clip of the same time at a fifth of the speed. The program must be built before. The variable AYUMI
# names it. Its default is build/release/app/ayumi.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

ayumi=${AYUMI:-build/release/app/ayumi}
if [ ! -x "$ayumi" ]; then
  echo "$ayumi is not there: run examples/quickstart.sh first, or set AYUMI" >&2
  exit 3
fi
out=${1:-out/hoap1_jump}
"$ayumi" simulate patterns/hoap1_jump.json -o "$out" --force
"$ayumi" plot "$out" -o "$out/fig10_loci.svg" --force
"$ayumi" preview "$out" -o "$out/fig9_snapshots.png" --strip 12 --from 1.0 --to 1.77 --columns 6 --view side \
  --size 320x360 --force
"$ayumi" preview "$out" -o "$out/jump.mp4" --from 1.0 --to 1.77 --speed 0.2 --force
echo "Figures in $out"
