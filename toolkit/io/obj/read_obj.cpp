#include "taut/io/obj/read_obj.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "taut/core/integers.h"
#include "taut/core/tolerances.h"
#include "taut/io/obj/obj_file.h"
#include "taut/io/obj/trim_sense.h"
#include "taut/io/text/text_scanner.h"
#include "taut/surface/piecewise.h"

namespace taut {
namespace {

/// Most control points in trimming loops, on top of one for each byte of the file: a few bytes
/// suffice to name a long curve again.
constexpr std::size_t max_trim_points = std::size_t{1} << 20;

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

bool same(const Interval& a, const Interval& b) { return a.lower == b.lower && a.upper == b.upper; }

/// Turns the elements of an OBJ file into the faces and edges of a part.
class Builder {
 public:
  /// `bytes`: the size of the file.
  Builder(const TextScanner& scanner, ObjFile& file, std::size_t bytes)
      : scanner_(scanner), file_(file), most_trim_points_(max_trim_points + bytes) {}

  void add(const ObjElement& element);
  PolygonMesh used_polygons() {
    std::vector<int> number;
    return used_polygons(number);
  }
  ControlCage cage(Scheme scheme);
  Part take() { return std::move(part_); }

 private:
  static constexpr int unused = -1;

  struct ParameterCurve {
    NurbsCurve curve;
    std::vector<CurvePiece> pieces;
  };

  Basis basis(const ObjElement& e, Direction direction) const;
  dvec4 control_point(const ObjElement& e, std::size_t i) const;
  dvec4 weighted(const ObjElement& e, const ObjVertex& vertex, const std::string& name) const;
  void require_range(long line, const Interval& range, const Interval& domain) const;
  void require_vertices(const ObjElement& e, std::size_t count) const;
  void count_piece_points(long line, double points);
  void count_trim_points(long line, std::size_t points);
  const ParameterCurve& parameter_curve(std::size_t i);
  TrimLoop trim_loop(const ObjLoop& loop);
  void add_curve(const ObjElement& e);
  void add_surface(const ObjElement& e);
  PolygonMesh used_polygons(std::vector<int>& number);
  void fail(const ObjElement& e, const std::string& what) const { scanner_.fail(e.line, what); }

