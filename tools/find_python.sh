#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Prints the path of a Python of the given version: on the PATH, or kept by pyenv.
# usage: find_python.sh 3.13
set -euo pipefail

for candidate in "python$1" "${PYENV_ROOT:-$HOME/.pyenv}"/versions/"$1".*/bin/python; do
    if "$candidate" -c 'import venv' 2>/dev/null; then
        "$candidate" -c 'import sys; print(sys.executable)'
        exit
    fi
done
echo "There is no Python $1 with venv, neither on the PATH nor among pyenv's versions. Please install one." >&2
exit 1
