#!/bin/bash
# Strips and loci in the manner of Figs. 7 and 8 of the paper: VIIP shifts the weight of HOAP-1 on both
# feet, steps in place under a push, and walks. Needs the program: build it first (quickstart.sh).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
ayumi=${AYUMI:-build/release/app/ayumi}
if [ ! -x "$ayumi" ]; then
  echo "$ayumi is not there: run examples/quickstart.sh first, or set AYUMI" >&2
  exit 3
fi

out=${1:-out}
for name in hoap1_viip_shift hoap1_viip_step hoap1_viip_walk; do
  run=$out/$name
  "$ayumi" run "patterns/$name.json" -o "$run" --force
  # Against time: COG, ref ZMP and ZMP in the frame of the feet. From above: with the footholds.
  "$ayumi" --force plot "$run" --log closed_loop -o "$run/fig8_loci.svg"
  "$ayumi" --force plot "$run" --log closed_loop --top -o "$run/top.png"
done
echo "Figures in $out/hoap1_viip_shift, hoap1_viip_step and hoap1_viip_walk"
