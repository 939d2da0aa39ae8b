#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# line_scan.sh OUTPUT COMMAND...: runs a line scan that writes OUTPUT. Status 3 says that the track holds
# no grain to scan: then OUTPUT says that, with the program's own sentence, so that the report can.
set -uo pipefail
output=$1
shift
said=$("$@" 2>&1)
status=$?
[ -n "$said" ] && echo "$said"
if [ $status -eq 3 ]; then
  reason=$(printf '%s' "$said" | tail -n 1 | sed -e 's/^meltproof-linescan: //' -e 's/\\/\\\\/g' -e 's/"/\\"/g')
  printf '{"status": "no result", "reason": "%s", "simulated": null, "measured": null, "metrics": null}\n' \
    "$reason" >"$output.tmp" && mv "$output.tmp" "$output"
  exit
fi
exit $status
