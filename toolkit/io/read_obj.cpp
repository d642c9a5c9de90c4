#include "taut/io/read_obj.h"

#include <algorithm>
#include <string>
#include <utility>

#include "taut/io/obj_file.h"
#include "taut/io/text_scanner.h"

namespace taut {
namespace {

/// Most control points that the Bezier pieces of a file may have together (2 GiB of them). A
/// B-spline of degree 31 has a thousand for each control point in the file.
constexpr std::size_t max_piece_points = std::size_t{1} << 26;

std::size_t to_size(int n) { return static_cast<std::size_t>(n); }

/// A B-spline's knots in one direction, and how many control points belong to them.
struct Basis {
  int degree = 0;
  std::vector<double> knots;
  std::size_t count = 0;

  Interval domain() const { return {knots[to_size(degree)], knots[count]}; }
  std::size_t spans() const {
    std::size_t n = 0;
    for (std::size_t i = to_size(degree); i < count; ++i) n += knots[i] < knots[i + 1] ? 1U : 0U;
    return n;
  }
};

/// Knots of n Bezier pieces: all breakpoints with the multiplicity `inner`, but degree + 1 at the
/// ends. With inner = degree neighbours share their common control points, with degree + 1 each has
/// its own.
std::vector<double> piecewise_knots(const std::vector<double>& breakpoints, int degree, int inner) {
  std::vector<double> knots;
  for (std::size_t i = 0; i < breakpoints.size(); ++i) {
    const bool end = i == 0 || i + 1 == breakpoints.size();
    knots.insert(knots.end(), to_size(end ? degree + 1 : inner), breakpoints[i]);
  }
  return knots;
}

/// The common part of two intervals, and the same in coordinates where `piece` is [0, 1].
struct Overlap {
  Interval common, local;
  bool empty() const { return !(common.lower < common.upper && local.lower < local.upper); }
};

Overlap overlap(const Interval& piece, const Interval& range) {
  Overlap o;
  o.common = {std::max(piece.lower, range.lower), std::min(piece.upper, range.upper)};
  const double length = piece.upper - piece.lower;
  o.local = {o.common.lower == piece.lower ? 0 : (o.common.lower - piece.lower) / length,
             o.common.upper == piece.upper ? 1 : (o.common.upper - piece.lower) / length};
  return o;
}

/// The part of a curve or surface over a range within its domain: its Bezier pieces, cut at the
/// ends of the range, side by side. Each keeps its own control points, so that nothing is said
/// about how they join. @pre validate() passes
NurbsCurve restricted(const NurbsCurve& curve, const Interval& range) {
  NurbsCurve result;
  result.degree = curve.degree;
  std::vector<double> breakpoints = {range.lower};
  for (const CurvePiece& piece : decompose(curve)) {
    const Overlap t = overlap(piece.t, range);
    if (t.empty()) continue;
    const BezierCurve part = restricted(piece.bezier, t.local);
    result.points.insert(result.points.end(), part.points.begin(), part.points.end());
    breakpoints.push_back(t.common.upper);
  }
  result.knots = piecewise_knots(breakpoints, curve.degree, curve.degree + 1);
  return result;
}

NurbsSurface restricted(const NurbsSurface& surface, const Interval& u, const Interval& v) {
  std::vector<BezierPatch> patches;
  std::vector<double> breakpoints_u = {u.lower};
  std::vector<double> breakpoints_v = {v.lower};
  for (const PatchPiece& piece : decompose(surface)) {
    const Overlap in_u = overlap(piece.u, u);
    const Overlap in_v = overlap(piece.v, v);
    if (in_u.empty() || in_v.empty()) continue;
    patches.push_back(restricted(piece.bezier, in_u.local, in_v.local));
    // Pieces come with u outer, v inner: all v are seen in the first row.
    if (in_u.common.upper > breakpoints_u.back()) breakpoints_u.push_back(in_u.common.upper);
    if (in_v.common.upper > breakpoints_v.back()) breakpoints_v.push_back(in_v.common.upper);
  }

  const std::size_t rows = to_size(surface.degree_u) + 1;
  const std::size_t columns = to_size(surface.degree_v) + 1;
  const std::size_t patches_v = breakpoints_v.size() - 1;
  NurbsSurface result;
  result.degree_u = surface.degree_u;
  result.degree_v = surface.degree_v;
  result.knots_u = piecewise_knots(breakpoints_u, surface.degree_u, surface.degree_u + 1);
  result.knots_v = piecewise_knots(breakpoints_v, surface.degree_v, surface.degree_v + 1);
  for (std::size_t first = 0; first < patches.size(); first += patches_v) {
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t k = first; k < first + patches_v; ++k) {
        const auto row = patches[k].points.begin() + static_cast<std::ptrdiff_t>(i * columns);
        result.points.insert(result.points.end(), row, row + static_cast<std::ptrdiff_t>(columns));
      }
    }
  }
  return result;
}

