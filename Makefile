# SPDX-License-Identifier: GPL-3.0-or-later
# The front door: every job a user types. `make help` lists them; the rules stand in pipelines/*.mk.
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
MAKEFLAGS += --no-builtin-rules --no-print-directory
.SUFFIXES:
.DELETE_ON_ERROR:
# Recordings and beds are results too: Make must not remove them as mere steps on the way.
.SECONDARY:
# A stage uses all cores that it is given (THREADS), so stages run one at a time, also under -j.
.NOTPARALLEL:
.DEFAULT_GOAL := help

# smoke: minutes, for CI; desk: the default, some half an hour on two free cores; paper: a cluster.
PROFILE ?= desk
THREADS ?= $(shell nproc 2>/dev/null || echo 2)

PROFILES := smoke desk paper
ifeq ($(filter $(PROFILE),$(PROFILES)),)
$(error PROFILE=$(PROFILE) is no profile; choose one of: $(PROFILES))
endif

STAGE := pipelines/stage.sh
PYTHON := pipelines/python.sh
BIN := build/release/bin
WORK := reports/work/$(PROFILE)

# The date of everything generated is that of the last commit, so equal inputs give equal bytes.
export SOURCE_DATE_EPOCH := $(shell git log -1 --format=%ct 2>/dev/null || echo 0)

.PHONY: help
help:
	@echo 'Meltproof: a reproducible validation suite for laser powder bed fusion with in-situ alloying'
	@echo
	@echo '  make validate                 simulate, compare, and write reports/validation.pdf and .html'
	@echo '  make test                     build everything and run the tests; LONG=1: those that take minutes, too'
	@echo '  make process RECORDING=FILE   a melt pool recording: report (PDF, HTML), pool length, pictures; a folder: a campaign'
	@echo
	@echo '  make verify                   only the cases with exact solutions'
	@echo '  make figures                  only the figures'
	@echo '  make report                   only the report (makes what it is missing)'
	@echo '  make studies                  runs that differ in one number: resolution, numerical choices, physics'
	@echo '  make bench                    how fast it is and what memory it needs: reports/bench.json, some minutes'
	@echo '  make clean                    removes everything generated: build/ and what reports/ holds'
	@echo
	@echo '  PROFILE=smoke|desk|paper      how fine: minutes in CI; the default; a cluster  (now $(PROFILE))'
	@echo '  THREADS=N                     threads of a simulation                          (now $(THREADS))'
	@echo
	@echo '  make process takes also CALIBRATION=scale.json, or the image of a scale together with'
	@echo '  GRADUATION="100 um" GRADUATION_IS=period|line-width; MATERIAL=316L for liquidus and freezing heat,'
	@echo '  or LEVEL=signal at the edge of the pool; SETTINGS=file.toml; and OUTPUT=folder for the results.'
	@echo
	@echo 'Each job first installs what is missing of pipelines/packages.txt (with apt) and builds.'

include pipelines/setup.mk
include pipelines/verify.mk
include pipelines/studies.mk
include pipelines/validate.mk
include pipelines/report.mk
include pipelines/recording.mk
include pipelines/bench.mk

.PHONY: test
test: packages build/release/build.ninja
	@$(STAGE) 'build everything' cmake --build --preset release
	@$(STAGE) 'test' pipelines/test.sh $(if $(LONG),long)

.PHONY: clean
clean:
	@rm -rf build reports/work reports/recordings
	@find reports -mindepth 1 -maxdepth 1 ! -name template ! -name README.md -exec rm -rf {} +
	@echo 'clean: removed build/ and everything generated in reports/'
