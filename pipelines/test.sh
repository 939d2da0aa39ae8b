#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs CTest and keeps what it printed in build/release/ctest.log. Tests with the label long run only where
# the argument says so: they take minutes, and `make validate` judges the verification cases in any case.
set -euo pipefail
some=(--label-exclude '^long$')
if [ "${1:-}" = long ]; then
  some=()
fi
ctest --preset release "${some[@]}" 2>&1 | tee build/release/ctest.log
