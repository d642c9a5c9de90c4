#include "taut/io/document/read_hull.h"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>

#include "taut/core/tolerances.h"
#include "taut/io/document/document_encoder.h"
#include "taut/io/document/document_node.h"
#include "taut/io/document/hull_document_format.h"
#include "taut/io/text/formats.h"
#include "taut/io/text/text_scanner.h"
#include "taut/surface/bezier.h"

namespace taut {
namespace {

constexpr int most_id = std::numeric_limits<int>::max();

/// Ids as they stand in the file, and the places of what has them.
using Ids = std::map<int, int>;

template <std::size_t count>
int read_kind(const DocumentNode& node, const std::array<std::string_view, count>& names) {
  const auto found = std::find(names.begin(), names.end(), node.string());
  if (found == names.end()) node.fail(in_quotes(node.string()) + " is no kind of this");
  return int(found - names.begin());
}

Ids read_ids(const DocumentNode& list, const char* what) {
  Ids ids;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const DocumentNode element = list[i];
    const DocumentNode id = element.at("id");
    if (!ids.emplace(id.integer(0, most_id), int(i)).second) {
      id.refuse("another " + std::string(what) + " has this id");
    }
  }
  return ids;
}

int reference(const DocumentNode& node, const Ids& ids, const char* what) {
  const int id = node.integer(0, most_id);
  const auto found = ids.find(id);
  if (found == ids.end()) {
    node.refuse("no " + std::string(what) + " has the id " + std::to_string(id));
  }
  return found->second;
}

std::vector<dvec2> read_parameters(const DocumentNode& list) {
  std::vector<dvec2> points(list.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const DocumentNode point = list[i];
    point.expect_size(2);
    points[i] = {point[0].number(), point[1].number()};
  }
  return points;
}

/// Elsewhere than in a report keys are known ones.
void require_plain_keys(const DocumentNode& node, const DocumentValue& value) {
  if (const auto* array = std::get_if<DocumentValue::Array>(&value.value)) {
    for (const DocumentValue& element : *array) require_plain_keys(node, element);
  } else if (const auto* object = std::get_if<DocumentValue::Object>(&value.value)) {
    for (const DocumentMember& member : *object) {
      const bool plain = std::all_of(member.key.begin(), member.key.end(), [](char c) {
        return c >= 0x20 && c < 0x7f && c != '"' && c != '\\';
      });
      if (!plain) node.fail("the key " + in_quotes(member.key) + " is no plain text");
      require_plain_keys(node, member.value);
    }
  }
}

/// Reads one document.
class HullReader {
 public:
  HullDocument read(const DocumentNode& root);

 private:
  HullDocument::Source read_source(const DocumentNode& node) const;
  HullDocument::Face read_face(const DocumentNode& node) const;
  void read_patch(const DocumentNode& node, HullDocument::Face& face) const;
  void read_scroll(const DocumentNode& node, HullDocument::Face& face) const;
  void read_facet(const DocumentNode& node, HullDocument::Face& face) const;
  HullDocument::Contact read_contact(const DocumentNode& node) const;
  /// A source's parameters.
  std::vector<double> read_place(const DocumentNode& list, int source) const;
  HullDocument::Side read_facet_side(const DocumentNode& node) const;
  HullDocument::Curve read_curve(const DocumentNode& node) const;
  std::vector<HullDocument::DirectedCurve> read_curves(const DocumentNode& list) const;
  std::vector<int> read_side(const DocumentNode& node) const;
  int read_source_of(const DocumentNode& node) const;

