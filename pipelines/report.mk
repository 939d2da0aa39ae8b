# SPDX-License-Identifier: GPL-3.0-or-later
# Figures and report from whatever artifacts the stages made.

FIGURE_FOLDER := $(WORK)/figures
LOOK := $(addprefix pipelines/figures/,style.py artifact.py)
FIGURES := $(addprefix $(FIGURE_FOLDER)/,fig01_diffusion.svg fig02_conduction.svg fig03_flow_cases.svg fig03b_free_surface.svg \
  fig04_powder_and_pool.svg fig05_length.svg fig06_flow.svg fig07_profiles.svg fig08_history.svg fig09_camera.svg \
  fig10_bare_plate.svg fig11_resolution.svg fig12_sensitivity.svg fig13_tornado.svg fig14_scatter.svg)

$(addprefix $(FIGURE_FOLDER)/,fig01_diffusion.svg fig02_conduction.svg fig03_flow_cases.svg fig03b_free_surface.svg): \
    $(VERIFICATION) pipelines/figures/verification.py
$(FIGURE_FOLDER)/fig04_powder_and_pool.svg: $(WORK)/powder_5wt/powder.h5 $(WORK)/track_5wt/run.h5 \
    pipelines/figures/sections.py
$(FIGURE_FOLDER)/fig05_length.svg: $(POWDER_TRACKS:%=$(WORK)/track_%/result.json) $(FILMED) \
    $(COMPARISON)
$(FIGURE_FOLDER)/fig06_flow.svg: $(WORK)/track_0wt/run.h5 pipelines/figures/sections.py
$(FIGURE_FOLDER)/fig07_profiles.svg: $(LINESCANS)
$(FIGURE_FOLDER)/fig08_history.svg: $(RESULTS)
$(FIGURE_FOLDER)/fig09_camera.svg: $(WORK)/track_5wt/recording.h5 $(WORK)/track_5wt/thermography/summary.json
$(FIGURE_FOLDER)/fig10_bare_plate.svg: $(WORK)/track_316L_175W_750/run.h5 \
    $(WORK)/track_316L_175W_750/result.json $(COMPARISON) \
    pipelines/figures/sections.py

$(addprefix $(FIGURE_FOLDER)/,fig11_resolution.svg fig12_sensitivity.svg fig13_tornado.svg): $(STUDIES)
$(FIGURE_FOLDER)/fig14_scatter.svg: $(COMPARISON)

# What a figure reads is what stands before its script here; the scripts take it in this order.
$(FIGURE_FOLDER)/%.svg: pipelines/figures/%.py $(LOOK) | packages
	@$(STAGE) 'figure $*' $(PYTHON) $< $(filter reports/%,$^) --output $@

# What the report says about the machine and the sources, kept as a file so that an unchanged state does
# not make the report out of date.
CIRCUMSTANCES := $(WORK)/circumstances.json
$(CIRCUMSTANCES): always | packages
	@mkdir -p $(@D)
	@$(PYTHON) pipelines/report/circumstances.py --profile $(PROFILE) --spacing '$(SPACINGS)' --output $@

# What the present program makes of a short track: studies of other code that makes the same are not stale.
WITNESS := $(WORK)/witness.json
$(WITNESS): pipelines/witness.py $(BIN)/meltproof-solve $(BIN)/meltproof-powder $(MATERIALS) \
    solver/cases/powder_1wt.toml solver/cases/track_1wt.toml | packages
	@mkdir -p $(@D)
	@$(STAGE) 'witness of the solver' $(PYTHON) $< --solver $(BIN)/meltproof-solve --powder $(BIN)/meltproof-powder \
	  --output $@

REPORT := reports/validation.pdf
REPORT_BEFORE := $(shell stat -c %y $(REPORT) 2>/dev/null)

$(REPORT) reports/validation.html &: $(FIGURES) $(COMPARISON) $(VERIFICATION) $(STUDIES) $(RESULTS) $(FILMED) \
    $(CIRCUMSTANCES) $(WITNESS) pipelines/figures/track.py $(wildcard validation/results/paper/estimate.json) \
    $(wildcard reports/template/*) $(wildcard pipelines/report/*.py) pipelines/figures/artifact.py
	@$(STAGE) 'report' $(PYTHON) pipelines/report/build_report.py --work $(WORK) --figures $(FIGURE_FOLDER) \
	  --verification $(VERIFICATION) --comparison $(COMPARISON) --studies $(STUDIES) --circumstances $(CIRCUMSTANCES) \
	  --witness $(WITNESS) --template reports/template --output reports/validation

# What the report is made of, for programs: files, checksums, programs and what each was made from.
CRATE := reports/ro-crate-metadata.json
$(CRATE): $(REPORT) pipelines/report/ro_crate.py
	@$(STAGE) 'research object' $(PYTHON) pipelines/report/ro_crate.py $(VERIFICATION) $(COMPARISON) $(STUDIES) \
	  $(POWDER_TRACKS:%=$(WORK)/powder_%/powder.h5) $(RESULTS) $(FILMED) $(LINESCANS) --report $(REPORT:.pdf=) \
	  --figures $(FIGURE_FOLDER) --circumstances $(CIRCUMSTANCES)

.PHONY: figures report validate readme-picture
figures: $(FIGURES)
	@echo 'The figures are in $(FIGURE_FOLDER)/.'

report: $(REPORT) $(CRATE)
	@echo 'The report is $(REPORT), and reports/validation.html for a browser.'

validate: $(REPORT) $(CRATE)
	@if [ "$$(stat -c %y $(REPORT))" = '$(REPORT_BEFORE)' ]; then \
	  echo 'nothing to do: $(REPORT) is up to date'; fi
	@$(PYTHON) pipelines/report/results_table.py --verification $(VERIFICATION) --comparison $(COMPARISON) \
	  --report $(REPORT)

# The picture at the top of README.md: fig. 4 of the present results, to be committed by hand.
readme-picture: $(WORK)/powder_5wt/powder.h5 $(WORK)/track_5wt/run.h5 | packages
	@$(PYTHON) pipelines/figures/fig04_powder_and_pool.py $^ --output docs/images/powder_and_pool.png
	@echo 'The picture of README.md is docs/images/powder_and_pool.png; commit it to publish it.'