bool same(const Interval& a, const Interval& b) { return a.lower == b.lower && a.upper == b.upper; }

/// Turns the elements of an OBJ file into the faces and edges of a part.
class Builder {
 public:
  Builder(const TextScanner& scanner, const ObjFile& file) : scanner_(scanner), file_(file) {}

  void add(const ObjElement& element);
  Part take() { return std::move(part_); }

 private:
  Basis basis(const ObjElement& e, Direction direction) const;
  dvec4 control_point(const ObjElement& e, std::size_t i) const;
  void require_range(const ObjElement& e, const Interval& range, const Interval& domain) const;
  void require_vertices(const ObjElement& e, std::size_t count) const;
  void count_piece_points(const ObjElement& e, double points);
  void add_curve(const ObjElement& e);
  void add_surface(const ObjElement& e);
  void fail(const ObjElement& e, const std::string& what) const { scanner_.fail(e.line, what); }

  const TextScanner& scanner_;
  const ObjFile& file_;
  Part part_;
  double piece_points_ = 0;
};

void Builder::add(const ObjElement& element) {
  if (element.surface) {
    add_surface(element);
  } else {
    add_curve(element);
  }
}

Basis Builder::basis(const ObjElement& e, Direction direction) const {
  const bool is_u = direction == Direction::u;
  const std::string name = is_u ? "parm u" : "parm v";
  const std::vector<double>& parameters = is_u ? e.parameters_u : e.parameters_v;
  const long line = is_u ? e.parameters_line_u : e.parameters_line_v;
  Basis basis;
  basis.degree = is_u ? e.degree_u : e.degree_v;
  const std::size_t order = to_size(basis.degree) + 1;
  if (e.spline) {
    if (parameters.empty()) fail(e, "a bspline needs " + name + " with its knots");
    if (parameters.size() < 2 * order) {
      scanner_.fail(line, name + " has " + std::to_string(parameters.size()) + " knots; degree " +
                              std::to_string(basis.degree) + " needs at least " +
                              std::to_string(2 * order));
    }
    basis.knots = parameters;
  } else {
    const Interval& range = is_u ? e.u : e.v;
    const std::vector<double> breakpoints =
        parameters.empty() ? std::vector<double>{range.lower, range.upper} : parameters;
    if (std::adjacent_find(breakpoints.begin(), breakpoints.end()) != breakpoints.end()) {
      scanner_.refuse(line, name + " has two equal breakpoints");
    }
    basis.knots = piecewise_knots(breakpoints, basis.degree, basis.degree);
  }
  basis.count = basis.knots.size() - order;
  return basis;
}

dvec4 Builder::control_point(const ObjElement& e, std::size_t i) const {
  const std::size_t index = e.vertices[i];
  if (index >= file_.vertices.size()) {
    scanner_.refuse(e.line, "vertex " + std::to_string(index + 1) +
                                " is referred to, but there are " +
                                std::to_string(file_.vertices.size()));
  }
  const ObjVertex& vertex = file_.vertices[index];
  if (!e.rational) return homogeneous(vertex.point);
  if (!(vertex.weight > 0)) {
    scanner_.refuse(vertex.line, "the weight of vertex " + std::to_string(index + 1) +
                                     " is not positive, and the rational element of line " +
                                     std::to_string(e.line) + " uses it");
  }
  return homogeneous(vertex.point, vertex.weight);
}