  const TextScanner& scanner_;
  ObjFile& file_;
  Part part_;
  std::map<std::size_t, ParameterCurve> parameter_curves_;
  double piece_points_ = 0;
  std::size_t most_trim_points_;
  std::size_t trim_points_ = 0;
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
  return weighted(e, file_.vertices[index], "vertex " + std::to_string(index + 1));
}

dvec4 Builder::weighted(const ObjElement& e, const ObjVertex& vertex,
                        const std::string& name) const {
  if (!e.rational) return homogeneous(vertex.point);
  if (!(vertex.weight > 0)) {
    scanner_.refuse(vertex.line, "the weight of " + name +
                                     " is not positive, and the rational element of line " +
                                     std::to_string(e.line) + " uses it");
  }
  return homogeneous(vertex.point, vertex.weight);
}

void Builder::require_range(long line, const Interval& range, const Interval& domain) const {
  if (domain.lower <= range.lower && range.upper <= domain.upper) return;
  scanner_.refuse(line, "the range of parameters, " + shortest(range.lower) + " to " +
                            shortest(range.upper) + ", exceeds that of parm, " +
                            shortest(domain.lower) + " to " + shortest(domain.upper));
}

void Builder::require_vertices(const ObjElement& e, std::size_t count) const {
  if (e.vertices.size() == count) return;
  fail(e, std::to_string(e.vertices.size()) + " vertices where degree and parm ask for " +
              std::to_string(count));
}

void Builder::count_piece_points(long line, double points) {
  piece_points_ += points;
  if (piece_points_ <= max_piece_points) return;
  throw LimitExceeded(scanner_.file() + ":" + std::to_string(line) +
                      ": the Bezier pieces of this file have more than " +
                      std::to_string(int(max_piece_points)) + " control points");
}

void Builder::count_trim_points(long line, std::size_t points) {
  trim_points_ += points;
  if (trim_points_ <= most_trim_points_) return;
  throw LimitExceeded(scanner_.file() + ":" + std::to_string(line) +
                      ": the trimming loops of this file have more than " +
                      std::to_string(most_trim_points_) + " control points");
}

void Builder::add_curve(const ObjElement& e) {
  Basis u = basis(e, Direction::u);
  require_vertices(e, u.count);
  count_piece_points(e.line, static_cast<double>(u.spans() * (to_size(u.degree) + 1)));
  const std::string name =
      e.name.empty() ? "curve " + std::to_string(part_.edges().size() + 1) : e.name;
  NurbsCurve curve{u.degree, std::move(u.knots), {}};
  for (std::size_t i = 0; i < u.count; ++i) curve.points.push_back(control_point(e, i));
  scanner_.placed(e.line, [&] { validate(curve, printable(name)); });
  require_range(e.line, e.u, curve.domain());
  if (!same(e.u, curve.domain())) curve = restricted(curve, e.u);
  scanner_.placed(e.line, [&] { part_.add_curve(curve, name); });
}

/// Each is built once, however many loops use it.
const Builder::ParameterCurve& Builder::parameter_curve(std::size_t i) {
  const auto known = parameter_curves_.find(i);
  if (known != parameter_curves_.end()) return known->second;
  const ObjElement& e = file_.parameter_curves[i];
  Basis u = basis(e, Direction::u);
  require_vertices(e, u.count);
  count_piece_points(e.line, static_cast<double>(u.spans() * (to_size(u.degree) + 1)));
  NurbsCurve curve{u.degree, std::move(u.knots), {}};
  for (const std::size_t k : e.vertices) {
    curve.points.push_back(
        weighted(e, file_.parameter_points[k], "parameter point " + std::to_string(k + 1)));
  }
  scanner_.placed(e.line, [&] { validate(curve, "curv2 " + std::to_string(i + 1)); });
  std::vector<CurvePiece> pieces = decompose(curve);
  return parameter_curves_.emplace(i, ParameterCurve{std::move(curve), std::move(pieces)})
      .first->second;
}

TrimLoop Builder::trim_loop(const ObjLoop& loop) {
  TrimLoop result;
  for (const ObjTrimCurve& trim : loop.curves) {
    const auto& [whole, pieces] = parameter_curve(trim.curve);
    require_range(loop.line, trim.range, whole.domain());
    const bool is_whole = same(trim.range, whole.domain());
    result.curves.push_back(is_whole ? whole : restricted(pieces, trim.range));
    const std::size_t order = to_size(whole.degree) + 1;
    count_trim_points(loop.line,
                      is_whole ? pieces.size() * order : result.curves.back().points.size());
    scanner_.placed(loop.line, [&] { validate(result.curves.back(), "trimming curve"); });
  }
  return runs_counter_clockwise(result) == loop.hole ? reversed(result) : result;
}

/// Polygons, and points that stand alone, with the vertices that either uses, in the file's order.
/// `number`: that of each of the file's vertices, or `unused`.
PolygonMesh Builder::used_polygons(std::vector<int>& number) {
  number.assign(file_.vertices.size(), unused);
  for (const std::vector<int>& polygon : file_.polygons) {
    for (const int v : polygon) number[to_size(v)] = 0;
  }
  for (const int v : file_.points) number[to_size(v)] = 0;
  PolygonMesh mesh;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == unused) continue;
    number[v] = static_cast<int>(mesh.points.size());
    mesh.points.push_back(file_.vertices[v].point);
  }
  mesh.polygons = std::move(file_.polygons);
  for (std::vector<int>& polygon : mesh.polygons) {
    for (int& v : polygon) v = number[to_size(v)];
  }
  return mesh;
}