  HullDocument hull_;
  Ids sources_, faces_, curves_;
};

void check_hull_header(const DocumentNode& root) {
  root.expect_keys("document", {"format", "version", "diagonal", "dimension", "sources", "faces",
                                "curves", "report"});
  if (root.at("format").string() != hull_format) {
    root.at("format").fail("this is no hull document: \"taut-hull\" expected");
  }
  const int version = root.at("version").integer(std::numeric_limits<int>::min(), most_id);
  if (version != hull_version) {
    root.at("version").fail("version " + std::to_string(version) + " is not known, only " +
                            std::to_string(hull_version));
  }
}

HullDocument HullReader::read(const DocumentNode& root) {
  check_hull_header(root);
  const DocumentNode diagonal = root.at("diagonal");
  hull_.diagonal = diagonal.number();
  if (hull_.diagonal < 0) diagonal.refuse("is negative");
  hull_.dimension = root.at("dimension").integer(0, 3);
  const DocumentNode sources = root.at("sources");
  const DocumentNode faces = root.at("faces");
  const DocumentNode curves = root.at("curves");
  sources_ = read_ids(sources, "source");
  faces_ = read_ids(faces, "face");
  curves_ = read_ids(curves, "curve");
  for (std::size_t i = 0; i < sources.size(); ++i) {
    root.notes().progress().check();
    hull_.sources.push_back(read_source(sources[i]));
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    root.notes().progress().update("read", double(i) / double(faces.size()));
    hull_.faces.push_back(read_face(faces[i]));
  }
  for (std::size_t i = 0; i < curves.size(); ++i) hull_.curves.push_back(read_curve(curves[i]));
  if (const auto report = root.find("report")) {
    if (!std::holds_alternative<DocumentValue::Object>(report->value().value)) {
      report->fail("an object expected");
    }
    require_plain_keys(*report, report->value());
    const std::unique_ptr<DocumentEncoder> out = make_encoder(DocumentEncoding::json);
    write_value(*out, report->value());
    hull_.report = out->take();
  }
  return std::move(hull_);
}

std::string text_of(const DocumentNode& node, std::string_view key) {
  const auto text = node.find(key);
  return text ? text->string() : "";
}

HullDocument::Patch read_bezier(const DocumentNode& node, std::size_t parameters) {
  node.expect_keys("patch", {"domain", "points"});
  HullDocument::Patch patch;
  const DocumentNode domain = node.at("domain");
  domain.expect_size(parameters);
  for (std::size_t i = 0; i < parameters; ++i) {
    const DocumentNode interval = domain[i];
    interval.expect_size(2);
    patch.domain.push_back({interval[0].number(), interval[1].number()});
    if (!(patch.domain[i].lower < patch.domain[i].upper)) interval.refuse("is no interval");
  }
  const DocumentNode rows = node.at("points");
  const auto check_count = [&](const DocumentNode& list, bool varies) {
    const std::size_t count = list.size();
    const bool valid = varies ? 2 <= count && count <= std::size_t(max_degree) + 1 : count == 1;
    if (!valid) list.refuse(std::to_string(count) + " control points in one direction");
    return int(count);
  };
  patch.rows = check_count(rows, parameters == 2);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const DocumentNode row = rows[i];
    const int columns = check_count(row, parameters > 0);
    if (i > 0 && columns != patch.columns) row.refuse("another number of points than above");
    patch.columns = columns;
    for (std::size_t j = 0; j < row.size(); ++j) {
      const DocumentNode point = row[j];
      point.expect_size(4);
      dvec4 p(0.0);
      for (std::size_t k = 0; k < 4; ++k) p[int(k)] = point[k].number();
      if (!(p.w > 0)) point[3].refuse("the weight is not positive");
      patch.points.push_back(p);
    }
  }
  // As homogeneous points, which may overflow.
  node.placed([&] {
    std::vector<dvec4> points;
    for (const dvec4& p : patch.points) points.push_back(homogeneous(dvec3(p), p.w));
    validate_points(points, "the control net");
  });
  return patch;
}

