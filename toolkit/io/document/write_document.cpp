#include "taut/io/document/write_document.h"

#include <array>
#include <cmath>

#include "taut/core/integers.h"
#include "taut/io/document/document_encoder.h"
#include "taut/io/document/document_format.h"
#include "taut/io/document/joined_pieces.h"
#include "taut/io/text/formats.h"
#include "taut/io/text/whole_file.h"

namespace taut {
namespace {

/// A coordinate x with x * w, rounded, `ulps` doubles below the homogeneous one; zero wherever
/// there is one.
struct Quotient {
  double x = 0;
  int ulps = 0;
};

Quotient quotient(double homogeneous, double w) {
  const double x = homogeneous / w;
  if (!std::isfinite(x)) throw InvalidInput("a control point's coordinate overflows");
  for (const double near : {x, std::nextafter(x, -infinity), std::nextafter(x, infinity)}) {
    if (near * w == homogeneous) return {near, 0};
  }
  double below = x * w;
  double above = below;
  for (int steps = 1; steps <= max_document_ulps; ++steps) {
    below = std::nextafter(below, -infinity);
    above = std::nextafter(above, infinity);
    if (above == homogeneous) return {x, steps};
    if (below == homogeneous) return {x, -steps};
  }
  return {x, 0};
}

/// Writes a model to an encoder.
class ModelWriter {
 public:
  explicit ModelWriter(DocumentEncoder& out) : out_(out) {}

  void write(const Model& model);

 private:
  void write(const Part& part);
  void write(const NurbsSurface& surface);
  void write(const NurbsCurve& curve, int dimension);
  void write(const std::vector<TrimLoop>& loops);
  void write(const Instance& instance);
  void write_surface(const Part& part, int index);
  void write_vertices(const Part& part);
  void write_cages(const Part& part);
  void write_polygons(const Part& part);
  void write(const ControlCage& cage);
  void write_tags(const ControlCage& cage);
  void write_points(const std::vector<dvec3>& points, std::size_t count);
  void write_faces(const std::vector<std::vector<int>>& faces);
  void integers(const std::vector<int>& values);

  void begin_list(std::string_view key, std::size_t count);
  void numbers(const std::vector<double>& values);
  void vector(const dvec3& x);
  void begin_points();
  /// The index-th point since begin_points().
  void point(const dvec4& p, int dimension, bool weight, std::size_t index);
  /// What is left over of the points.
  void end_points(int dimension);

  struct Ulps {
    std::size_t index = 0;
    std::array<int, 3> steps = {};
  };

