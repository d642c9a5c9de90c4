#include "taut/io/document/read_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <utility>

#include "taut/core/integers.h"
#include "taut/core/tolerances.h"
#include "taut/io/document/document_format.h"
#include "taut/io/document/document_node.h"
#include "taut/io/text/text_scanner.h"
#include "taut/subdivision/add_cage.h"

namespace taut {
namespace {

constexpr int most = std::numeric_limits<int>::max();

/// Control points in one direction once decomposed. @pre the knots are valid
double piece_points(const std::vector<double>& knots, int degree) {
  double spans = 0;
  for (std::size_t i = to_size(degree); i + to_size(degree) + 1 < knots.size(); ++i) {
    spans += knots[i] < knots[i + 1] ? 1 : 0;
  }
  return spans * (degree + 1);
}

std::vector<double> read_knots(const DocumentNode& node) {
  std::vector<double> knots(node.size());
  for (std::size_t i = 0; i < knots.size(); ++i) {
    knots[i] = node[i].number();
    if (i > 0 && knots[i] < knots[i - 1]) {
      node[i].refuse(shortest(knots[i]) + " is below the knot before it");
    }
  }
  return knots;
}

int read_degree(const DocumentNode& node) { return node.integer(1, max_degree); }

/// `dimension` coordinates and perhaps a weight; as a homogeneous point, with zeros for what is
/// not there.
dvec4 read_point(const DocumentNode& node, std::size_t dimension) {
  const std::size_t size = node.size();
  if (size != dimension && size != dimension + 1) {
    node.fail(std::to_string(size) + " numbers where " + std::to_string(dimension) +
              " and perhaps a weight are expected");
  }
  dvec3 x(0.0);
  for (std::size_t i = 0; i < dimension; ++i) x[int(i)] = node[i].number();
  const double w = size > dimension ? node[dimension].number() : 1;
  if (!(w > 0)) node[dimension].refuse("the weight is not positive");
  return homogeneous(x, w);
}

/// The double that is some steps up from another.
double stepped(double x, int steps) {
  const double to = steps < 0 ? -std::numeric_limits<double>::infinity()
                              : std::numeric_limits<double>::infinity();
  for (int i = std::abs(steps); i > 0; --i) x = std::nextafter(x, to);
  return x;
}

/// Corrects the points whose homogeneous coordinates are no rounded products.
void read_ulps(const DocumentNode& object, std::size_t dimension, std::vector<dvec4>& points) {
  const auto ulps = object.find("ulps");
  if (!ulps) return;
  for (std::size_t k = 0; k < ulps->size(); ++k) {
    const DocumentNode entry = (*ulps)[k];
    entry.expect_size(1 + dimension);
    const int last = int(std::min(points.size(), to_size(most))) - 1;
    dvec4& point = points[to_size(entry[0].integer(0, last))];
    for (std::size_t i = 0; i < dimension; ++i) {
      const int steps = entry[i + 1].integer(-max_document_ulps, max_document_ulps);
      point[int(i)] = stepped(point[int(i)], steps);
    }
  }
}

NurbsCurve read_curve(const DocumentNode& node, std::size_t dimension) {
  NurbsCurve curve;
  curve.degree = read_degree(node.at("degree"));
  curve.knots = read_knots(node.at("knots"));
  const DocumentNode points = node.at("points");
  for (std::size_t i = 0; i < points.size(); ++i) {
    curve.points.push_back(read_point(points[i], dimension));
  }
  read_ulps(node, dimension, curve.points);
  validate(curve, node.place());
  return curve;
}

NurbsSurface read_nurbs_surface(const DocumentNode& node) {
  NurbsSurface surface;
  const DocumentNode degree = node.at("degree");
  degree.expect_size(2);
  surface.degree_u = read_degree(degree[0]);
  surface.degree_v = read_degree(degree[1]);
  const DocumentNode knots = node.at("knots");
  knots.expect_size(2);
  surface.knots_u = read_knots(knots[0]);
  surface.knots_v = read_knots(knots[1]);
  const DocumentNode rows = node.at("points");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const DocumentNode row = rows[i];
    if (row.size() != rows[0].size()) {
      row.refuse(std::to_string(row.size()) + " points where the first row has " +
                 std::to_string(rows[0].size()));
    }
    for (std::size_t j = 0; j < row.size(); ++j) surface.points.push_back(read_point(row[j], 3));
  }
  read_ulps(node, 3, surface.points);
  validate(surface, node.place());
  if (rows.size() != to_size(surface.count_u())) {
    rows.refuse(std::to_string(rows.size()) + " rows of points where the knots ask for " +
                std::to_string(surface.count_u()));
  }
  return surface;
}

std::vector<TrimLoop> read_loops(const DocumentNode& node) {
  std::vector<TrimLoop> loops(node.size());
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const DocumentNode loop = node[i];
    if (loop.size() == 0) loop.refuse("the loop has no curves");
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const DocumentNode curve = loop[k];
      curve.expect_keys("loop's curve", {"degree", "knots", "points", "ulps"});
      loops[i].curves.push_back(read_curve(curve, 2));
    }
  }
  return loops;
}

