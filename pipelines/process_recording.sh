#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# From one recording, or a folder of several, to reports/recordings/<name>/ with a report as PDF and HTML. What to do
# stands in the environment: RECORDING, and optionally CALIBRATION, GRADUATION, GRADUATION_IS, MATERIAL, LEVEL,
# SETTINGS, SCAN_SPEED, OUTPUT. recording_report/campaign.py says which folders are one recording and which several.
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
[ -z "${SETTINGS:-}" ] || [ -f "$SETTINGS" ] || refuse "the settings '$SETTINGS' do not exist."
[ "${1:-}" = --check ] && exit 0

reference='' freezing='' material=''
if [ -n "${MATERIAL:-}" ]; then
  said=$(pipelines/python.sh pipelines/recording_report/material.py "$MATERIAL")
  reference=$(head -n 1 <<<"$said")
  freezing=$(sed -n 2p <<<"$said") # empty where the material's file does not tell it
  material=$(tail -n 1 <<<"$said")
fi

bin=${MELTPROOF_BIN:-build/release/bin}
name=$(basename -- "$recording" | tr -s '[:space:]' '_')
name=${name%_} # the newline that basename writes
output=${OUTPUT:-reports/recordings/$name}
made=0
[ -d "$output" ] || made=1

# From the picture of a scale to the calibration, which all else rests on: without it nothing is begun.
calibrate() {
  echo "== calibration $calibration"
  "$bin/meltproof-calibrate" "$calibration" --output "$output/calibration.json" --graduation "$GRADUATION" \
    --graduation-is "$GRADUATION_IS" && return
  if [ $made = 1 ]; then rmdir -- "$output" 2>/dev/null || true; fi
  refuse "'$calibration' gives no pixel size; the reason stands above."
}

if [ -d "$recording" ] && [ "$(pipelines/python.sh pipelines/recording_report/campaign.py --decide "$recording")" = campaign ]; then
  if [[ -n $calibration && $calibration != *.json ]]; then # once for all tracks
    calibrate
    export CALIBRATION=$output/calibration.json
  fi
  exec pipelines/python.sh pipelines/recording_report/campaign.py "$recording" --output "$output"
fi
mkdir -p -- "$output"

options=(--film)
if [[ -n $calibration && $calibration != *.json ]]; then
  calibrate
  calibration=$output/calibration.json
fi
[ -n "$calibration" ] && options+=(--calibration "$calibration")
[ -n "${LEVEL:-}" ] && options+=(--level "$LEVEL")
[ -n "${SETTINGS:-}" ] && options+=(--settings "$SETTINGS")
[ -n "${SCAN_SPEED:-}" ] && options+=(--scan-speed "$SCAN_SPEED")
[ -n "$reference" ] && options+=(--reference-temperature "$reference")
[ -n "$freezing" ] && options+=(--freezing-heat "$freezing")

echo "== recording $recording"
status=0
rm -f -- "$output/tail.csv" # of an earlier run; this one may have none
"$bin/meltproof-thermography" "$recording" --output "$output" "${options[@]}" || status=$?

case $status in
  0 | 3 | 4)
    pages=()
    [ -n "$calibration" ] && pages+=(--calibration "$calibration")
    [ -n "$material" ] && pages+=(--material "$material")
    pipelines/stage.sh 'report' pipelines/python.sh pipelines/recording_report/recording_report.py "$output" "${pages[@]}" ;;
esac
case $status in
  0) echo "The report is $output/report.pdf, and report.html for a browser; numbers for a spreadsheet are in $output/frames.csv." ;;
  3) echo "No melt pool was found in '$recording'; $output/report.pdf describes its frames." ;;
  4) echo "'$recording' ends early; $output/report.pdf stands for its whole frames only." ;;
  *) [ $made = 1 ] && rm -f -- "$output/calibration.json" "$output/calibration.png" && rmdir -- "$output" 2>/dev/null || true
     echo "make process: '$recording' was not processed; the reason stands above." ;;
esac
exit $status
