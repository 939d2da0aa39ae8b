# SPDX-License-Identifier: GPL-3.0-or-later
# Cases with exact solutions: error norms, observed orders, profiles.

VERIFICATION := reports/verification.json
VERIFICATION_CASES := $(wildcard solver/verification/*/case.toml)

.PHONY: verify
verify: $(VERIFICATION)
	@$(PYTHON) pipelines/report/results_table.py --verification $(VERIFICATION)

$(VERIFICATION): $(BIN)/meltproof-verify $(VERIFICATION_CASES)
	@mkdir -p reports/work/verification
	@$(STAGE) 'verification against exact solutions' $(BIN)/meltproof-verify --output $@ \
	  --profiles-folder reports/work/verification
