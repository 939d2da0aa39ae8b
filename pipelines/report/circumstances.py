# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes down on what machine and from what state of the sources the results of a profile were made.

The file is touched only if something in it changed, so that an unchanged state makes nothing out of date.
"""

import argparse
import json
import os
import platform
import subprocess
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path


def said(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def library_version(name):
    try:
        return version(name)
    except PackageNotFoundError:  # Debian ships h5py without its metadata
        return import_module(name).__version__


def processor():
    for line in Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else []:
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def memory_gib():
    for line in Path("/proc/meminfo").read_text().splitlines() if Path("/proc/meminfo").exists() else []:
        if line.startswith("MemTotal"):
            return round(int(line.split()[1]) / 2**20)
    return None


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--profile", required=True)
    arguments.add_argument("--spacing", required=True, help="particle spacing of the tracks, with its unit")
    arguments.add_argument("--output", required=True)
    given = arguments.parse_args()

    system = platform.freedesktop_os_release() if Path("/etc/os-release").exists() else {}
    facts = {
        "profile": given.profile,
        "spacing": given.spacing,
        "last_commit": said("git", "log", "-1", "--format=%h", "--abbrev=12"),
        "last_commit_date": said("git", "log", "-1", "--format=%cs"),
        "source_date_epoch": int(os.environ.get("SOURCE_DATE_EPOCH", "0")),
        "machine": {"processor": processor(), "cores": os.cpu_count(), "memory_GiB": memory_gib(),
                    "system": system.get("PRETTY_NAME", platform.system())},
        "python": {"python": platform.python_version(),
                   **{name: library_version(name) for name in ("numpy", "matplotlib", "h5py", "Jinja2", "weasyprint")}},
    }
    text = json.dumps(facts, indent=1) + "\n"
    output = Path(given.output)
    if not output.is_file() or output.read_text(encoding="utf-8") != text:
        partial = output.with_suffix(".tmp")
        partial.write_text(text, encoding="utf-8")
        os.replace(partial, output)


main()