void Builder::require_range(const ObjElement& e, const Interval& range,
                            const Interval& domain) const {
  if (domain.lower <= range.lower && range.upper <= domain.upper) return;
  scanner_.refuse(e.line, "the range of parameters, " + shortest(range.lower) + " to " +
                              shortest(range.upper) + ", exceeds that of parm, " +
                              shortest(domain.lower) + " to " + shortest(domain.upper));
}

void Builder::require_vertices(const ObjElement& e, std::size_t count) const {
  if (e.vertices.size() == count) return;
  fail(e, std::to_string(e.vertices.size()) + " vertices where degree and parm ask for " +
              std::to_string(count));
}

void Builder::count_piece_points(const ObjElement& e, double points) {
  piece_points_ += points;
  if (piece_points_ <= static_cast<double>(max_piece_points)) return;
  throw LimitExceeded(scanner_.file() + ":" + std::to_string(e.line) +
                      ": the Bezier pieces of this file have more than " +
                      std::to_string(max_piece_points) + " control points");
}

void Builder::add_curve(const ObjElement& e) {
  Basis u = basis(e, Direction::u);
  require_vertices(e, u.count);
  count_piece_points(e, static_cast<double>(u.spans() * (to_size(u.degree) + 1)));
  const std::string name =
      e.name.empty() ? "curve " + std::to_string(part_.edges().size() + 1) : e.name;
  NurbsCurve curve{u.degree, std::move(u.knots), {}};
  for (std::size_t i = 0; i < u.count; ++i) curve.points.push_back(control_point(e, i));
  scanner_.placed(e.line, [&] { validate(curve, name); });
  require_range(e, e.u, curve.domain());
  if (!same(e.u, curve.domain())) curve = restricted(curve, e.u);
  scanner_.placed(e.line, [&] { part_.add_curve(curve, name); });
}

void Builder::add_surface(const ObjElement& e) {
  Basis u = basis(e, Direction::u);
  Basis v = basis(e, Direction::v);
  require_vertices(e, u.count * v.count);
  count_piece_points(e, static_cast<double>(u.spans() * (to_size(u.degree) + 1)) *
                            static_cast<double>(v.spans() * (to_size(v.degree) + 1)));
  const std::string name =
      e.name.empty() ? "surface " + std::to_string(part_.faces().size() + 1) : e.name;
  NurbsSurface surface{u.degree, v.degree, std::move(u.knots), std::move(v.knots), {}};
  for (std::size_t i = 0; i < u.count; ++i) {
    for (std::size_t j = 0; j < v.count; ++j) {
      surface.points.push_back(control_point(e, j * u.count + i));
    }
  }
  scanner_.placed(e.line, [&] { validate(surface, name); });
  require_range(e, e.u, surface.domain_u());
  require_range(e, e.v, surface.domain_v());
  if (!same(e.u, surface.domain_u()) || !same(e.v, surface.domain_v())) {
    surface = restricted(surface, e.u, e.v);
  }
  scanner_.placed(e.line, [&] { part_.add_surface(surface, name); });
}

}  // namespace

Part read_obj(const std::filesystem::path& path, const Progress& progress) {
  const std::string text = read_file(path);
  TextScanner scanner(path.string(), text);
  const ObjFile file = parse_obj(scanner, progress);
  const std::string polygons =
      std::to_string(file.polygons) + " polygons, which are not supported as part of a model yet";
  if (file.elements.empty()) {
    throw IoError(scanner.file() + ": holds no free-form curves or surfaces" +
                  (file.polygons > 0 ? ", only " + polygons : ""));
  }
  if (file.polygons > 0) {
    progress.warning("polygons-left-out", scanner.file() + ": left out " + polygons);
  }
  Builder builder(scanner, file);
  for (const ObjElement& element : file.elements) {
    progress.check();
    builder.add(element);
  }
  return builder.take();
}

}  // namespace taut
