// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/parallel/ranks.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <mpi.h>

#include "base/error.hpp"

namespace meltproof::solver {
namespace {

bool started_by_a_launcher() {
  constexpr std::array names{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};
  return std::any_of(names.begin(), names.end(),
                     [](const char* name) { return std::getenv(name) != nullptr; });
}

bool running() {
  int started = 0, ended = 0;
  MPI_Initialized(&started);
  MPI_Finalized(&ended);
  return started != 0 && ended == 0;
}

}  // namespace

MpiSession::MpiSession() {
  if (started_by_a_launcher() && !running()) {
    // Threads compute, one of them speaks.
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  }
}

MpiSession::~MpiSession() {
  if (running()) {
    MPI_Finalize();
  }
}

void MpiSession::give_up(int status) const {
  // With a single rank, too: MPI's end would have HDF5 write what a full disk left with it.
  if (running()) {
    MPI_Abort(MPI_COMM_WORLD, status);
  }
}

void MpiSession::check() {
  const char* tasks = std::getenv("SLURM_STEP_NUM_TASKS");
  if (tasks != nullptr && std::atoi(tasks) > 1 && Ranks::world().alone()) {
    throw InputError(std::string("srun started ") + tasks +
                     " processes that do not know of each other and would all write the same "
                     "files: use srun --mpi=pmix, or mpirun");
  }
}

Ranks Ranks::world() {
  Ranks ranks;
  if (running()) {
    MPI_Comm_size(MPI_COMM_WORLD, &ranks.size_);
    MPI_Comm_rank(MPI_COMM_WORLD, &ranks.rank_);
  }
  return ranks;
}

void Ranks::largest(std::span<double> values) const {
  if (!alone()) {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MAX,
                  MPI_COMM_WORLD);
  }
}

double Ranks::largest(double value) const {
  largest(std::span(&value, 1));
  return value;
}

void Ranks::smallest(std::span<double> values) const {
  if (!alone()) {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MIN,
                  MPI_COMM_WORLD);
  }
}

bool Ranks::any(bool value) const { return largest(value ? 1.0 : 0.0) > 0; }

void Ranks::add(ExactSum& sum) const {
  if (!alone()) {
    MPI_Allreduce(MPI_IN_PLACE, sum.limbs().data(), static_cast<int>(ExactSum::limb_count),
                  MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  }
}

void Ranks::add(std::span<std::uint64_t> counts) const {
  if (!alone()) {
    MPI_Allreduce(MPI_IN_PLACE, counts.data(), static_cast<int>(counts.size()), MPI_UINT64_T,
                  MPI_SUM, MPI_COMM_WORLD);
  }
}

std::uint64_t Ranks::add(std::uint64_t count) const {
  add(std::span(&count, 1));
  return count;
}

std::uint64_t Ranks::before(std::uint64_t count) const {
  std::uint64_t sum = 0;  // what MPI leaves as it is on the first rank
  if (!alone()) {
    MPI_Exscan(&count, &sum, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  }
  return root() ? 0 : sum;
}

std::string Ranks::said(const std::string& own) const {
  if (alone()) {
    return own;
  }
  int first = own.empty() ? size_ : rank_;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (first == size_) {
    return "";
  }
  auto length = static_cast<std::uint64_t>(own.size());
  MPI_Bcast(&length, 1, MPI_UINT64_T, first, MPI_COMM_WORLD);
  std::string text = own;
  text.resize(length);
  MPI_Bcast(text.data(), static_cast<int>(length), MPI_CHAR, first, MPI_COMM_WORLD);
  return text;
}

void Ranks::largest(std::span<std::uint8_t> flags) const {
  if (!alone()) {
    MPI_Allreduce(MPI_IN_PLACE, flags.data(), static_cast<int>(flags.size()), MPI_UINT8_T, MPI_MAX,
                  MPI_COMM_WORLD);
  }
}

void Ranks::meet() const {
  if (!alone()) {
    MPI_Barrier(MPI_COMM_WORLD);
  }
}

void Ranks::exchange_rows(const void* from, std::span<const int> counts, void* to,
                          std::span<const int> arriving, std::size_t bytes) const {
  std::vector<int> leaves_at(counts.size(), 0), arrives_at(counts.size(), 0);
  std::partial_sum(counts.begin(), counts.end() - 1, leaves_at.begin() + 1);
  std::partial_sum(arriving.begin(), arriving.end() - 1, arrives_at.begin() + 1);
  MPI_Datatype row = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &row);
  MPI_Type_commit(&row);
  MPI_Alltoallv(from, counts.data(), leaves_at.data(), row, to, arriving.data(), arrives_at.data(),
                row, MPI_COMM_WORLD);
  MPI_Type_free(&row);
}

std::vector<std::size_t> Ranks::exchange_sizes(const std::vector<std::size_t>& sizes) const {
  if (alone()) {
    return sizes;
  }
  std::vector<std::uint64_t> out(sizes.begin(), sizes.end()), in(sizes.size());
  MPI_Alltoall(out.data(), 1, MPI_UINT64_T, in.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
  return {in.begin(), in.end()};
}

void Ranks::exchange_bytes(const std::vector<std::span<const std::byte>>& from, void* to,
                           const std::vector<std::size_t>& arriving) const {
  auto* target = static_cast<std::byte*>(to);
  if (alone()) {
    std::copy(from[0].begin(), from[0].end(), target);
    return;
  }
  // Words of eight bytes, point to point: counts of MPI are ints, and most pairs of ranks have
  // nothing to say.
  std::vector<MPI_Request> requests;
  const auto count = [](std::size_t bytes) {
    if (bytes / 8 > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
      throw std::runtime_error("more than 16 GiB from one rank to another; use more ranks");
    }
    return static_cast<int>(bytes / 8);
  };
  std::size_t at = 0;
  for (std::size_t r = 0; r < arriving.size(); at += arriving[r++]) {
    if (arriving[r] > 0) {
      MPI_Irecv(target + at, count(arriving[r]), MPI_UINT64_T, static_cast<int>(r), 1,
                MPI_COMM_WORLD, &requests.emplace_back());
    }
  }
  for (std::size_t r = 0; r < from.size(); ++r) {
    if (!from[r].empty()) {
      MPI_Isend(from[r].data(), count(from[r].size()), MPI_UINT64_T, static_cast<int>(r), 1,
                MPI_COMM_WORLD, &requests.emplace_back());
    }
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

}  // namespace meltproof::solver
