# SPDX-License-Identifier: GPL-3.0-or-later
# A recording of a melt pool that somebody measured, or a folder of several.

# Handed over by the environment, never through Make's own words: a path may hold spaces.
export RECORDING CALIBRATION GRADUATION GRADUATION_IS MATERIAL SETTINGS LEVEL OUTPUT

.PHONY: process
process:
	@pipelines/process_recording.sh --check
	@$(MAKE) build PROGRAMS='thermography calibrate campaign'
	@pipelines/process_recording.sh
