#include "taut/hull/solve/level_pieces.h"

#include <Eigen/Dense>
#include <algorithm>

namespace taut {
namespace {

/// How much deeper pieces may be below a plane that is not theirs as yet.
constexpr double first_depths = 4;
/// How often the plane and its pieces are told from each other.
constexpr int rounds = 2;
/// Width of points, relative to their length, below which they tell no plane.
constexpr double least_width = 1e-6;

/// The plane's normal that leaves the least squares of distances; n where points are in line.
dvec3 fitted(const std::vector<dvec3>& points, const dvec3& n) {
  dvec3 middle(0.0);
  for (const dvec3& x : points) middle += x / double(points.size());
  Eigen::Matrix3Xd off(3, Eigen::Index(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k) {
    const dvec3 x = points[k] - middle;
    off.col(Eigen::Index(k)) << x.x, x.y, x.z;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(off, Eigen::ComputeThinU);
  const auto& sizes = svd.singularValues();
  if (!(sizes[1] > least_width * sizes[0])) return n;
  const Eigen::Vector3d u = svd.matrixU().col(2);
  return aligned(unit({u[0], u[1], u[2]}), n);
}

/// The points are no farther from the segment between the first and the last.
bool is_straight(const std::vector<dvec3>& points, double distance) {
  const dvec3 along = unit(points.back() - points.front());
  return std::all_of(points.begin(), points.end(), [&](const dvec3& x) {
    return glm::length(glm::cross(x - points.front(), along)) <= distance;
  });
}

class PieceSearch {
 public:
  PieceSearch(const ContactGeometry& geometry, SupportQuery& query, const std::vector<dvec3>& more)
      : geometry_(geometry), query_(query), more_(more) {
    const Model& model = geometry.scene().model();
    for (const int i : geometry.scene().distinct_instances()) {
      const Part& part = model.parts()[std::size_t(model.instances()[std::size_t(i)].part)];
      for (int k = 0; k < int(part.pieces().size()); ++k) {
        const Contact piece{i, SourceKind::edge, k, 0, 0};
        if (!geometry.is_repeated(piece) && !geometry.is_straight(piece)) all_.push_back(piece);
      }
    }
  }

  /// Makes the pieces anew, and turns n into their plane.
  void gather(LevelPieces& found, double depth) const {
    const double least = query_(found.n).h - depth;
    found.pieces.clear();
    std::vector<dvec3> points;
    for (const Contact& piece : all_) {
      if (glm::dot(geometry_.point(piece), found.n) < least) continue;
      std::vector<dvec3> own;
      for (const dvec4& p : geometry_.curve(piece).points) own.push_back(euclidean(p));
      const bool level = std::all_of(own.begin(), own.end(),
                                     [&](const dvec3& x) { return glm::dot(x, found.n) >= least; });
      if (!level || is_straight(own, depth)) continue;
      found.pieces.push_back(piece);
      points.insert(points.end(), own.begin(), own.end());
    }
    if (points.empty()) return;
    points.insert(points.end(), more_.begin(), more_.end());
    found.n = fitted(points, found.n);
    const double top = query_(found.n, found.pieces.front()).h;
    found.off = 0;
    for (const dvec3& x : points) found.off = std::max(found.off, top - glm::dot(x, found.n));
  }

 private:
  const ContactGeometry& geometry_;
  SupportQuery& query_;
  const std::vector<dvec3>& more_;
  std::vector<Contact> all_;
};

}  // namespace

LevelPieces level_pieces(const ContactGeometry& geometry, SupportQuery& query, const dvec3& n,
                         double depth, const std::vector<dvec3>& more) {
  LevelPieces found{n, {}, 0};
  const PieceSearch search(geometry, query, more);
  search.gather(found, first_depths * depth);
  for (int k = 0; k < rounds && !found.pieces.empty(); ++k) search.gather(found, depth);
  return found;
}

}  // namespace taut
