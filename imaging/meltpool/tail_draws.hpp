// SPDX-License-Identifier: GPL-3.0-or-later
// What a tail tells of its front: the posterior distribution of the blurred model's parameters,
// over an abrupt front and over every width of a shoulder at once.
#pragma once

#include <vector>

#include <gsl/gsl_rng.h>

#include "imaging/meltpool/blurred_fit.hpp"

namespace meltproof::imaging::blurred_fit {

/// A fit with one interval and the normal distribution of the other parameters around it.
struct Node {
  Vector best;
  Matrix root;                          ///< lower triangle, root * root^T is the covariance
  double chi = 0;                       ///< chi-squared with what is known beforehand
  double log_weight = 0;                ///< ln of the posterior probability, of all nodes alike
  double reach = 0;                     ///< of the interval: it stands for so much on either side
  Vector by_interval = Vector::Zero();  ///< change of `best` with the interval
  Freedom free;
};

/// Nodes of both kinds of front.
struct Posterior {
  std::vector<Node> nodes;
  double abrupt = 0;                     ///< probability that the front is abrupt
  Vector by_steepness = Vector::Zero();  ///< change for one standard uncertainty of the steepness
  const Node& likeliest() const;         ///< the best one of the likelier kind
};

/// The model is fitted with an abrupt front and with shoulders of ten intervals between the patch's
/// narrowest and widest one. A node weighs as its profile likelihood, exp(-chi^2 / 2) of the best
/// other parameters, and what is known beforehand; both kinds of front are as likely before the
/// tail is seen, and a shoulder shares that among its intervals. The volume of parameters that fit
/// is left out: inside a shoulder the signal hardly tells the field, so that it would favour the
/// widest one for what the recording does not show.
/// @param abrupt,shoulder fits from where the others are begun.
Posterior posterior(const Patch& patch, const Vector& abrupt, const Vector& shoulder);

/// One draw of the parameters.
Vector draw(const Patch& patch, const Posterior& posterior, gsl_rng* random);

}  // namespace meltproof::imaging::blurred_fit
