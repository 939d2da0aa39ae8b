# SPDX-License-Identifier: GPL-3.0-or-later
# Runs that differ in one number. Too long for every report: their small results are committed, and a
# report is made from whatever is there. `make studies` makes what is missing, JOBS at a time, and can be
# stopped and started at will; AGAIN=1 renews what other code has made; STUDY=name makes one of them.
JOBS ?= 1
AGAIN ?=
STUDY ?=

STUDY_RESULTS := validation/results/desk/studies
STUDIES := reports/studies.json

.PHONY: studies
studies: packages build
	@$(PYTHON) pipelines/studies.py pipelines/studies.toml --solver $(BIN)/meltproof-solve \
	  --powder $(BIN)/meltproof-powder --work reports/work/studies --results $(STUDY_RESULTS) --jobs $(JOBS) \
	  --threads $(if $(filter 1,$(JOBS)),$(THREADS),1) $(if $(AGAIN),--again) $(STUDY:%=--only %)

$(STUDIES): pipelines/studies.toml $(wildcard $(STUDY_RESULTS)/*.json) $(BIN)/meltproof-studies
	@mkdir -p $(@D)
	@$(STAGE) 'studies' $(BIN)/meltproof-studies $< --results $(STUDY_RESULTS) --output $@
