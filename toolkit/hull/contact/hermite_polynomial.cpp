#include "taut/hull/contact/hermite_polynomial.h"

namespace taut {

void HermitePolynomial::add(double r, const State& value, const State& slope) {
  append(r, value, nullptr);
  append(r, value, &slope);
}

std::array<HermitePolynomial::State, 2> HermitePolynomial::evaluate(double r) const {
  State p{}, q{};
  for (std::size_t k = node_.size(); k-- > 0;) {
    for (std::size_t c = 0; c < p.size(); ++c) {
      q[c] = q[c] * (r - node_[k]) + p[c];
      p[c] = p[c] * (r - node_[k]) + coefficient_[k][c];
    }
  }
  return {p, q};
}

/// The next divided difference: what is left of the value, or of the slope at the node that was
/// added last, over the product of distances to the nodes before.
void HermitePolynomial::append(double r, const State& value, const State* slope) {
  const auto [p, q] = evaluate(r);
  double product = 1;
  for (std::size_t k = 0; k + (slope != nullptr ? 1 : 0) < node_.size(); ++k) {
    product *= r - node_[k];
  }
  State next;
  for (std::size_t c = 0; c < next.size(); ++c) {
    next[c] = (slope != nullptr ? (*slope)[c] - q[c] : value[c] - p[c]) / product;
  }
  node_.push_back(r);
  coefficient_.push_back(next);
}

}  // namespace taut