/// The polygons as a cage with the file's tags; points that stand alone are left.
ControlCage Builder::cage(Scheme scheme) {
  ControlCage cage;
  cage.scheme = scheme == Scheme::loop ? CageScheme::loop : CageScheme::catmark;
  const std::vector<int> alone = std::exchange(file_.points, {});
  std::vector<int> number;
  PolygonMesh mesh = used_polygons(number);
  file_.points = alone;
  file_.polygons.clear();
  cage.points = std::move(mesh.points);
  cage.faces = std::move(mesh.polygons);
  const ObjTags& tags = file_.tags;
  cage.boundary = tags.boundary;
  cage.chaikin = tags.chaikin;
  cage.smooth_triangles = tags.smooth_triangles;
  cage.holes = tags.holes;
  for (CageCrease crease : tags.creases) {
    for (int& v : crease.vertices) v = number[to_size(v)];
    if (crease.vertices[0] != unused && crease.vertices[1] != unused)
      cage.creases.push_back(crease);
  }
  for (CageCorner corner : tags.corners) {
    corner.vertex = number[to_size(corner.vertex)];
    if (corner.vertex != unused) cage.corners.push_back(corner);
  }
  return cage;
}

/// What the polygons stand for.
Scheme scheme_of(const ObjFile& file, const ReadOptions& options) {
  if (options.scheme) return *options.scheme;
  if (file.tag_line == 0) return Scheme::bilinear;
  const bool triangles = std::all_of(file.polygons.begin(), file.polygons.end(),
                                     [](const std::vector<int>& p) { return p.size() == 3; });
  return triangles ? Scheme::loop : Scheme::catmark;
}

void Builder::add_surface(const ObjElement& e) {
  Basis u = basis(e, Direction::u);
  Basis v = basis(e, Direction::v);
  require_vertices(e, u.count * v.count);
  count_piece_points(e.line, static_cast<double>(u.spans() * (to_size(u.degree) + 1)) *
                                 static_cast<double>(v.spans() * (to_size(v.degree) + 1)));
  const std::string name =
      e.name.empty() ? "surface " + std::to_string(part_.faces().size() + 1) : e.name;
  NurbsSurface surface{u.degree, v.degree, std::move(u.knots), std::move(v.knots), {}};
  for (std::size_t i = 0; i < u.count; ++i) {
    for (std::size_t j = 0; j < v.count; ++j) {
      surface.points.push_back(control_point(e, j * u.count + i));
    }
  }
  scanner_.placed(e.line, [&] { validate(surface, printable(name)); });
  require_range(e.line, e.u, surface.domain_u());
  require_range(e.line, e.v, surface.domain_v());
  if (!same(e.u, surface.domain_u()) || !same(e.v, surface.domain_v())) {
    surface = restricted(surface, e.u, e.v);
  }
  std::vector<TrimLoop> loops;
  for (const ObjLoop& loop : e.loops) loops.push_back(trim_loop(loop));
  scanner_.placed(e.line, [&] { part_.add_surface(surface, name, std::move(loops)); });
}

}  // namespace

FileContent read_obj(const std::string& name, std::string_view data, const ReadOptions& options) {
  TextScanner scanner(name, data);
  ObjFile file = parse_obj(scanner, options.progress);
  if (file.elements.empty() && file.polygons.empty() && file.points.empty()) {
    if (file.vertices.empty()) throw InvalidInput(name + ": holds no geometry");
    // Nothing says what the vertices are for: they are points.
    file.points.resize(file.vertices.size());
    std::iota(file.points.begin(), file.points.end(), 0);
  }
  Builder builder(scanner, file, data.size());
  for (const ObjElement& element : file.elements) {
    options.progress.check();
    builder.add(element);
  }
  std::optional<ControlCage> cage;
  const Scheme scheme = scheme_of(file, options);
  if (!file.polygons.empty() && scheme != Scheme::bilinear) cage = builder.cage(scheme);
  PolygonMesh mesh = builder.used_polygons();
  return {builder.take(), std::move(mesh), std::move(cage)};
}

}  // namespace taut
