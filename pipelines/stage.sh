#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# stage.sh NAME COMMAND...: runs one stage, announces it, and names it if it fails.
set -uo pipefail
name=$1
shift
echo "== $name"
start=$SECONDS
"$@"
status=$?
if [ $status -ne 0 ]; then
  echo "make: the stage '$name' failed with status $status after $((SECONDS - start)) s; its message stands above. The command was:" >&2
  printf '  ' >&2
  printf '%q ' "$@" >&2
  echo >&2
fi
exit $status