  DocumentEncoder& out_;
  std::vector<Ulps> ulps_;
};

bool has_weights(const std::vector<dvec4>& points) {
  for (const dvec4& p : points) {
    if (p.w != 1) return true;
  }
  return false;
}

void ModelWriter::write(const Model& model) {
  out_.begin_object();
  out_.key("format");
  out_.text(document_format);
  out_.key("version");
  out_.integer(document_version);
  if (!model.unit().empty()) {
    out_.key("unit");
    out_.text(model.unit());
  }
  begin_list("parts", model.parts().size());
  for (const Part& part : model.parts()) {
    out_.line();
    write(part);
  }
  out_.end_array();
  begin_list("instances", model.instances().size());
  for (const Instance& instance : model.instances()) {
    out_.line();
    write(instance);
  }
  out_.end_array();
  out_.end_object();
}

void ModelWriter::write(const Part& part) {
  out_.begin_object();
  out_.key("name");
  out_.text(part.name);
  std::vector<int> surfaces;
  for (int i = 0; i < int(part.faces().size()); ++i) {
    if (part.faces()[to_size(i)].cage < 0) surfaces.push_back(i);
  }
  if (!surfaces.empty()) {
    begin_list("surfaces", surfaces.size());
    for (const int i : surfaces) write_surface(part, i);
    out_.end_array();
  }
  std::vector<const Edge*> free;
  for (const Edge& edge : part.edges()) {
    if (edge.faces.empty()) free.push_back(&edge);
  }
  if (!free.empty()) {
    begin_list("edges", free.size());
    for (const Edge* edge : free) {
      out_.line();
      out_.begin_object();
      out_.key("name");
      out_.text(edge->name);
      write(joined_pieces(part, *edge), 3);
      out_.end_object();
    }
    out_.end_array();
  }
  if (part.polygons().empty() && part.point_count() > 0) write_vertices(part);
  if (!part.polygons().empty() || !part.cages().empty()) write_cages(part);
  out_.end_object();
}

void ModelWriter::write_surface(const Part& part, int index) {
  const Face& face = part.faces()[to_size(index)];
  out_.line();
  out_.begin_object();
  out_.key("id");
  out_.integer(index);
  out_.key("name");
  out_.text(face.name);
  write(joined_patches(part, face));
  if (!face.loops.empty()) write(face.loops);
  out_.end_object();
}

void ModelWriter::write(const NurbsSurface& surface) {
  out_.key("degree");
  out_.begin_array(2);
  out_.integer(surface.degree_u);
  out_.integer(surface.degree_v);
  out_.end_array();
  out_.line();
  out_.key("knots");
  out_.begin_array(2);
  numbers(surface.knots_u);
  numbers(surface.knots_v);
  out_.end_array();
  const auto columns = to_size(surface.count_v());
  const bool weights = has_weights(surface.points);
  begin_list("points", to_size(surface.count_u()));
  begin_points();
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    if (i % columns == 0) {
      out_.line();
      out_.begin_array(columns);
    }
    point(surface.points[i], 3, weights, i);
    if (i % columns == columns - 1) out_.end_array();
  }
  out_.end_array();
  end_points(3);
}

void ModelWriter::write(const NurbsCurve& curve, int dimension) {
  out_.key("degree");
  out_.integer(curve.degree);
  out_.key("knots");
  numbers(curve.knots);
  const bool weights = has_weights(curve.points);
  begin_list("points", curve.points.size());
  begin_points();
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    point(curve.points[i], dimension, weights, i);
  }
  out_.end_array();
  end_points(dimension);
}

void ModelWriter::write(const std::vector<TrimLoop>& loops) {
  begin_list("loops", loops.size());
  for (const TrimLoop& loop : loops) {
    out_.line();
    out_.begin_array(loop.curves.size());
    for (const NurbsCurve& curve : loop.curves) {
      out_.line();
      out_.begin_object();
      write(curve, 2);
      out_.end_object();
    }
    out_.end_array();
  }
  out_.end_array();
}

void ModelWriter::write_vertices(const Part& part) {
  begin_list("vertices", to_size(part.point_count()));
  for (int i = 0; i < part.point_count(); ++i) {
    out_.line();
    vector(part.vertices()[to_size(i)]);
  }
  out_.end_array();
}

void ModelWriter::write_cages(const Part& part) {
  begin_list("cages", part.cages().size() + (part.polygons().empty() ? 0 : 1));
  if (!part.polygons().empty()) write_polygons(part);
  for (const CageOfPart& cage : part.cages()) write(*cage.cage);
  out_.end_array();
}

void ModelWriter::write_polygons(const Part& part) {
  out_.line();
  out_.begin_object();
  out_.key("scheme");
  out_.text("bilinear");
  write_points(part.vertices(), to_size(part.point_count()));
  write_faces(part.polygons());
  out_.end_object();
}

void ModelWriter::write(const ControlCage& cage) {
  out_.line();
  out_.begin_object();
  out_.key("scheme");
  out_.text(name_of(cage.scheme));
  out_.key("boundary");
  out_.text(name_of(cage.boundary));
  out_.key("crease_method");
  out_.text(cage.chaikin ? "chaikin" : "uniform");
  out_.key("triangle_rule");
  out_.text(cage.smooth_triangles ? "smooth" : "catmark");
  write_points(cage.points, cage.points.size());
  write_faces(cage.faces);
  write_tags(cage);
  out_.end_object();
}

