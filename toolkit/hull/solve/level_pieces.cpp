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

std::vector<dvec3> control_points(const ContactGeometry& geometry, const Contact& piece) {
  std::vector<dvec3> points;
  for (const dvec4& p : geometry.curve(piece).points) points.push_back(euclidean(p));
  return points;
}

/// The piece is no farther from the segment between its ends.
bool is_straight(const ContactGeometry& geometry, const Contact& piece, double distance) {
  const std::vector<dvec3> points = control_points(geometry, piece);
  const dvec3 along = unit(points.back() - points.front());
  return std::all_of(points.begin(), points.end(), [&](const dvec3& x) {
    return glm::length(glm::cross(x - points.front(), along)) <= distance;
  });
}

/// The piece is straight, and so are those that it goes on into as far as the next vertex: one that
/// goes on into a bent one is a stretch of a curved side.
bool is_straight_to_vertices(const ContactGeometry& geometry, const Contact& piece,
                             double distance) {
  if (!is_straight(geometry, piece, distance)) return false;
  for (const std::size_t out : {0U, 1U}) {
    Contact at = piece;
    std::size_t end = out;
    while (geometry.piece(at).end_vertex[end] < 0) {
      const int next = geometry.piece(at).end_neighbor[end];
      if (next < 0 || next == piece.element) break;
      const std::array<int, 2>& back =
          geometry.piece({at.instance, SourceKind::edge, next, 0, 0}).end_neighbor;
      end = back[0] == at.element ? 1 : 0;
      at.element = next;
      if (!is_straight(geometry, at, distance)) return false;
    }
  }
  return true;
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

  /// Makes the pieces anew, and turns n into their plane: where short pieces tell less of it than n
  /// did, only if they are less deep then.
  void gather(LevelPieces& found, double depth) const {
    const double least = query_(found.n).h - depth;
    found.pieces.clear();
    std::vector<dvec3> points;
    for (const Contact& piece : all_) {
      if (glm::dot(geometry_.point(piece), found.n) < least) continue;
      const std::vector<dvec3> own = control_points(geometry_, piece);
      const bool level = std::all_of(own.begin(), own.end(),
                                     [&](const dvec3& x) { return glm::dot(x, found.n) >= least; });
      if (!level || is_straight_to_vertices(geometry_, piece, depth)) continue;
      found.pieces.push_back(piece);
      points.insert(points.end(), own.begin(), own.end());
    }
    if (points.empty()) return;
    points.insert(points.end(), more_.begin(), more_.end());
    const dvec3 turned = fitted(points, found.n);
    found.off = deepest(points, found.n);
    if (const double off = deepest(points, turned); off <= found.off) {
      found.n = turned;
      found.off = off;
    }
  }

 private:
  /// Of points below the supporting plane across n.
  double deepest(const std::vector<dvec3>& points, const dvec3& n) const {
    const double h = query_(n).h;
    double off = 0;
    for (const dvec3& x : points) off = std::max(off, h - glm::dot(x, n));
    return off;
  }

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
