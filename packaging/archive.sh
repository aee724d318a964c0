#!/bin/bash
# Makes ayumi-VERSION-linux-x86_64.tar.xz from an installation: packaging/archive.sh PREFIX OUT_FOLDER
# The archive has the program, the bundled data, every shared library that a bare Debian 12 may lack,
# the fonts, and ffmpeg. It runs from any folder without being installed:
#   tar -xf ayumi-*.tar.xz && ayumi-*/bin/ayumi --help
# XZ_OPT holds the options of xz in place of -T0 -1; -9 makes the archive smaller and takes longer.
# With COMPRESS=cat it is a plain .tar, which is made in a twentieth of the time.
# packaging/try_archive.sh tries the archive.
set -euo pipefail
prefix=$(cd "$1" && pwd)
out=$(mkdir -p "$2" && cd "$2" && pwd)
version=$("$prefix/bin/ayumi" --version | sed -E 's/^ayumi ([0-9]+\.[0-9]+).*/\1/')
name=ayumi-$version-linux-$(uname -m)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
root=$tree/$name
mkdir -p "$root"/{bin,lib/ayumi,share}

cp -r "$prefix/share/." "$root/share/"
programs=("$prefix/bin/ayumi" "$prefix/libexec/ayumi/ayumi-mesh-reader")
if command -v ffmpeg >/dev/null; then programs+=("$(command -v ffmpeg)"); fi
cp "${programs[@]}" "$root/lib/ayumi/"
strip "$root/lib/ayumi/ayumi" "$root/lib/ayumi/ayumi-mesh-reader"

# All libraries below the programs except those of libc, which belong to the kernel and the loader.
# OSMesa is only loaded for the first picture.
osmesa=$(/sbin/ldconfig -p | awk '$1 ~ /^libOSMesa\.so\./ && !found++ { print $NF }')
libc='/(ld-linux[^/]*|lib(c|m|dl|rt|pthread|resolv|util|nsl|anl|mvec|BrokenLocale)\.so\.[0-9]+)$'
listed=$(ldd "${programs[@]}" $osmesa | awk '$2 == "=>" && $3 ~ /^\// { print $3 }')
mapfile -t libraries < <(printf '%s\n' "$listed" $osmesa | sort -u | grep -Ev "$libc")
cp -L "${libraries[@]}" "$root/lib/"
# The Debian licences of the copied files. dpkg also knows a file below /usr/lib by its place in
# /lib.
mkdir -p "$root/share/doc/ayumi/libraries"
declare -A package_of  # "zlib1g:amd64: /lib/x86_64-linux-gnu/libz.so.1.2.13"
while IFS= read -r line; do package_of[${line#*: }]=${line%%:*}; done < <(
  readlink -f "${libraries[@]}" | sed 'p; s|^/usr||' | xargs dpkg-query --search 2>/dev/null)
for library in "${libraries[@]}"; do
  file=$(readlink -f "$library")
  package=${package_of[$file]:-${package_of[${file#/usr}]:-}}
  notice=/usr/share/doc/$package/copyright
  if [[ -z $package || ! -e $notice ]]; then
    echo "$library: no package of Debian states its licence; install the library from Debian" >&2
    exit 1
  fi
  cp -L "$notice" "$root/share/doc/ayumi/libraries/$package"
done

# The font of pictures and plots, and a configuration by which fontconfig finds it.
mkdir -p "$root/share/fonts"
cp /usr/share/fonts/truetype/dejavu/DejaVuSans{,-Bold}.ttf "$root/share/fonts/"
cp -L /usr/share/doc/fonts-dejavu-core/copyright "$root/share/doc/ayumi/libraries/fonts-dejavu-core"
cat > "$root/share/fonts/fonts.conf" <<'CONF'
<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "urn:fontconfig:fonts.dtd">
<fontconfig>
  <dir prefix="relative">.</dir>
  <dir>/usr/share/fonts</dir>
  <cachedir prefix="xdg">fontconfig</cachedir>
</fontconfig>
CONF

cat > "$root/bin/ayumi" <<'RUN'
#!/bin/sh
# Starts Ayumi with the libraries, the fonts and the ffmpeg of this folder.
here=$(dirname "$(readlink -f "$0")")/..
LD_LIBRARY_PATH=$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
# This ffmpeg comes first in PATH: another one would be started with libraries that are not its own.
PATH=$here/lib/ayumi:$PATH
FONTCONFIG_FILE=${FONTCONFIG_FILE:-$here/share/fonts/fonts.conf}
export LD_LIBRARY_PATH PATH FONTCONFIG_FILE
exec "$here/lib/ayumi/ayumi" "$@"
RUN
chmod 755 "$root/bin/ayumi"

# If ONLY is set, only this folder is packed.
compress=${COMPRESS:-xz ${XZ_OPT:--T0 -1}}
case $compress in cat) archive=$name.tar ;; *) archive=$name.tar.xz ;; esac
tar --create --use-compress-program="$compress" --sort=name --owner=0 --group=0 --numeric-owner \
  --mtime="@${SOURCE_DATE_EPOCH:-$(stat -c %Y "$prefix/bin/ayumi")}" --directory "$tree" \
  --file "$out/$archive" "$name${ONLY:+/$ONLY}"
echo "$out/$archive: $(du -m "$out/$archive" | cut -f1) MB, unpacked $(du -sm "$root" | cut -f1) MB"
