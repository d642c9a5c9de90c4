#include "taut/io/document/write_hull.h"

#include "taut/io/document/document_encoder.h"
#include "taut/io/document/document_tree.h"
#include "taut/io/document/hull_document_format.h"
#include "taut/io/text/formats.h"
#include "taut/io/text/whole_file.h"

namespace taut {
namespace {

template <class Kind>
std::string name_of(const std::array<std::string_view, 3>& names, Kind kind) {
  return std::string(names[std::size_t(kind)]);
}

/// Writes a hull document to an encoder.
class HullWriter {
 public:
  HullWriter(DocumentEncoder& out, const HullDocument& hull) : out_(out), hull_(hull) {}

  void write();

 private:
  void write(const HullDocument::Source& source);
  void write(const HullDocument::Patch& patch);
  void write(const HullDocument::Face& face, int id);
  void write(const HullDocument::Loop& loop);
  void write(const HullDocument::Region& region);
  void write(const HullDocument::Ruling& ruling);
  void write(const HullDocument::Contact& contact);
  void write(const HullDocument::Side& side);
  void write(const HullDocument::Curve& curve, int id);
  void write(const std::vector<HullDocument::DirectedCurve>& curves);
  void write(const std::vector<int>& side);

  void begin_list(std::string_view key, std::size_t count, bool on_new_line = true) {
    if (on_new_line) out_.line();
    out_.key(key);
    out_.begin_array(count);
  }
  /// A list whose elements each take a line.
  template <class Element>
  void list(std::string_view key, const std::vector<Element>& elements) {
    begin_list(key, elements.size());
    for (const Element& element : elements) {
      out_.line();
      write(element);
    }
    out_.end_array();
  }
  void text(std::string_view key, const std::string& value) {
    out_.key(key);
    out_.text(value);
  }
  void integer(std::string_view key, int value) {
    out_.key(key);
    out_.integer(value);
  }
  void numbers(const std::vector<double>& values) {
    out_.begin_array(values.size());
    for (const double value : values) out_.number(value);
    out_.end_array();
  }
  void vector(const dvec3& x) { numbers({x.x, x.y, x.z}); }
  void points(std::string_view key, const std::vector<dvec3>& points) {
    begin_list(key, points.size());
    for (const dvec3& p : points) vector(p);
    out_.end_array();
  }
  void points(const std::vector<dvec2>& points) {
    out_.begin_array(points.size());
    for (const dvec2& p : points) numbers({p.x, p.y});
    out_.end_array();
  }
  void source_of(int place) {
    if (place >= 0) integer("source", hull_.sources[std::size_t(place)].id);
  }

