# SPDX-License-Identifier: GPL-3.0-or-later
# How fast the suite is, and what memory it needs: some four minutes. It measures anew whenever it is
# asked for. solver/bench/README.md says how; pipelines/bench.toml what is asked of each figure.
BENCH_WORK := reports/work/bench
BENCH_REPORT := reports/bench.json
# Past the start-up of a track, 130 um or 350 us, its pool has developed.
BENCH_TRACK := solver/cases/track_0wt.toml --set powder.surface=bare --set spacing='10 um' --until '400 us'
# Benchmarks take turns, so that what else the machine does falls on all of them.
IN_TURNS := --benchmark_repetitions=9 --benchmark_enable_random_interleaving=true --benchmark_format=json
# 200 000 particles of the same track, early: its pool takes minutes to develop on one core. Runs on more ranks
# than cores only tell what ranks say to each other.
BENCH_RANKS := solver/cases/track_0wt.toml --set powder.surface=bare --set spacing='6.5 um' --until '100 us' \
  --window '6 us'
MPIRUN := mpirun --allow-run-as-root --oversubscribe --bind-to none
ONE_CORE := OMP_NUM_THREADS=1 OMP_WAIT_POLICY=passive

.PHONY: bench
bench: packages
	@$(MAKE) build PROGRAMS='bench bench-pairs bench-imaging'
	@mkdir -p $(BENCH_WORK)
	@rm -f $(BENCH_WORK)/*.json
	@$(STAGE) 'whole steps of a track, some two minutes' env $(ONE_CORE) $(BIN)/meltproof-bench $(BENCH_TRACK) \
	  --output $(BENCH_WORK)/step.json
	@for n in 2 4 8; do \
	  $(STAGE) "$$n ranks, a minute" env $(ONE_CORE) OMPI_MCA_btl_vader_single_copy_mechanism=none \
	    OMPI_MCA_mpi_yield_when_idle=$$(( n > 2 )) $(MPIRUN) -n $$n $(BIN)/meltproof-bench $(BENCH_RANKS) \
	    --repeats $$(( n > 2 ? 1 : 9 )) --output $(BENCH_WORK)/ranks_$$n.json; \
	done
	@$(STAGE) 'pair loop, half a minute' bash -c \
	  '$(ONE_CORE) $(BIN)/meltproof-bench-pairs $(IN_TURNS) > $(BENCH_WORK)/pairs.json'
	@$(STAGE) 'melt pool extraction, a quarter of a minute' bash -c \
	  '$(ONE_CORE) $(BIN)/meltproof-bench-imaging $(IN_TURNS) > $(BENCH_WORK)/imaging.json'
	@$(STAGE) 'figures' $(PYTHON) pipelines/bench.py pipelines/bench.toml $(BENCH_WORK)/step.json \
	  $(BENCH_WORK)/ranks_2.json $(BENCH_WORK)/ranks_4.json $(BENCH_WORK)/ranks_8.json $(BENCH_WORK)/pairs.json $(BENCH_WORK)/imaging.json --output $(BENCH_REPORT)
	@echo 'The figures are in $(BENCH_REPORT).'
