#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs CTest and keeps what it printed in build/release/ctest.log.
set -euo pipefail
ctest --preset release 2>&1 | tee build/release/ctest.log
