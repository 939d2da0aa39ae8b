// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/parallel/decomposition.hpp"

#include <algorithm>
#include <stdexcept>

#include <zoltan.h>

namespace meltproof::solver {
namespace {

/// What Zoltan asks for, by callbacks.
struct Points {
  std::span<const Vector> positions;
  std::span<const Decomposition::Cost> costs;
};

int count_points(void* data, int* error) {
  *error = ZOLTAN_OK;
  return static_cast<int>(static_cast<const Points*>(data)->positions.size());
}

void list_points(void* data, int, int, ZOLTAN_ID_PTR global, ZOLTAN_ID_PTR local, int,
                 float* weights, int* error) {
  const auto& points = *static_cast<const Points*>(data);
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    // Numbers of this rank only: nobody asks Zoltan who goes where.
    global[i] = local[i] = static_cast<ZOLTAN_ID_TYPE>(i);
    for (std::size_t k = 0; k < points.costs[i].size(); ++k) {
      weights[3 * i + k] = static_cast<float>(points.costs[i][k]);
    }
  }
  *error = ZOLTAN_OK;
}

int count_axes(void*, int* error) {
  *error = ZOLTAN_OK;
  return 2;
}

void list_places(void* data, int, int, int count, ZOLTAN_ID_PTR, ZOLTAN_ID_PTR local, int axes,
                 double* places, int* error) {
  const auto& points = *static_cast<const Points*>(data);
  for (int k = 0; k < count; ++k) {
    for (int d = 0; d < axes; ++d) {
      places[k * axes + d] = points.positions[local[k]][static_cast<std::size_t>(d)];
    }
  }
  *error = ZOLTAN_OK;
}

}  // namespace

struct Decomposition::Zoltan {
  Zoltan_Struct* handle = nullptr;
  std::vector<int> found;  // as long as there are ranks

  Zoltan() {
    float version = 0;
    if (Zoltan_Initialize(0, nullptr, &version) != ZOLTAN_OK) {
      throw std::runtime_error("Zoltan does not start");
    }
    handle = Zoltan_Create(MPI_COMM_WORLD);
    const std::vector<std::pair<const char*, const char*>> settings{
        {"DEBUG_LEVEL", "0"},
        {"LB_METHOD", "RCB"},
        {"OBJ_WEIGHT_DIM", "3"},
        {"NUM_GID_ENTRIES", "1"},
        {"NUM_LID_ENTRIES", "1"},
        {"RETURN_LISTS", "NONE"},
        {"KEEP_CUTS", "1"},
        {"RCB_RECTILINEAR_BLOCKS", "1"},
        {"RCB_MULTICRITERIA_NORM", "3"}};
    for (const auto& [name, value] : settings) {
      if (Zoltan_Set_Param(handle, name, value) != ZOLTAN_OK) {
        throw std::runtime_error(std::string("Zoltan does not know its parameter ") + name);
      }
    }
  }
  ~Zoltan() { Zoltan_Destroy(&handle); }
  Zoltan(const Zoltan&) = delete;
  Zoltan& operator=(const Zoltan&) = delete;
};

Decomposition::Decomposition(const Ranks& ranks) : ranks_(ranks) {
  if (!ranks_.alone()) {
    zoltan_ = std::make_unique<Zoltan>();
    zoltan_->found.resize(static_cast<std::size_t>(ranks_.size()));
  }
}

Decomposition::~Decomposition() = default;
Decomposition::Decomposition(Decomposition&&) noexcept = default;
Decomposition& Decomposition::operator=(Decomposition&&) noexcept = default;

double Decomposition::balance(std::span<const Vector> positions, std::span<const Cost> costs) {
  if (ranks_.alone()) {
    return 1;
  }
  Points points{positions, costs};
  Zoltan_Struct* z = zoltan_->handle;
  Zoltan_Set_Num_Obj_Fn(z, count_points, &points);
  Zoltan_Set_Obj_List_Fn(z, list_points, &points);
  Zoltan_Set_Num_Geom_Fn(z, count_axes, &points);
  Zoltan_Set_Geom_Multi_Fn(z, list_places, &points);
  int changed = 0, global_size = 0, local_size = 0, leaving = 0, arriving = 0;
  ZOLTAN_ID_PTR leaving_global = nullptr, leaving_local = nullptr, arriving_global = nullptr,
                arriving_local = nullptr;
  int *leaving_to = nullptr, *arriving_from = nullptr, *leaving_part = nullptr,
      *arriving_part = nullptr;
  const int status =
      Zoltan_LB_Partition(z, &changed, &global_size, &local_size, &arriving, &arriving_global,
                          &arriving_local, &arriving_from, &arriving_part, &leaving,
                          &leaving_global, &leaving_local, &leaving_to, &leaving_part);
  Zoltan_LB_Free_Part(&arriving_global, &arriving_local, &arriving_from, &arriving_part);
  Zoltan_LB_Free_Part(&leaving_global, &leaving_local, &leaving_to, &leaving_part);
  if (ranks_.any(status != ZOLTAN_OK && status != ZOLTAN_WARN)) {
    throw std::runtime_error("Zoltan could not divide the particles among the ranks");
  }
  // Who owns a point is always asked of the cuts: then it cannot depend on who asked.
  std::vector<std::vector<Cost>> to(static_cast<std::size_t>(ranks_.size()), {Cost{}});
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Cost& cost = to[static_cast<std::size_t>(owner(positions[i]))][0];
    for (std::size_t k = 0; k < cost.size(); ++k) {
      cost[k] += costs[i][k];
    }
  }
  Cost own{};
  for (const Cost& part : ranks_.exchange(to)) {
    for (std::size_t k = 0; k < own.size(); ++k) {
      own[k] += part[k];
    }
  }
  return unevenness(ranks_, own);
}

double Decomposition::unevenness(const Ranks& ranks, const Cost& own) {
  Cost most = own;
  ranks.largest(most);
  double taken = 0;
  ExactSum total;
  for (std::size_t k = 0; k < own.size(); ++k) {
    taken += most[k];
    total.add(own[k]);
  }
  ranks.add(total);
  return total.total() > 0 ? taken * ranks.size() / total.total() : 1;
}

int Decomposition::owner(const Vector& at) const {
  if (ranks_.alone()) {
    return 0;
  }
  std::array<double, 3> place{at[0], at[1], 0};
  int process = 0, part = 0;
  if (Zoltan_LB_Point_PP_Assign(zoltan_->handle, place.data(), &process, &part) != ZOLTAN_OK) {
    throw std::runtime_error("Zoltan finds no owner of a place");
  }
  return process;
}

void Decomposition::near(const Vector& at, double reach, std::vector<int>& found) const {
  found.clear();
  if (ranks_.alone()) {
    found.push_back(0);
    return;
  }
  int count = 0;
  if (Zoltan_LB_Box_Assign(zoltan_->handle, at[0] - reach, at[1] - reach, 0, at[0] + reach,
                           at[1] + reach, 0, zoltan_->found.data(), &count) != ZOLTAN_OK) {
    throw std::runtime_error("Zoltan finds no ranks near a place");
  }
  found.assign(zoltan_->found.begin(), zoltan_->found.begin() + count);
}

}  // namespace meltproof::solver
