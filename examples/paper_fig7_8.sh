#!/bin/bash
# Strips and loci in the manner of Figs. 7 and 8 of the paper: VIIP shifts the weight of HOAP-1 on both
# feet, steps in place under a push, and walks. Needs the program: build it first (quickstart.sh).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
ayumi=${AYUMI:-build/release/app/ayumi}

for name in hoap1_viip_shift hoap1_viip_step hoap1_viip_walk; do
  out=out/$name
  "$ayumi" run "patterns/$name.json" -o "$out" --force
  # Against time: COG, ref ZMP and ZMP in the frame of the feet. From above: with the footholds.
  "$ayumi" --force plot "$out" --log closed_loop -o "$out/loci.svg"
  "$ayumi" --force plot "$out" --log closed_loop --top -o "$out/top.png"
done
