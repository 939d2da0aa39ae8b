#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# From one recording to reports/recordings/<file name>/. What to do stands in the environment:
# RECORDING, and optionally CALIBRATION, GRADUATION, GRADUATION_IS, LEVEL, OUTPUT.
# With --check only refuses what cannot work, before anything is built.
set -euo pipefail
cd "$(dirname "$0")/.."

refuse() {
  echo "make process: $*" >&2
  exit 2
}

recording=${RECORDING:-}
calibration=${CALIBRATION:-}
[ -n "$recording" ] || refuse "say which recording: make process RECORDING=path/to/file"
[ -e "$recording" ] || refuse "the recording '$recording' does not exist; give the path from here ($(basename "$PWD")/) or the whole path."
[ -r "$recording" ] || refuse "the recording '$recording' cannot be read; check its permissions."
if [ -n "$calibration" ]; then
  [ -f "$calibration" ] || refuse "the calibration '$calibration' does not exist."
  if [[ $calibration != *.json ]]; then
    [ -n "${GRADUATION:-}" ] && [ -n "${GRADUATION_IS:-}" ] || refuse \
      "'$calibration' is taken for the image of a scale: say also its graduation and what that is, e.g. GRADUATION=\"100 um\" GRADUATION_IS=period (or line-width)."
  fi
fi
[ "${1:-}" = --check ] && exit 0

name=$(basename -- "$recording" | tr -s '[:space:]' '_')
name=${name%_} # the newline that basename writes
output=${OUTPUT:-reports/recordings/$name}
mkdir -p -- "$output"

options=()
if [[ -n $calibration && $calibration != *.json ]]; then
  pipelines/stage.sh 'calibration' build/release/bin/meltproof-calibrate "$calibration" \
    --output "$output/calibration.json" --graduation "$GRADUATION" --graduation-is "$GRADUATION_IS"
  calibration=$output/calibration.json
fi
[ -n "$calibration" ] && options+=(--calibration "$calibration")
[ -n "${LEVEL:-}" ] && options+=(--level "$LEVEL")

echo "== recording $recording"
status=0
build/release/bin/meltproof-thermography "$recording" --output "$output" "${options[@]}" || status=$?

case $status in
  0) echo "The results are in $output/." ;;
  3) echo "No melt pool was found in '$recording'; its frames are described in $output/." ;;
  4) echo "'$recording' ends early; the results in $output/ stand for its whole frames only." ;;
  *) rmdir -- "$output" 2>/dev/null || true
     echo "make process: '$recording' was not processed; the reason stands above." ;;
esac
exit $status