HullDocument::Source HullReader::read_source(const DocumentNode& node) const {
  node.expect_keys("source", {"id", "kind", "file", "name", "patches"});
  HullDocument::Source source;
  source.id = node.at("id").integer(0, most_id);
  source.kind = SourceKind(read_kind(node.at("kind"), source_kind_names));
  source.file = text_of(node, "file");
  source.name = text_of(node, "name");
  const DocumentNode patches = node.at("patches");
  const std::size_t parameters = 2 - std::size_t(source.kind);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    source.patches.push_back(read_bezier(patches[i], parameters));
  }
  return source;
}

HullDocument::Face HullReader::read_face(const DocumentNode& node) const {
  HullDocument::Face face;
  face.kind = FaceKind(read_kind(node.at("kind"), face_kind_names));
  face.source = read_source_of(node);
  if (const auto tolerant = node.find("tolerant")) {
    face.tolerant = tolerant->number();
    if (face.tolerant < 0) tolerant->refuse("is negative");
  }
  if (face.kind == FaceKind::patch) read_patch(node, face);
  if (face.kind == FaceKind::scroll) read_scroll(node, face);
  if (face.kind == FaceKind::facet) read_facet(node, face);
  return face;
}

void HullReader::read_patch(const DocumentNode& node, HullDocument::Face& face) const {
  node.expect_keys("patch", {"id", "kind", "source", "tolerant", "loops", "regions"});
  if (face.source < 0 || hull_.sources[std::size_t(face.source)].kind != SourceKind::face) {
    node.refuse("a patch lies on a source of the kind \"face\"");
  }
  const DocumentNode loops = node.at("loops");
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const DocumentNode loop = loops[i];
    loop.expect_keys("loop", {"curves", "uv"});
    face.loops.push_back({read_curves(loop.at("curves")), read_parameters(loop.at("uv"))});
  }
  const auto regions = node.find("regions");
  const std::size_t patches = hull_.sources[std::size_t(face.source)].patches.size();
  for (std::size_t i = 0; regions && i < regions->size(); ++i) {
    const DocumentNode own = (*regions)[i];
    own.expect_keys("region", {"patch", "sign", "loops"});
    HullDocument::Region& region = face.regions.emplace_back();
    region.patch = own.at("patch").integer(0, int(patches) - 1);
    region.sign = own.at("sign").integer(-1, 1);
    if (region.sign == 0) own.at("sign").refuse("is neither 1 nor -1");
    const DocumentNode outlines = own.at("loops");
    for (std::size_t k = 0; k < outlines.size(); ++k) {
      region.loops.push_back(read_parameters(outlines[k]));
    }
  }
}

void HullReader::read_scroll(const DocumentNode& node, HullDocument::Face& face) const {
  node.expect_keys("scroll", {"id", "kind", "source", "tolerant", "curves", "rulings"});
  const DocumentNode curves = node.at("curves");
  curves.expect_size(2);
  for (std::size_t k = 0; k < 2; ++k) face.curves[k] = read_side(curves[k]);
  const DocumentNode rulings = node.at("rulings");
  for (std::size_t i = 0; i < rulings.size(); ++i) {
    const DocumentNode ruling = rulings[i];
    ruling.expect_keys("ruling", {"n", "a", "b"});
    face.rulings.push_back(
        {ruling.at("n").vector(), read_contact(ruling.at("a")), read_contact(ruling.at("b"))});
  }
}

void HullReader::read_facet(const DocumentNode& node, HullDocument::Face& face) const {
  node.expect_keys("facet", {"id", "kind", "source", "tolerant", "normal", "offset", "contacts",
                             "sides", "curves", "boundary"});
  face.normal = node.at("normal").vector();
  face.offset = node.at("offset").number();
  const DocumentNode contacts = node.at("contacts");
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    face.contacts.push_back(read_contact(contacts[i]));
  }
  if (const auto sides = node.find("sides")) {
    sides->expect_size(face.contacts.size());
    for (std::size_t i = 0; i < sides->size(); ++i) {
      face.sides.push_back(read_facet_side((*sides)[i]));
    }
  }
  if (const auto curves = node.find("curves")) face.outline = read_curves(*curves);
  face.boundary = node.at("boundary").vectors();
}

