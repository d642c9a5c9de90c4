#include "taut/hull/decide/chart_glue.h"

#include <algorithm>

namespace taut {
namespace {

/// Of what two charts share, what each spans, in the parameter of the first.
std::array<Interval, 2> stretches(const Branches& branches, const Glue& glue) {
  if (glue.kind != Glue::Kind::faces && glue.kind != Glue::Kind::face_edge) return {};
  const Chart& other = branches.chart(glue.b);
  const Interval& own = along(branches.chart(glue.a), Side(glue.at_a));
  const Interval& b = glue.kind == Glue::Kind::faces ? along(other, Side(glue.at_b)) : other.u;
  return {own, glue.reversed ? Interval{1 - b.upper, 1 - b.lower} : b};
}

}  // namespace

bool span_the_same(const Branches& branches, const Glue& glue) {
  const auto [own, there] = stretches(branches, glue);
  return own.lower == there.lower && own.upper == there.upper;
}

bool spans(const Branches& branches, const Glue& glue) {
  const auto [own, there] = stretches(branches, glue);
  return own.lower <= there.lower && there.upper <= own.upper;
}

bool ChartGlue::find(const Branches& branches, const Branch& branch) {
  branches_ = &branches;
  table_.assign(branches.charts().size(), {-1, -1, -1, -1});
  beside_.clear();
  count_ = 0;
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (glue.kind == Glue::Kind::face_vertex) continue;
    if (!span_the_same(branches, glue)) return false;
    ++count_;
    int& at_a = table_[std::size_t(glue.a)][std::size_t(glue.at_a)];
    if (at_a >= 0) return false;
    at_a = g;
    if (glue.kind == Glue::Kind::faces || glue.kind == Glue::Kind::edges) {
      int& at_b = table_[std::size_t(glue.b)][std::size_t(glue.at_b)];
      if (at_b >= 0) return false;
      at_b = g;
    } else {
      beside_.emplace_back(glue.b, glue.a);
    }
  }
  return true;
}

bool ChartGlue::are_beside(int chart, int element) const {
  return element >= 0 && std::any_of(beside_.begin(), beside_.end(), [&](const auto& pair) {
           return pair.first == chart && branches_->chart(pair.second).element == element;
         });
}

}  // namespace taut
