#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs commands at the same time and fails if one of them does. What the first says is shown as it comes, what the
# others say when all have ended.
# usage: side_by_side.sh COMMAND...
set -uo pipefail

said=$(mktemp -d)
trap 'rm -rf "$said"' EXIT
processes=()
for command in "${@:2}"; do
    bash -c "$command" >"$said/${#processes[@]}" 2>&1 </dev/null &
    processes+=($!)
done

bash -c "$1" </dev/null
status=$?
for number in "${!processes[@]}"; do
    wait "${processes[number]}" || status=1
    cat "$said/$number"
done
exit $status