std::string name_of(const DocumentNode& node, const std::string& otherwise) {
  const auto name = node.find("name");
  return name ? name->string() : otherwise;
}

/// Reads the parts of one document.
class PartReader {
 public:
  explicit PartReader(const ReadOptions& options) : options_(options) {}

  Part read(const DocumentNode& node, const std::string& name);

 private:
  void read_surfaces(const DocumentNode& list);
  void read_edges(const DocumentNode& list);
  void read_cage(const DocumentNode& node);
  void read_polygons(const DocumentNode& node);
  void add(const DocumentNode& node, const ControlCage& cage);
  ControlCage read_control_cage(const DocumentNode& node, CageScheme scheme);
  void count(const DocumentNode& node, double points);

  const ReadOptions& options_;
  Part part_;
  std::map<int, std::size_t> ids_;
  double piece_points_ = 0;
};

Part PartReader::read(const DocumentNode& node, const std::string& name) {
  node.expect_keys("part", {"name", "surfaces", "edges", "vertices", "cages"});
  part_ = Part();
  part_.name = name_of(node, name);
  ids_.clear();
  if (const auto surfaces = node.find("surfaces")) read_surfaces(*surfaces);
  if (const auto edges = node.find("edges")) read_edges(*edges);
  if (const auto vertices = node.find("vertices")) {
    std::vector<dvec3> points(vertices->size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = (*vertices)[i].vector();
    vertices->placed([&] { part_.add_points(points); });
  }
  if (const auto cages = node.find("cages")) {
    for (std::size_t i = 0; i < cages->size(); ++i) read_cage((*cages)[i]);
  }
  return std::move(part_);
}

void PartReader::read_surfaces(const DocumentNode& list) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    list.notes().progress().update("read", double(i) / double(list.size()));
    const DocumentNode node = list[i];
    node.expect_keys("surface", {"id", "name", "degree", "knots", "points", "ulps", "loops"});
    const auto id_node = node.find("id");
    const int id = id_node ? id_node->integer(0, most) : int(i);
    if (!ids_.emplace(id, i).second) {
      node.refuse("another surface has the id " + std::to_string(id));
    }
    const NurbsSurface surface = read_nurbs_surface(node);
    std::vector<TrimLoop> loops;
    if (const auto loops_node = node.find("loops")) loops = read_loops(*loops_node);
    count(node, piece_points(surface.knots_u, surface.degree_u) *
                    piece_points(surface.knots_v, surface.degree_v));
    const std::string name = name_of(node, "surface " + std::to_string(id));
    node.placed([&] { part_.add_surface(surface, name, std::move(loops)); });
  }
}

