// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/tail_draws.hpp"

#include <algorithm>
#include <cmath>

#include <gsl/gsl_randist.h>

namespace meltproof::imaging::blurred_fit {
namespace {

constexpr int shoulders = 10;

/// The fit with this interval, from the better one of several beginnings.
Node fit_node(const Patch& patch, double width, const std::vector<Vector>& starts) {
  Node node;
  node.free = {.theta_star = true, .ratio = true, .variance = true};
  node.chi = 1e300;
  for (Vector p : starts) {
    p(interval) = width;
    p = minimise(patch, p, node.free, 12);
    const double chi = linearise(patch, p, false).total();
    if (chi < node.chi) node.chi = chi, node.best = p;
  }
  const Linearised at = linearise(patch, node.best, true);
  const Matrix c = covariance(patch, at, node.free);
  node.root = Eigen::LLT<Matrix>(c + 1e-18 * Matrix::Identity()).matrixL();
  node.log_weight = -0.5 * node.chi;
  return node;
}

}  // namespace

const Node& Posterior::likeliest() const {
  const Node* best = nullptr;
  for (const Node& n : nodes)
    if ((n.best(interval) == 0) == (abrupt > 0.5) && (!best || n.log_weight > best->log_weight))
      best = &n;
  return best ? *best : nodes.front();
}

Posterior posterior(const Patch& patch, const Vector& abrupt, const Vector& shoulder) {
  Posterior result;
  result.nodes.push_back(fit_node(patch, 0, {abrupt}));
  // Outwards from the interval that was fitted, each from its neighbour.
  const double low = patch.narrowest, high = patch.widest;
  const double step = (high - low) / shoulders;
  std::vector<Node> nodes(shoulders);
  const auto at = [&](int k) { return low + step * (k + 0.5); };
  const int first =
      std::clamp(static_cast<int>(std::floor((shoulder(interval) - low) / step)), 0, shoulders - 1);
  nodes[static_cast<std::size_t>(first)] = fit_node(patch, at(first), {shoulder});
  for (int k = first + 1; k < shoulders; ++k)
    nodes[static_cast<std::size_t>(k)] =
        fit_node(patch, at(k), {nodes[static_cast<std::size_t>(k - 1)].best});
  for (int k = first - 1; k >= 0; --k)
    nodes[static_cast<std::size_t>(k)] =
        fit_node(patch, at(k), {nodes[static_cast<std::size_t>(k + 1)].best});
  const double total = [&] {
    // What is known of the interval, made a probability over the range.
    double sum = 0;
    for (int k = 0; k < shoulders; ++k)
      sum += std::exp(-0.5 * patch.prior.weight(interval) *
                      std::pow(at(k) - patch.prior.mean(interval), 2));
    return sum;
  }();
  for (int k = 0; k < shoulders; ++k) {
    Node& n = nodes[static_cast<std::size_t>(k)];
    n.reach = 0.5 * step;
    const Node& before = nodes[static_cast<std::size_t>(std::max(k - 1, 0))];
    const Node& after = nodes[static_cast<std::size_t>(std::min(k + 1, shoulders - 1))];
    n.by_interval = (after.best - before.best) / (after.best(interval) - before.best(interval));
    n.log_weight -= std::log(total);
  }
  result.nodes.insert(result.nodes.end(), nodes.begin(), nodes.end());
  double highest = -1e300, all = 0;
  for (const Node& n : result.nodes) highest = std::max(highest, n.log_weight);
  for (const Node& n : result.nodes) all += std::exp(n.log_weight - highest);
  for (Node& n : result.nodes) n.log_weight -= highest + std::log(all);
  result.abrupt = std::exp(result.nodes.front().log_weight);
  if (patch.u_steepness > 0) {
    const Node& likeliest = result.likeliest();
    Patch steeper = patch;
    steeper.steepness += patch.u_steepness;
    Freedom free = likeliest.free;
    free.interval = likeliest.best(interval) > 0;
    result.by_steepness =
        minimise(steeper, likeliest.best, free, 20) - minimise(patch, likeliest.best, free, 20);
    result.by_steepness(interval) = 0;
  }
  return result;
}

Vector draw(const Patch& patch, const Posterior& posterior, gsl_rng* random) {
  double u = gsl_rng_uniform(random);
  const Node* node = &posterior.nodes.back();
  for (const Node& n : posterior.nodes) {
    u -= std::exp(n.log_weight);
    if (u < 0) {
      node = &n;
      break;
    }
  }
  Vector z;
  for (int k = 0; k < parameters; ++k) z(k) = gsl_ran_gaussian_ziggurat(random, 1);
  Vector p = node->best + node->root.triangularView<Eigen::Lower>() * z;
  const double along = node->reach * (2 * gsl_rng_uniform(random) - 1);
  p += along * node->by_interval;
  p += gsl_ran_gaussian_ziggurat(random, 1) * posterior.by_steepness;
  return bounded(patch, p, {.theta_star = true, .ratio = true, .variance = true});
}

}  // namespace meltproof::imaging::blurred_fit
