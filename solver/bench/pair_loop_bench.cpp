// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-bench-pairs: the speed of the pair loop, by Google Benchmark.
#include <cstdint>
#include <type_traits>

#include <benchmark/benchmark.h>

#include "solver/bench/pair_block.hpp"
#include "solver/bench/single_loop.hpp"

namespace meltproof::solver {
namespace {

/// 64,000 particles: records and lists are many times what the caches of a core hold.
const PairBlock& block() {
  static const PairBlock made = make_pair_block(40);
  return made;
}

template <class T>
void pair_loop(benchmark::State& state) {
  const PairBlock& b = block();
  std::vector<PairRates> rates(b.size());
  for ([[maybe_unused]] auto _ : state) {
    five_terms<T>(b.records, b.list, b.kernel, rates);
    benchmark::DoNotOptimize(rates.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rates.size()));
  state.counters["neighbours"] = b.list.mean_neighbours();
  state.counters["lanes"] = std::is_same_v<T, double> ? 1 : static_cast<double>(lane_count);
}

/// Beside its speed, by how much the results differ from those in double precision.
void pair_loop_single(benchmark::State& state) {
  const PairBlock& b = block();
  const SingleBlock single = to_single(b);
  std::vector<PairRates> rates(b.size()), exact(b.size());
  for ([[maybe_unused]] auto _ : state) {
    five_terms_single(single, rates);
    benchmark::DoNotOptimize(rates.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rates.size()));
  five_terms<double>(b.records, b.list, b.kernel, exact);
  const Deviation off = deviation(rates, exact);
  state.counters["neighbours"] = b.list.mean_neighbours();
  state.counters["lanes"] = static_cast<double>(single_count);
  state.counters["deviation"] = off.worst;
  state.counters["deviation_continuity"] = off.of[0];
  state.counters["deviation_forces"] = off.of[1];
  state.counters["deviation_heat"] = off.of[2];
  state.counters["deviation_species"] = off.of[3];
}

BENCHMARK(pair_loop<double>)->Name("pair_loop/scalar")->Unit(benchmark::kMillisecond);
BENCHMARK(pair_loop<Lane>)->Name("pair_loop/lanes")->Unit(benchmark::kMillisecond);
BENCHMARK(pair_loop_single)->Name("pair_loop/lanes_single")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace meltproof::solver

BENCHMARK_MAIN();
