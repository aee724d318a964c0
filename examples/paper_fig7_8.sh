#!/bin/bash
# Figs. 7, 8 and 11 of the paper, with its robot of 30 degrees of freedom. VIIP shifts the weight on both
# feet, steps in place under a push, and walks. The program must be built before (quickstart.sh).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
ayumi=${AYUMI:-build/release/app/ayumi}
if [ ! -x "$ayumi" ]; then
  echo "$ayumi is not there: run examples/quickstart.sh first, or set AYUMI" >&2
  exit 3
fi

out=${1:-out}
for name in humanoid30_viip_shift humanoid30_viip_step humanoid30_viip_walk; do
  run=$out/$name
  "$ayumi" run "patterns/$name.json" -o "$run" --no-pictures --force
  "$ayumi" --force preview "$run" --log closed_loop --strip 8 -o "$run/fig7_snapshots.png"
  # One plot over time: COG, reference ZMP and ZMP in the frame of the feet. One plot from above, with
  # the footholds.
  "$ayumi" --force plot "$run" --log closed_loop -o "$run/fig8_loci.svg"
  "$ayumi" --force plot "$run" --log closed_loop --top -o "$run/top.png"
done
"$ayumi" --force inspect humanoid30 --picture "$out/fig11_robot.png"
echo "Figures in $out: fig11_robot.png, humanoid30_viip_shift, humanoid30_viip_step and humanoid30_viip_walk"