HullDocument::Contact HullReader::read_contact(const DocumentNode& node) const {
  node.expect_keys("contact", {"source", "uv", "p"});
  HullDocument::Contact contact;
  contact.source = reference(node.at("source"), sources_, "source");
  contact.uv = read_place(node.at("uv"), contact.source);
  contact.p = node.at("p").vector();
  return contact;
}

std::vector<double> HullReader::read_place(const DocumentNode& list, int source) const {
  list.expect_size(2 - std::size_t(hull_.sources[std::size_t(source)].kind));
  std::vector<double> parameters;
  for (std::size_t i = 0; i < list.size(); ++i) parameters.push_back(list[i].number());
  return parameters;
}

HullDocument::Side HullReader::read_facet_side(const DocumentNode& node) const {
  if (node.is_null()) return {};
  node.expect_keys("side", {"source", "from", "to"});
  HullDocument::Side side;
  side.source = reference(node.at("source"), sources_, "source");
  side.from = read_place(node.at("from"), side.source);
  side.to = read_place(node.at("to"), side.source);
  if (side.from.empty()) node.at("source").refuse("a vertex has no curves");
  return side;
}

HullDocument::Curve HullReader::read_curve(const DocumentNode& node) const {
  node.expect_keys("curve", {"id", "kind", "faces", "source", "points"});
  HullDocument::Curve curve;
  curve.kind = HullCurveKind(read_kind(node.at("kind"), curve_kind_names));
  const DocumentNode faces = node.at("faces");
  faces.expect_size(2);
  for (std::size_t k = 0; k < 2; ++k) {
    const bool missing = faces[k].integer(-1, most_id) < 0;
    curve.faces[k] = missing ? -1 : reference(faces[k], faces_, "face");
  }
  curve.source = read_source_of(node);
  curve.points = node.at("points").vectors();
  if (curve.points.size() < 2) node.at("points").refuse("a curve has two points at least");
  return curve;
}

std::vector<HullDocument::DirectedCurve> HullReader::read_curves(const DocumentNode& list) const {
  std::vector<HullDocument::DirectedCurve> curves;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const DocumentNode pair = list[i];
    pair.expect_size(2);
    const int sense = pair[1].integer(-1, 1);
    if (sense == 0) pair[1].refuse("is neither 1 nor -1");
    curves.emplace_back(reference(pair[0], curves_, "curve"), sense);
  }
  return curves;
}

std::vector<int> HullReader::read_side(const DocumentNode& node) const {
  if (node.is_null()) return {};
  if (!node.is_array()) return {reference(node, curves_, "curve")};
  std::vector<int> side;
  for (std::size_t i = 0; i < node.size(); ++i) {
    side.push_back(reference(node[i], curves_, "curve"));
  }
  return side;
}

int HullReader::read_source_of(const DocumentNode& node) const {
  const auto source = node.find("source");
  return source && !source->is_null() ? reference(*source, sources_, "source") : -1;
}

}  // namespace

HullDocument read_hull(std::string_view data, const std::string& name, DocumentEncoding encoding,
                       const Progress& progress) {
  progress.check();
  const DocumentValue tree =
      encoding == DocumentEncoding::json ? parse_json(name, data) : parse_cbor(name, data);
  DocumentNotes notes(name, progress);
  return HullReader().read(DocumentNode(tree, notes));
}

HullDocument read_hull(const std::filesystem::path& path, const Progress& progress) {
  const std::string kind = input_extension(path);
  if (kind != ".hull.json" && kind != ".hull.cbor") {
    throw IoError(path.string() + ": a hull document is a .hull.json or .hull.cbor");
  }
  const std::string data = read_file(path);
  return read_hull(data, path.string(),
                   kind == ".hull.json" ? DocumentEncoding::json : DocumentEncoding::cbor,
                   progress);
}

}  // namespace taut
