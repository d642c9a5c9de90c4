#include "taut/hull/decide/chart_glue.h"

#include <algorithm>

namespace taut {
namespace {

/// Two charts span the same stretch of what they share.
bool is_whole(const Branches& branches, const Glue& glue) {
  if (glue.kind != Glue::Kind::faces && glue.kind != Glue::Kind::face_edge) return true;
  const Interval& own = along(branches.chart(glue.a), Side(glue.at_a));
  const Chart& other = branches.chart(glue.b);
  const Interval& b = glue.kind == Glue::Kind::faces ? along(other, Side(glue.at_b)) : other.u;
  return glue.reversed ? own.lower == 1 - b.upper && own.upper == 1 - b.lower
                       : own.lower == b.lower && own.upper == b.upper;
}

}  // namespace

bool ChartGlue::find(const Branches& branches, const Branch& branch) {
  branches_ = &branches;
  table_.assign(branches.charts().size(), {-1, -1, -1, -1});
  beside_.clear();
  count_ = 0;
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (glue.kind == Glue::Kind::face_vertex) continue;
    if (!is_whole(branches, glue)) return false;
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