void ModelWriter::write_tags(const ControlCage& cage) {
  if (!cage.creases.empty()) {
    begin_list("creases", cage.creases.size());
    for (const CageCrease& crease : cage.creases) {
      out_.begin_array(3);
      for (const int v : crease.vertices) out_.integer(v);
      out_.number(crease.sharpness);
      out_.end_array();
    }
    out_.end_array();
  }
  if (!cage.corners.empty()) {
    begin_list("corners", cage.corners.size());
    for (const CageCorner& corner : cage.corners) {
      out_.begin_array(2);
      out_.integer(corner.vertex);
      out_.number(corner.sharpness);
      out_.end_array();
    }
    out_.end_array();
  }
  if (cage.holes.empty()) return;
  out_.line();
  out_.key("holes");
  integers(cage.holes);
}

void ModelWriter::write_points(const std::vector<dvec3>& points, std::size_t count) {
  begin_list("points", count);
  for (std::size_t i = 0; i < count; ++i) {
    out_.line();
    vector(points[i]);
  }
  out_.end_array();
}

void ModelWriter::write_faces(const std::vector<std::vector<int>>& faces) {
  begin_list("faces", faces.size());
  for (const std::vector<int>& face : faces) {
    out_.line();
    integers(face);
  }
  out_.end_array();
}

void ModelWriter::integers(const std::vector<int>& values) {
  out_.begin_array(values.size());
  for (const int value : values) out_.integer(value);
  out_.end_array();
}

void ModelWriter::write(const Instance& instance) {
  out_.begin_object();
  out_.key("part");
  out_.integer(instance.part);
  out_.key("rotation");
  out_.begin_array(9);
  for (int k = 0; k < 9; ++k) out_.number(instance.pose.rotation[k % 3][k / 3]);
  out_.end_array();
  out_.key("translation");
  vector(instance.pose.translation);
  out_.end_object();
}

void ModelWriter::begin_list(std::string_view key, std::size_t count) {
  out_.line();
  out_.key(key);
  out_.begin_array(count);
}

void ModelWriter::numbers(const std::vector<double>& values) {
  out_.begin_array(values.size());
  for (const double value : values) out_.number(value);
  out_.end_array();
}

void ModelWriter::vector(const dvec3& x) { numbers({x.x, x.y, x.z}); }

void ModelWriter::begin_points() { ulps_.clear(); }

void ModelWriter::point(const dvec4& p, int dimension, bool weight, std::size_t index) {
  Ulps left;
  left.index = index;
  out_.begin_array(to_size(dimension) + (weight ? 1 : 0));
  for (int i = 0; i < dimension; ++i) {
    const Quotient q = quotient(p[i], p.w);
    out_.number(q.x);
    left.steps[to_size(i)] = q.ulps;
  }
  if (weight) out_.number(p.w);
  out_.end_array();
  if (left.steps != std::array<int, 3>{}) ulps_.push_back(left);
}

void ModelWriter::end_points(int dimension) {
  if (ulps_.empty()) return;
  begin_list("ulps", ulps_.size());
  for (const Ulps& ulps : ulps_) {
    out_.begin_array(1 + to_size(dimension));
    out_.integer(std::int64_t(ulps.index));
    for (int i = 0; i < dimension; ++i) out_.integer(ulps.steps[to_size(i)]);
    out_.end_array();
  }
  out_.end_array();
}

}  // namespace

std::string to_document(const Model& model, DocumentEncoding encoding) {
  const std::unique_ptr<DocumentEncoder> encoder = make_encoder(encoding);
  ModelWriter(*encoder).write(model);
  return encoder->take();
}

void write_model(const std::filesystem::path& path, const Model& model) {
  const std::string kind = extension(path);
  if (kind != ".taut.json" && kind != ".taut.cbor") {
    throw IoError(path.string() + ": a model is written as .taut.json or .taut.cbor only");
  }
  write_whole_file(path, to_document(model, kind == ".taut.json" ? DocumentEncoding::json
                                                                 : DocumentEncoding::cbor));
}

}  // namespace taut