void PartReader::read_edges(const DocumentNode& list) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    list.notes().progress().check();
    const DocumentNode node = list[i];
    node.expect_keys("edge", {"name", "degree", "knots", "points", "ulps", "faces"});
    const NurbsCurve curve = read_curve(node, 3);
    const std::string name = name_of(node, "curve " + std::to_string(part_.edges().size() + 1));
    const auto faces = node.find("faces");
    for (std::size_t k = 0; faces && k < faces->size(); ++k) {
      const int id = (*faces)[k].integer(0, most);
      if (!ids_.contains(id)) (*faces)[k].refuse("no surface has the id " + std::to_string(id));
    }
    if (faces && faces->size() > 0) continue;  // a border
    count(node, piece_points(curve.knots, curve.degree));
    node.placed([&] { part_.add_curve(curve, name); });
  }
}

std::vector<std::vector<int>> read_faces(const DocumentNode& cage) {
  const int last = int(std::min(cage.at("points").size(), to_size(most))) - 1;
  const DocumentNode faces = cage.at("faces");
  std::vector<std::vector<int>> result(faces.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const DocumentNode face = faces[i];
    if (face.size() < 3) face.refuse("the polygon has fewer than three corners");
    for (std::size_t k = 0; k < face.size(); ++k) result[i].push_back(face[k].integer(0, last));
  }
  return result;
}

void PartReader::read_cage(const DocumentNode& node) {
  node.expect_keys("cage", {"scheme", "points", "faces", "creases", "corners", "holes", "boundary",
                            "crease_method", "triangle_rule"});
  const DocumentNode scheme = node.at("scheme");
  if (scheme.string() == "bilinear") {
    read_polygons(node);
  } else if (scheme.string() == name_of(CageScheme::catmark)) {
    add(node, read_control_cage(node, CageScheme::catmark));
  } else if (scheme.string() == name_of(CageScheme::loop)) {
    add(node, read_control_cage(node, CageScheme::loop));
  } else {
    scheme.fail("no scheme is called so");
  }
}

void PartReader::read_polygons(const DocumentNode& node) {
  const PolygonMesh mesh{node.at("points").vectors(), read_faces(node)};
  node.placed([&] { part_.add_polygons(mesh); });
}

void PartReader::add(const DocumentNode& node, const ControlCage& cage) {
  node.placed([&] {
    add_cage(part_, cage, node.place(), {options_.cage_accuracy, options_.progress});
  });
}

/// The one of some words that a key's value is, as a number; the first where there is no key.
std::size_t choice(const DocumentNode& node, std::string_view key,
                   std::initializer_list<std::string_view> words) {
  const auto value = node.find(key);
  if (!value) return 0;
  const auto found = std::find(words.begin(), words.end(), value->string());
  if (found == words.end()) value->fail("no rule is called so");
  return static_cast<std::size_t>(found - words.begin());
}

ControlCage PartReader::read_control_cage(const DocumentNode& node, CageScheme scheme) {
  ControlCage cage;
  cage.scheme = scheme;
  cage.points = node.at("points").vectors();
  cage.faces = read_faces(node);
  const int last = int(std::min(cage.points.size(), to_size(most))) - 1;
  if (const auto creases = node.find("creases")) {
    for (std::size_t i = 0; i < creases->size(); ++i) {
      const DocumentNode crease = (*creases)[i];
      crease.expect_size(3);
      cage.creases.push_back(
          {{crease[0].integer(0, last), crease[1].integer(0, last)}, crease[2].number()});
    }
  }
  if (const auto corners = node.find("corners")) {
    for (std::size_t i = 0; i < corners->size(); ++i) {
      const DocumentNode corner = (*corners)[i];
      corner.expect_size(2);
      cage.corners.push_back({corner[0].integer(0, last), corner[1].number()});
    }
  }
  if (const auto holes = node.find("holes")) {
    const int last_face = int(std::min(cage.faces.size(), to_size(most))) - 1;
    for (std::size_t i = 0; i < holes->size(); ++i) {
      cage.holes.push_back((*holes)[i].integer(0, last_face));
    }
  }
  constexpr std::array boundaries = {CageBoundary::edge_and_corner, CageBoundary::edge_only,
                                     CageBoundary::none};
  cage.boundary = boundaries[choice(
      node, "boundary", {name_of(boundaries[0]), name_of(boundaries[1]), name_of(boundaries[2])})];
  cage.chaikin = choice(node, "crease_method", {"uniform", "chaikin"}) == 1;
  cage.smooth_triangles = choice(node, "triangle_rule", {"catmark", "smooth"}) == 1;
  return cage;
}

