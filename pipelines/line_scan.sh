#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# line_scan.sh OUTPUT COMMAND...: runs a line scan that writes OUTPUT. Where the track holds no grain to scan
# (status 3), or the line that the program chose through a grain leaves the metal, nobody gave a wrong
# input: then OUTPUT says so, with the program's own sentence, and figure and report repeat it.
set -uo pipefail
output=$1
shift
said=$("$@" 2>&1)
status=$?
[ -n "$said" ] && echo "$said"
if [ $status -eq 3 ] || { [ $status -eq 2 ] && [[ $said == *"meets no material"* ]]; }; then
  reason=$(printf '%s' "$said" | tail -n 1 | sed -e 's/^meltproof-linescan: //' -e 's/^error: //' -e 's/\\/\\\\/g' -e 's/"/\\"/g')
  printf '{"status": "no result", "reason": "%s", "simulated": null, "measured": null, "metrics": null}\n' \
    "$reason" >"$output.tmp" && mv "$output.tmp" "$output"
  exit
fi
exit $status
