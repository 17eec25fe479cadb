#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes a folder that holds a Debian with Blender, a virtual screen and a software OpenGL: 1.3 GB, 2 to 4 minutes.
#   blender.sh ROOT [SUITE]
# SUITE: trixie (Blender 4.3, the default) or sid. Needs root; packages come from where this machine has its own.
# ALLOW_EXPIRED=1 takes a list of packages past its date, of a mirror that lags behind; signatures are checked still.
set -euo pipefail
[ -n "${IN_NAMESPACE:-}" ] || exec env IN_NAMESPACE=1 unshare --mount --propagation private -- bash "$0" "$@"
root=$(realpath -m "$1") suite=${2:-trixie}
[ -e "$root/.ready" ] && exit 0
export DEBIAN_FRONTEND=noninteractive LC_ALL=C

sources=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null || true)  # either may be missing
mirror=$(grep -oE '[a-z+]+://[^ ]+/debian/?( |$)' <<<"$sources" | head -n 1 | tr -d ' ')
[ -n "$mirror" ] || { echo 'There is no Debian mirror in the sources of apt.' >&2; exit 1; }
command -v debootstrap >/dev/null || { apt-get update; apt-get install -y --no-install-recommends debootstrap; }

# The system, without daemons, documents and languages.
[ -x "$root/usr/bin/apt-get" ] || debootstrap --variant=minbase --include=ca-certificates "$suite" "$root" "$mirror"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"
chmod +x "$root/usr/sbin/policy-rc.d"
printf 'APT::Install-Recommends "false";\nAcquire::Languages "none";\n' >"$root/etc/apt/apt.conf.d/90small"
[ -z "${ALLOW_EXPIRED:-}" ] || echo 'Acquire::Check-Valid-Until "false";' >>"$root/etc/apt/apt.conf.d/90small"
printf 'path-exclude=/usr/share/%s/*\n' doc man locale >"$root/etc/dpkg/dpkg.cfg.d/90small"

# Blender.
mount -t proc proc "$root/proc"
mount --bind /dev "$root/dev"
cp /etc/resolv.conf /etc/hosts "$root/etc/"
echo "deb $mirror $suite main" >"$root/etc/apt/sources.list"
chroot "$root" apt-get update
chroot "$root" apt-get install -y blender libjemalloc2 xvfb xauth xdotool imagemagick libgl1-mesa-dri libgl1 libglx-mesa0 \
    libegl1 libegl-mesa0 python3-numpy python3-requests python3-zstandard python3-attr python3-cattr
chroot "$root" apt-get clean
rm -rf "$root"/var/lib/apt/lists/* "$root/etc/resolv.conf" "$root/etc/hosts"
ln -sf /proc/self/mounts "$root/etc/mtab"
umount "$root/dev" "$root/proc"
touch "$root/.ready"
