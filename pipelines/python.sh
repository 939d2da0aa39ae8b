#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs Python with the libraries that Debian installs. The python3 on PATH may be another one without
# them, so the interpreter is found by trying the imports.
set -euo pipefail
for candidate in "${MELTPROOF_PYTHON:-}" /usr/bin/python3 python3; do
  [ -n "$candidate" ] && command -v "$candidate" >/dev/null || continue
  if "$candidate" -c '
from importlib.util import find_spec
import sys
sys.exit(not all(find_spec(m) for m in ("numpy", "matplotlib", "h5py", "jinja2", "weasyprint", "tomllib")))' 2>/dev/null; then
    PYTHONDONTWRITEBYTECODE=1 exec "$candidate" "$@"
  fi
done
echo "python: no Python 3.11 with numpy, matplotlib, h5py, jinja2 and weasyprint was found; install the packages of pipelines/packages.txt or name an interpreter in MELTPROOF_PYTHON." >&2
exit 1
