# SPDX-License-Identifier: GPL-3.0-or-later
# Cases with exact solutions: error norms, observed orders, profiles.

VERIFICATION := reports/verification.json
VERIFICATION_CASES := $(wildcard solver/verification/*/case.toml)

.PHONY: verify
verify: $(VERIFICATION)
	@$(PYTHON) pipelines/report/results_table.py --verification $(VERIFICATION)

# A case that misses what is asked of it gives status 1, and stands in the table: see validate.mk.
$(VERIFICATION): $(BIN)/meltproof-verify $(VERIFICATION_CASES)
	@mkdir -p reports/work
	@rm -f $@
	@$(STAGE) 'verification against exact solutions' pipelines/written_or_fail.sh $@ \
	  $(BIN)/meltproof-verify solver/verification --output $@ --profiles-folder reports/work/verification
