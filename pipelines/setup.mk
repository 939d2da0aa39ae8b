# SPDX-License-Identifier: GPL-3.0-or-later
# From a bare machine to the built programs.

PROGRAMS := powder solve export verify camera thermography campaign calibrate linescan compare studies
PROGRAM_FILES := $(PROGRAMS:%=$(BIN)/meltproof-%)

.PHONY: packages build
packages:
	@pipelines/install_packages.sh

build/release/build.ninja: | packages
	@$(STAGE) 'configure' cmake --preset release

# Ninja decides what is out of date, and leaves a program's date alone when nothing changed: so the rule
# runs every time, and whoever depends on a program is remade only if that program is new.
build: build/release/build.ninja
	@$(STAGE) 'build' cmake --build --preset release --target $(PROGRAMS:%=meltproof-%)
$(PROGRAM_FILES): build
	@test -x $@ || { echo "make: the build did not make $@" >&2; exit 1; }
