#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the system libraries that Blender's module links to and this machine lacks.
# usage: system_libraries.sh VENV
set -euo pipefail

declare -A package_of=(
    [libEGL.so.1]=libegl1
    [libGL.so.1]=libgl1
    [libGLX.so.0]=libglx0
    [libICE.so.6]=libice6
    [libOpenGL.so.0]=libopengl0
    [libSM.so.6]=libsm6
    [libX11.so.6]=libx11-6
    [libXext.so.6]=libxext6
    [libXfixes.so.3]=libxfixes3
    [libXi.so.6]=libxi6
    [libXrender.so.1]=libxrender1
    [libXt.so.6]=libxt6
    [libXxf86vm.so.1]=libxxf86vm1
    [libgomp.so.1]=libgomp1
    [libxkbcommon.so.0]=libxkbcommon0
)

module=$(find "$1"/lib/python3*/site-packages/bpy -maxdepth 1 -name '__init__*.so')
missing=$(ldd "$module" | awk '/not found/ {print $1}' | sort -u)
packages=()
for library in $missing; do
    if [ -z "${package_of[$library]:-}" ]; then
        echo "Blender's module needs $library, which this machine lacks and no known Debian package brings." >&2
        exit 1
    fi
    packages+=("${package_of[$library]}")
done
if [ ${#packages[@]} -gt 0 ]; then
    bash "$(dirname "$0")/apt_install.sh" "${packages[@]}"
fi