void PartReader::count(const DocumentNode& node, double points) {
  piece_points_ += points;
  if (piece_points_ <= max_piece_points) return;
  throw LimitExceeded(node.place() + ": the Bezier pieces of this document have more than " +
                      std::to_string(int(max_piece_points)) + " control points");
}

void check_header(const DocumentNode& root) {
  root.expect_keys("document", {"format", "version", "unit", "parts", "instances"});
  if (root.at("format").string() != document_format) {
    root.at("format").fail("this is no model document: \"taut-model\" expected");
  }
  const int version = root.at("version").integer(std::numeric_limits<int>::min(), most);
  if (version != document_version) {
    root.at("version").fail("version " + std::to_string(version) + " is not known, only " +
                            std::to_string(document_version));
  }
}

/// Gives the model the document's unit, unless it has one already.
void take_unit(const DocumentNode& root, Model& model) {
  const auto node = root.find("unit");
  if (!node) return;
  const std::string unit(node->string());
  if (model.unit().empty()) {
    model.set_unit(unit);
  } else if (unit != model.unit()) {
    root.notes().warning("unit", "the unit is " + in_quotes(unit) +
                                     ", that of what was read before " + in_quotes(model.unit()) +
                                     "; its numbers are taken as they are");
  }
}

RigidMotion read_pose(const DocumentNode& node) {
  RigidMotion pose;
  if (const auto rotation = node.find("rotation")) {
    rotation->expect_size(9);
    for (int k = 0; k < 9; ++k) pose.rotation[k % 3][k / 3] = (*rotation)[to_size(k)].number();
  }
  if (const auto translation = node.find("translation")) pose.translation = translation->vector();
  return pose;
}

/// Places the parts from `first` on as the list says, after those instances that were before.
void place_instances(const DocumentNode& list, int first, std::size_t before, Model& model) {
  const std::vector<Instance> all = model.instances();
  model.clear_instances();
  for (std::size_t i = 0; i < before; ++i) model.add_instance(all[i].part, all[i].pose);
  const int parts = int(model.parts().size()) - first;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const DocumentNode node = list[i];
    node.expect_keys("instance", {"part", "rotation", "translation"});
    const int part = node.at("part").integer(0, parts - 1);
    const RigidMotion pose = read_pose(node);
    node.placed([&] { model.add_instance(first + part, pose); });
  }
}

}  // namespace

void read_document(const std::string& file, std::string_view data, DocumentEncoding encoding,
                   Model& model, const ReadOptions& options) {
  options.progress.check();
  const DocumentValue tree =
      encoding == DocumentEncoding::json ? parse_json(file, data) : parse_cbor(file, data);
  DocumentNotes notes(file, options.progress);
  const DocumentNode root(tree, notes);
  check_header(root);

  Model grown = model;
  take_unit(root, grown);
  const int first = int(grown.parts().size());
  const std::size_t before = grown.instances().size();
  const DocumentNode parts = root.at("parts");
  PartReader reader(options);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Part part = reader.read(parts[i], "part " + std::to_string(i));
    parts[i].placed(
        [&] { grown.add_part(std::move(part), options.smooth_angle, options.progress); });
  }
  if (const auto instances = root.find("instances")) {
    place_instances(*instances, first, before, grown);
  }
  options.progress.check();
  model = std::move(grown);
}

}  // namespace taut
