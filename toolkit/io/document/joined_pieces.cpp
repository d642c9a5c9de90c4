#include "taut/io/document/joined_pieces.h"

#include <cassert>
#include <span>

#include "taut/core/integers.h"

namespace taut {
namespace {

/// Knots over the ends of intervals; `shared[k]`: the pieces k and k + 1 share control points.
std::vector<double> knots_over(const std::vector<double>& ends, const std::vector<bool>& shared,
                               int degree) {
  std::vector<double> knots(to_size(degree) + 1, ends.front());
  for (std::size_t k = 0; k < shared.size(); ++k) {
    knots.insert(knots.end(), to_size(degree) + (shared[k] ? 0 : 1), ends[k + 1]);
  }
  knots.insert(knots.end(), to_size(degree) + 1, ends.back());
  return knots;
}

/// A face's patches as a grid.
class Grid {
 public:
  Grid(const Part& part, const Face& face)
      : patches_(&part.patches()[to_size(face.first_patch)], to_size(face.patch_count)) {
    while (count_v_ < patches_.size() && patches_[count_v_].u.lower == patches_[0].u.lower) {
      ++count_v_;
    }
    assert(patches_.size() % count_v_ == 0);
  }

  NurbsSurface surface() const {
    const BezierPatch& first = patches_[0].bezier;
    std::vector<double> ends_u = {patches_[0].u.lower};
    std::vector<double> ends_v = {patches_[0].v.lower};
    for (std::size_t i = 0; i < count_u(); ++i) ends_u.push_back(at(i, 0).u.upper);
    for (std::size_t j = 0; j < count_v_; ++j) ends_v.push_back(at(0, j).v.upper);
    std::vector<bool> shared_u;
    std::vector<bool> shared_v;
    for (std::size_t i = 1; i < count_u(); ++i) shared_u.push_back(share_u(i));
    for (std::size_t j = 1; j < count_v_; ++j) shared_v.push_back(share_v(j));

    NurbsSurface surface{first.degree_u,
                         first.degree_v,
                         knots_over(ends_u, shared_u, first.degree_u),
                         knots_over(ends_v, shared_v, first.degree_v),
                         {}};
    for (std::size_t i = 0; i < count_u(); ++i) {
      for (int k = i > 0 && shared_u[i - 1] ? 1 : 0; k <= first.degree_u; ++k) {
        for (std::size_t j = 0; j < count_v_; ++j) {
          for (int l = j > 0 && shared_v[j - 1] ? 1 : 0; l <= first.degree_v; ++l) {
            surface.points.push_back(at(i, j).bezier.at(k, l));
          }
        }
      }
    }
    return surface;
  }

 private:
  std::size_t count_u() const { return patches_.size() / count_v_; }
  const Patch& at(std::size_t i, std::size_t j) const { return patches_[i * count_v_ + j]; }

  bool share_u(std::size_t i) const {
    for (std::size_t j = 0; j < count_v_; ++j) {
      const BezierPatch& before = at(i - 1, j).bezier;
      for (int l = 0; l <= before.degree_v; ++l) {
        if (before.at(before.degree_u, l) != at(i, j).bezier.at(0, l)) return false;
      }
    }
    return true;
  }
  bool share_v(std::size_t j) const {
    for (std::size_t i = 0; i < count_u(); ++i) {
      const BezierPatch& before = at(i, j - 1).bezier;
      for (int k = 0; k <= before.degree_u; ++k) {
        if (before.at(k, before.degree_v) != at(i, j).bezier.at(k, 0)) return false;
      }
    }
    return true;
  }

  std::span<const Patch> patches_;
  std::size_t count_v_ = 0;
};

}  // namespace

NurbsSurface joined_patches(const Part& part, const Face& face) {
  return Grid(part, face).surface();
}

NurbsCurve joined_pieces(const Part& part, const Edge& edge) {
  const std::span pieces(&part.pieces()[to_size(edge.first_piece)], to_size(edge.piece_count));
  NurbsCurve curve;
  curve.degree = pieces[0].bezier.degree();
  std::vector<double> ends = {pieces[0].t.lower};
  std::vector<bool> shared;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const std::vector<dvec4>& points = pieces[k].bezier.points;
    ends.push_back(pieces[k].t.upper);
    if (k > 0) shared.push_back(curve.points.back() == points.front());
    curve.points.insert(curve.points.end(), points.begin() + (k > 0 && shared.back() ? 1 : 0),
                        points.end());
  }
  curve.knots = knots_over(ends, shared, curve.degree);
  return curve;
}

}  // namespace taut
