// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-bench-pairs: the speed of the pair loop, by Google Benchmark.
#include <cstdint>
#include <type_traits>

#include <benchmark/benchmark.h>

#include "solver/bench/pair_block.hpp"

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

BENCHMARK(pair_loop<double>)->Name("pair_loop/scalar")->Unit(benchmark::kMillisecond);
BENCHMARK(pair_loop<Lane>)->Name("pair_loop/lanes")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace meltproof::solver

BENCHMARK_MAIN();
