# SPDX-License-Identifier: GPL-3.0-or-later
# From the case files to the table of comparisons: powder, solve, camera, thermography, line scans, compare.

# How fine each profile is. The case files hold what the paper states; only the spacing is set here.
SPACING_smoke := 14 um
SPACING_desk := 10 um
SPACING_paper := 2 um
# CBM-A is 4 ms long: at 10 um it alone takes as long as all other tracks together.
SPACING_desk_cbm_a := 14 um
SPACING := $(SPACING_$(PROFILE))
SPACINGS := $(SPACING)$(if $(SPACING_$(PROFILE)_cbm_a), (CBM-A: $(SPACING_$(PROFILE)_cbm_a)))
spacing_of = $(or $(SPACING_$(PROFILE)_$(1)),$(SPACING))

POWDER_TRACKS := 0wt 1wt 5wt
# CBM-A, 4 ms long, alone takes longer than the rest of the smoke profile together; so do the tracks of IN718.
BARE_TRACKS := 316L_175W_750 ammt_a $(if $(filter smoke,$(PROFILE)),,cbm_a in718_0 in718_1_1 in718_2_2 in718_3_1)
TRACKS := $(POWDER_TRACKS) $(BARE_TRACKS)
MATERIALS := $(wildcard data/materials/*.toml)

RESULTS := $(TRACKS:%=$(WORK)/track_%/result.json)
FILMED := $(POWDER_TRACKS:%=$(WORK)/track_%/thermography/summary.json)
COOLING := $(patsubst %,$(WORK)/track_%/cooling_rate.json,$(filter cbm_a,$(BARE_TRACKS)))
LINESCANS := $(WORK)/track_5wt/linescan_depth.json $(WORK)/track_5wt/linescan_lateral.json
COMPARISON := reports/validation.json

# Results of another profile must not pass for those of this one: a stamp that changes with the profile.
CHOSEN := reports/work/profile
.PHONY: always
always:
$(CHOSEN): always
	@mkdir -p $(@D); [ "$$(cat $@ 2>/dev/null)" = '$(PROFILE)' ] || echo '$(PROFILE)' > $@

$(WORK)/powder_%/powder.h5: solver/cases/powder_%.toml $(BIN)/meltproof-powder
	@mkdir -p $(@D)
	@$(STAGE) 'powder bed, $*' $(BIN)/meltproof-powder $< --output $@

# The paper profile takes hours: made again it goes on where it was stopped, and the melt of a coarser profile, if there
# is one, tells how long it will take.
coarser_melt = $(firstword $(wildcard $(foreach profile,desk smoke,reports/work/$(profile)/track_$(1)/history.csv)))
long_run = $(if $(filter paper,$(PROFILE)),--restart $(patsubst %,--melt-of %,$(coarser_melt)))

define solve
$(WORK)/track_$(1)/run.h5 $(WORK)/track_$(1)/history.csv $(WORK)/track_$(1)/result.json &: \
    solver/cases/track_$(1).toml $(2) $(MATERIALS) $(BIN)/meltproof-solve
	@mkdir -p $(WORK)/track_$(1)
	@$(STAGE) 'track $(1), spacing $(spacing_of)' $(BIN)/meltproof-solve $$< --output $(WORK)/track_$(1) \
	  --threads $(THREADS) --set spacing="$(spacing_of)" $(2:%=--powder %) $(long_run)
endef
$(foreach track,$(POWDER_TRACKS),$(eval $(call solve,$(track),$(WORK)/powder_$(track)/powder.h5)))
$(foreach track,$(BARE_TRACKS),$(eval $(call solve,$(track),)))

# Like for like: the simulated pool is filmed, and measured by the program that measures real recordings.
$(WORK)/track_%/recording.h5: $(WORK)/track_%/run.h5 $(BIN)/meltproof-camera
	@$(STAGE) 'virtual camera, $*' $(BIN)/meltproof-camera $< --output $@

$(WORK)/track_%/thermography/summary.json: $(WORK)/track_%/recording.h5 $(BIN)/meltproof-thermography
	@mkdir -p $(@D)
	@$(STAGE) 'thermography, $*' $(BIN)/meltproof-thermography $< --output $(@D) --scan-speed '0.375 m/s'

# Once the slots of the paper's Fig. 7 hold points they are compared. Where its scans begin is not said, so they may be
# moved by as much as the beam blurs, and turned round; both count as fitted.
FIG7 := data/experiments/wimmer2021/fig7_
FIG7_FITTED := --shift '2.5 um' --reversible

$(WORK)/track_%/linescan_depth.json: $(WORK)/track_%/run.h5 $(FIG7)depth.csv $(BIN)/meltproof-linescan
	@$(STAGE) 'line scan in depth, $*' pipelines/line_scan.sh $@ \
	  $(BIN)/meltproof-linescan $< --grain depth --measured $(FIG7)depth.csv $(FIG7_FITTED) --output $@

$(WORK)/track_%/linescan_lateral.json: $(WORK)/track_%/run.h5 $(FIG7)lateral.csv $(BIN)/meltproof-linescan
	@$(STAGE) 'line scan across, $*' pipelines/line_scan.sh $@ \
	  $(BIN)/meltproof-linescan $< --grain lateral --measured $(FIG7)lateral.csv $(FIG7_FITTED) --output $@

# What AM-Bench calls the cooling rate, from the isotherms behind the pool.
$(WORK)/track_%/cooling_rate.json: $(WORK)/track_%/run.h5 pipelines/cooling_rate.py pipelines/figures/artifact.py
	@$(STAGE) 'cooling rate, $*' $(PYTHON) pipelines/cooling_rate.py $< --output $@

# Status 1 says that a row is not as its table declares. The table is written all the same, so that the
# report shows it; the job itself then fails at its end (results_table.py).
$(COMPARISON): $(CHOSEN) $(VERIFICATION) $(STUDIES) $(RESULTS) $(FILMED) $(LINESCANS) $(COOLING) \
    validation/comparisons.toml \
    $(wildcard data/experiments/*/*) $(BIN)/meltproof-compare
	@rm -f $@
	@$(STAGE) 'comparisons' pipelines/written_or_fail.sh $@ $(BIN)/meltproof-compare \
	  --table validation/comparisons.toml --results reports/work --profile $(PROFILE) --studies $(STUDIES) --output $@
