#!/bin/bash
# Runs the archive in a bare Debian 12 that has no network: packaging/try_archive.sh ARCHIVE.tar.xz
# Needs root and debootstrap; the bare system is fetched from a mirror of Debian, the archive is
# not. BARE_DEBIAN names the folder of a bare system that is there already.
set -euo pipefail
archive=$(readlink -f "$1")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
if [[ -z ${BARE_DEBIAN:-} ]]; then
  debootstrap --variant=minbase bookworm "$scratch/debian" >/dev/null
  BARE_DEBIAN=$scratch/debian
fi
mkdir "$scratch/bare"
cp --archive "$BARE_DEBIAN/." "$scratch/bare"
mkdir "$scratch/bare/try"
tar --extract --directory "$scratch/bare/try" --file "$archive"

# Every part that has libraries of its own is tried: repair, pictures, plots, clips, the second
# plant.
unshare --net --pid --fork --mount --mount-proc="$scratch/bare/proc" \
  chroot "$scratch/bare" /usr/bin/env -i /bin/sh -eu <<'END'
cd /try
ayumi=$(echo /try/ayumi-*/bin/ayumi) share=$(echo /try/ayumi-*/share/ayumi)
ln -s "$ayumi" /usr/bin/ayumi
export HOME=/try PATH=/usr/bin:/bin
! command -v ffmpeg fc-list python3 || { echo "this Debian is not bare"; exit 1; }
ayumi --version
ayumi robots
ayumi check "$share/patterns/hoap1_walk.json"
ayumi new sway -o sway.json
ayumi edit retime sway.json --scale 0.27 -o fast.json >/dev/null || [ $? -eq 1 ]  # inconsistent
ayumi repair fast.json -o repaired.json
ayumi run sway.json --no-pictures -o run
ayumi preview run -o run.mp4
ayumi preview run -o run.png
ayumi plot run -o run.svg
ayumi plot run -o plot.png
ayumi report run -o run.html
ayumi inspect hoap1 --picture hoap1.png >/dev/null
ayumi simulate sway.json --plant mujoco -o mujoco
ls -l run.mp4 run.png run.svg plot.png run.html hoap1.png
END
echo "$(basename "$archive") runs in a bare Debian 12 without network"