  DocumentEncoder& out_;
  const HullDocument& hull_;
};

void HullWriter::write() {
  out_.begin_object();
  text("format", std::string(hull_format));
  integer("version", hull_version);
  out_.line();
  out_.key("diagonal");
  out_.number(hull_.diagonal);
  integer("dimension", hull_.dimension);
  list("sources", hull_.sources);
  begin_list("faces", hull_.faces.size());
  for (std::size_t i = 0; i < hull_.faces.size(); ++i) write(hull_.faces[i], int(i));
  out_.end_array();
  begin_list("curves", hull_.curves.size());
  for (std::size_t i = 0; i < hull_.curves.size(); ++i) write(hull_.curves[i], int(i));
  out_.end_array();
  if (!hull_.report.empty()) {
    out_.line();
    out_.key("report");
    write_value(out_, parse_json("report", hull_.report));
  }
  out_.end_object();
}

void HullWriter::write(const HullDocument::Source& source) {
  out_.begin_object();
  integer("id", source.id);
  text("kind", name_of(source_kind_names, source.kind));
  text("file", source.file);
  text("name", source.name);
  list("patches", source.patches);
  out_.end_object();
}

void HullWriter::write(const HullDocument::Patch& patch) {
  out_.begin_object();
  out_.key("domain");
  out_.begin_array(patch.domain.size());
  for (const Interval& i : patch.domain) numbers({i.lower, i.upper});
  out_.end_array();
  begin_list("points", std::size_t(patch.rows), false);
  std::size_t i = 0;
  for (int row = 0; row < patch.rows; ++row) {
    out_.begin_array(std::size_t(patch.columns));
    for (int column = 0; column < patch.columns; ++column, ++i) {
      const dvec4& p = patch.points[i];
      numbers({p.x, p.y, p.z, p.w});
    }
    out_.end_array();
  }
  out_.end_array();
  out_.end_object();
}

void HullWriter::write(const HullDocument::Face& face, int id) {
  out_.line();
  out_.begin_object();
  integer("id", id);
  text("kind", name_of(face_kind_names, face.kind));
  source_of(face.source);
  if (face.tolerant > 0) {
    out_.key("tolerant");
    out_.number(face.tolerant);
  }
  if (face.kind == FaceKind::patch) {
    list("loops", face.loops);
    list("regions", face.regions);
  } else if (face.kind == FaceKind::scroll) {
    out_.key("curves");
    out_.begin_array(2);
    for (const std::vector<int>& side : face.curves) write(side);
    out_.end_array();
    list("rulings", face.rulings);
  } else {
    out_.key("normal");
    vector(face.normal);
    out_.key("offset");
    out_.number(face.offset);
    list("contacts", face.contacts);
    if (!face.sides.empty()) list("sides", face.sides);
    out_.line();
    out_.key("curves");
    write(face.outline);
    points("boundary", face.boundary);
  }
  out_.end_object();
}

void HullWriter::write(const HullDocument::Loop& loop) {
  out_.begin_object();
  out_.key("curves");
  write(loop.curves);
  out_.key("uv");
  points(loop.uv);
  out_.end_object();
}

void HullWriter::write(const HullDocument::Region& region) {
  out_.begin_object();
  integer("patch", region.patch);
  integer("sign", region.sign);
  begin_list("loops", region.loops.size(), false);
  for (const std::vector<dvec2>& loop : region.loops) points(loop);
  out_.end_array();
  out_.end_object();
}

void HullWriter::write(const HullDocument::Ruling& ruling) {
  out_.begin_object();
  out_.key("n");
  vector(ruling.n);
  out_.key("a");
  write(ruling.a);
  out_.key("b");
  write(ruling.b);
  out_.end_object();
}

void HullWriter::write(const HullDocument::Contact& contact) {
  out_.begin_object();
  source_of(contact.source);
  out_.key("uv");
  numbers(contact.uv);
  out_.key("p");
  vector(contact.p);
  out_.end_object();
}

void HullWriter::write(const HullDocument::Side& side) {
  if (side.source < 0) {
    out_.null();
    return;
  }
  out_.begin_object();
  source_of(side.source);
  out_.key("from");
  numbers(side.from);
  out_.key("to");
  numbers(side.to);
  out_.end_object();
}

void HullWriter::write(const HullDocument::Curve& curve, int id) {
  out_.line();
  out_.begin_object();
  integer("id", id);
  text("kind", std::string(curve_kind_names[std::size_t(curve.kind)]));
  out_.key("faces");
  out_.begin_array(2);
  for (const int face : curve.faces) out_.integer(face);
  out_.end_array();
  source_of(curve.source);
  points("points", curve.points);
  out_.end_object();
}

void HullWriter::write(const std::vector<HullDocument::DirectedCurve>& curves) {
  out_.begin_array(curves.size());
  for (const auto& [curve, sense] : curves) {
    out_.begin_array(2);
    out_.integer(curve);
    out_.integer(sense);
    out_.end_array();
  }
  out_.end_array();
}

/// A side of a scroll: null, a curve, or a list of curves.
void HullWriter::write(const std::vector<int>& side) {
  if (side.empty()) return out_.null();
  if (side.size() == 1) return out_.integer(side[0]);
  out_.begin_array(side.size());
  for (const int curve : side) out_.integer(curve);
  out_.end_array();
}

}  // namespace

std::string to_document(const HullDocument& hull, DocumentEncoding encoding) {
  const std::unique_ptr<DocumentEncoder> encoder = make_encoder(encoding);
  HullWriter(*encoder, hull).write();
  return encoder->take();
}

void write_hull(const std::filesystem::path& path, const HullDocument& hull) {
  const std::string kind = extension(path);
  if (kind != ".hull.json" && kind != ".hull.cbor") {
    throw IoError(path.string() + ": an exact hull is written as .hull.json or .hull.cbor only");
  }
  write_whole_file(path, to_document(hull, kind == ".hull.json" ? DocumentEncoding::json
                                                                : DocumentEncoding::cbor));
}

}  // namespace taut
