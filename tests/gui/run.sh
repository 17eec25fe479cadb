#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs a command in a folder that holds a Debian with Blender, with a virtual screen of its own.
#   run.sh ROOT FOLDER COMMAND...
# ROOT is what blender.sh made, FOLDER the command's working folder and home as seen from inside. What the command
# mounts is gone when it ends. Needs root.
set -uo pipefail
[ -n "${IN_NAMESPACE:-}" ] || exec env IN_NAMESPACE=1 unshare --mount --propagation private -- bash "$0" "$@"
root=$1 folder=$2
shift 2
mount -t proc proc "$root/proc"
mount --bind /dev "$root/dev"

inside() {
    exec chroot "$root" /usr/bin/env -i -C "$folder" PATH=/usr/local/bin:/usr/bin:/bin HOME="$folder" LANG=C.UTF-8 \
        XDG_RUNTIME_DIR="$folder" LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=llvmpipe DISPLAY="${display:-}" "$@"
}

rm -f "$root$folder/display"
(inside Xvfb -displayfd 3 -screen 0 1280x800x24 +extension GLX -nolisten tcp -noreset \
    3>"$root$folder/display" >"$root$folder/xvfb.log" 2>&1) &
screen=$!
for _ in $(seq 100); do [ -s "$root$folder/display" ] && break; sleep 0.1; done
display=:$(tr -d '\n' <"$root$folder/display")
(inside "$@")
status=$?
kill "$screen"
wait "$screen" 2>/dev/null
exit $status
