#!/bin/bash
# Figs. 3 and 4 of the paper: snapshots of HOAP-1, which is pushed while it walks, and curves of its
# COG along x, y and z, with and without control. The variable AYUMI names the program. Its default is
# the program that examples/quickstart.sh builds.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

ayumi=${AYUMI:-build/release/app/ayumi}
if [ ! -x "$ayumi" ]; then
  echo "$ayumi is not there: run examples/quickstart.sh first, or set AYUMI" >&2
  exit 3
fi
out=${1:-out/paper_fig3_4}
mkdir -p "$out"
status=0
"$ayumi" run patterns/hoap1_walk.json -o "$out/run" --no-pictures --force || status=$?
[ "$status" -le 1 ] || exit "$status"
"$ayumi" preview "$out/run" --log closed_loop --strip 8 --size 400x600 \
  -o "$out/fig3_snapshots.png" --force
"$ayumi" plot "$out/run" -o "$out/fig4_loci.svg" --force \
  --title "HOAP-1 walking, pushed to the left at 3 s: open loop and DTAD"
"$ayumi" plot "$out/run" --top -o "$out/fig4_from_above.svg" --force
echo "written: $out/fig3_snapshots.png, fig4_loci.svg, fig4_from_above.svg"
exit "$status"
