#pragma once

#include <vector>

#include "taut/bounds/scalar_net.h"
#include "taut/surface/bernstein.h"

namespace taut {

/// A tensor-product Bernstein net (v within u) whose entries carry their binomial coefficients:
/// products are those of polynomials.
template <class Entry>
struct ScaledNet {
  NetShape shape;
  std::vector<Entry> entries;

  explicit ScaledNet(NetShape s) : shape(s), entries(std::size_t(s.size())) {}
  Entry& at(int i, int j) { return entries[std::size_t(i * (shape.q + 1) + j)]; }
  const Entry& at(int i, int j) const { return entries[std::size_t(i * (shape.q + 1) + j)]; }
};

/// From the net's entries value(i, j).
template <class Entry, class Value>
ScaledNet<Entry> scaled(NetShape shape, Value value) {
  const std::vector<double> along_u = binomials(shape.p);
  const std::vector<double> along_v = binomials(shape.q);
  ScaledNet<Entry> net(shape);
  for (int i = 0; i <= shape.p; ++i) {
    for (int j = 0; j <= shape.q; ++j) {
      net.at(i, j) = along_u[std::size_t(i)] * along_v[std::size_t(j)] * value(i, j);
    }
  }
  return net;
}

/// The net's entries.
template <class Entry>
std::vector<Entry> unscaled(const ScaledNet<Entry>& net) {
  const std::vector<double> along_u = binomials(net.shape.p);
  const std::vector<double> along_v = binomials(net.shape.q);
  std::vector<Entry> result;
  result.reserve(net.entries.size());
  for (int i = 0; i <= net.shape.p; ++i) {
    for (int j = 0; j <= net.shape.q; ++j) {
      result.push_back(net.at(i, j) / (along_u[std::size_t(i)] * along_v[std::size_t(j)]));
    }
  }
  return result;
}

/// Adds the product, times u or 1 - u (du: 1 or 0) and v or 1 - v likewise where the sum is one
/// degree higher.
template <class A, class B, class C, class Product>
void add_product(const ScaledNet<A>& a, const ScaledNet<B>& b, int du, int dv, ScaledNet<C>& sum,
                 Product product) {
  for (int i = 0; i <= a.shape.p; ++i) {
    for (int j = 0; j <= a.shape.q; ++j) {
      const A& left = a.at(i, j);
      for (int k = 0; k <= b.shape.p; ++k) {
        for (int l = 0; l <= b.shape.q; ++l) {
          sum.at(i + k + du, j + l + dv) += product(left, b.at(k, l));
        }
      }
    }
  }
}

}  // namespace taut
