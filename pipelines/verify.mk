# SPDX-License-Identifier: GPL-3.0-or-later
# Cases with exact solutions: error norms, observed orders, profiles. `make verify LONG=1` runs the long
# cases too and renews their committed results in solver/verification/results; without it those results
# stand in the table, marked stale when the code has changed since.
LONG ?=

VERIFICATION := reports/verification.json
VERIFICATION_CASES := $(wildcard solver/verification/*/case.toml solver/verification/results/*.json)

.PHONY: verify
verify: $(VERIFICATION)
	@$(PYTHON) pipelines/report/results_table.py --verification $(VERIFICATION)

# LONG=1 asks for a run, not for a file that is newer than another.
ifneq ($(LONG),)
$(VERIFICATION): always
endif

# A case that misses what is asked of it gives status 1, and stands in the table: see validate.mk.
$(VERIFICATION): $(BIN)/meltproof-verify $(VERIFICATION_CASES)
	@mkdir -p reports/work
	@rm -f $@
	@$(STAGE) 'verification against exact solutions' pipelines/written_or_fail.sh $@ \
	  $(BIN)/meltproof-verify solver/verification --output $@ --profiles-folder reports/work/verification \
	  $(if $(LONG),--long)
