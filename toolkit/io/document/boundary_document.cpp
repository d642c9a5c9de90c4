#include "taut/io/document/boundary_document.h"

#include <algorithm>

#include "taut/bounds/contact_geometry.h"
#include "taut/core/integers.h"
#include "taut/hull/result/hull_sources.h"

namespace taut {
namespace {

using DirectedCurve = HullDocument::DirectedCurve;

/// Segments of a stretch of a patch's border.
constexpr int border_segments = 8;

/// Curves meet in the same points but for rounding; what is farther apart, in the scene's frame, is
/// no outline.
constexpr double outline_gap = 1e-6;

/// A contact in the terms of the element that it is expressed in, on its border or not: a point of
/// an edge as its neighbouring faces have it may be another one by join_distance. Seams and their
/// vertices are no sources.
SourceContact place_of(const Scene& scene, const Contact& c) {
  const Model& model = scene.model();
  const Part& part = model.parts()[to_size(model.instances()[to_size(c.instance)].part)];
  const auto made = [&](int index, double u, double v) {
    return SourceContact{model.source_id({c.kind, c.instance, index}), c.kind, u, v};
  };
  if (c.kind == SourceKind::vertex) {
    const bool of_seam = c.element >= int(part.vertices().size()) - part.seam_vertex_count();
    return of_seam ? scene.source(c) : made(c.element, 0, 0);
  }
  if (c.kind == SourceKind::edge) {
    const EdgePiece& piece = part.pieces()[to_size(c.element)];
    if (piece.edge < 0) return scene.source(c);
    return made(piece.edge, piece.t.at(c.u), 0);
  }
  const Patch& patch = part.patches()[to_size(c.element)];
  return made(patch.face, patch.u.at(c.u), patch.v.at(c.v));
}

/// Makes the document of a boundary.
class DocumentMaker {
 public:
  DocumentMaker(const Scene& scene, const HullBoundary& boundary,
                const std::vector<std::string>& files)
      : scene_(scene),
        boundary_(boundary),
        geometry_(scene),
        sources_(scene.model(), files),
        curves_of_(boundary.faces.size()) {}

  HullDocument make();

 private:
  template <class Visit>
  void for_each_piece(const ArcRange& range, Visit visit) const;
  void collect_sources();
  HullDocument::Contact contact(const Contact& c, const dvec3& point) const;
  HullDocument::Side side(const EdgeStretch& stretch) const;
  dvec2 uv(const Contact& c) const;
  /// The contacts along a stretch of a region's outline, as it is directed there.
  std::vector<Contact> contacts(const PatchRegion& region, const TrimStretch& stretch) const;

  HullDocument::Face make_face(int index) const;
  void make_patch(const HullFace& face, HullDocument::Face& result) const;
  std::vector<dvec2> points(const PatchRegion& region, const TrimStretch& stretch) const;
  std::vector<dvec2> outline(const HullFace& face,
                             const std::vector<StretchPlace>& stretches) const;
  void make_scroll(const HullFace& face, HullDocument::Face& result) const;
  void make_facet(int index, HullDocument::Face& result) const;
  std::vector<DirectedCurve> facet_outline(int index) const;
  dvec3 end_of(const DirectedCurve& c, bool last) const {
    const std::vector<dvec3>& points = boundary_.curves[to_size(c.first)].points;
    return (c.second > 0) == last ? points.back() : points.front();
  }
  std::vector<dvec3> to_model(const std::vector<dvec3>& points) const {
    std::vector<dvec3> result;
    result.reserve(points.size());
    for (const dvec3& p : points) result.push_back(scene_.frame().to_model(p));
    return result;
  }

  const Scene& scene_;
  const HullBoundary& boundary_;
  ContactGeometry geometry_;
  HullSources sources_;
  std::vector<std::vector<DirectedCurve>> curves_of_;  ///< per face, with it to the left
};

HullDocument DocumentMaker::make() {
  for (std::size_t i = 0; i < boundary_.curves.size(); ++i) {
    const auto [left, right] = boundary_.curves[i].faces;
    if (left == right) continue;
    if (left >= 0) curves_of_[to_size(left)].emplace_back(int(i), 1);
    if (right >= 0) curves_of_[to_size(right)].emplace_back(int(i), -1);
  }
  collect_sources();
  HullDocument document;
  document.diagonal = scene_.diagonal();
  document.dimension = boundary_.dimension;
  document.sources = sources_.make();
  for (std::size_t i = 0; i < boundary_.faces.size(); ++i) {
    document.faces.push_back(make_face(int(i)));
  }
  for (const HullCurve& curve : boundary_.curves) {
    document.curves.push_back(
        {curve.kind, curve.faces, sources_.place(curve.source), to_model(curve.points)});
  }
  return document;
}

template <class Visit>
void DocumentMaker::for_each_piece(const ArcRange& range, Visit visit) const {
  if (range.arc < 0) return;
  const std::vector<ArcPiece>& pieces = boundary_.arcs[to_size(range.arc)].pieces;
  for (int k = 0; k < range.count; ++k) {
    visit(pieces[(to_size(range.first) + to_size(k)) % pieces.size()]);
  }
}

void DocumentMaker::collect_sources() {
  const auto add = [&](const Contact& c) { sources_.add(place_of(scene_, c).source); };
  for (const HullFace& face : boundary_.faces) {
    sources_.add(face.source);
    for (const Contact& c : face.contacts) add(c);
    for (const EdgeStretch& side : face.sides) {
      if (side.piece >= 0) add(side.at(side.from));
    }
    if (face.kind != FaceKind::scroll) continue;
    for_each_piece(face.scroll, [&](const ArcPiece& piece) {
      for (const Ruling& r : piece.rulings) {
        for (const Contact& c : r.contact) add(c);
      }
    });
  }
  for (const HullCurve& curve : boundary_.curves) sources_.add(curve.source);
  sources_.finish();
}

HullDocument::Contact DocumentMaker::contact(const Contact& c, const dvec3& point) const {
  const SourceContact place = place_of(scene_, c);
  HullDocument::Contact result{sources_.place(place.source), {}, scene_.frame().to_model(point)};
  if (place.kind == SourceKind::face) result.uv = {place.u, place.v};
  if (place.kind == SourceKind::edge) result.uv = {place.u};
  return result;
}

HullDocument::Side DocumentMaker::side(const EdgeStretch& stretch) const {
  if (stretch.piece < 0) return {};
  const HullDocument::Contact from = contact(stretch.at(stretch.from), dvec3(0.0));
  const HullDocument::Contact to = contact(stretch.at(stretch.to), dvec3(0.0));
  return {from.source, from.uv, to.uv};
}

dvec2 DocumentMaker::uv(const Contact& c) const {
  const SourceContact place = place_of(scene_, c);
  return {place.u, place.v};
}

std::vector<Contact> DocumentMaker::contacts(const PatchRegion& region,
                                             const TrimStretch& stretch) const {
  std::vector<Contact> result;
  if (stretch.arc >= 0) {
    const ArcPiece& piece = boundary_.arcs[to_size(stretch.arc)].pieces[to_size(stretch.piece)];
    for (const Ruling& r : piece.rulings) result.push_back(r.contact[to_size(stretch.contact)]);
    if (stretch.reversed) std::reverse(result.begin(), result.end());
    return result;
  }
  for (int k = 0; k <= border_segments; ++k) {
    const double s = double(k) / border_segments;
    const double t = k == border_segments ? stretch.to : (1 - s) * stretch.from + s * stretch.to;
    Contact c{region.instance, SourceKind::face, region.patch, t, t};
    if (stretch.side == Side::u0) c.u = 0;
    if (stretch.side == Side::u1) c.u = 1;
    if (stretch.side == Side::v0) c.v = 0;
    if (stretch.side == Side::v1) c.v = 1;
    result.push_back(c);
  }
  return result;
}

HullDocument::Face DocumentMaker::make_face(int index) const {
  const HullFace& face = boundary_.faces[to_size(index)];
  HullDocument::Face result;
  result.kind = face.kind;
  result.source = sources_.place(face.source);
  result.tolerant = scene_.frame().length_to_model(face.tolerant);
  if (face.kind == FaceKind::patch) make_patch(face, result);
  if (face.kind == FaceKind::scroll) make_scroll(face, result);
  if (face.kind == FaceKind::facet) make_facet(index, result);
  return result;
}

/// Appends points to a polyline that may end where they begin.
template <class Point>
void append(std::vector<Point>& line, const std::vector<Point>& points) {
  const bool repeated = !line.empty() && !points.empty() && line.back() == points.front();
  line.insert(line.end(), points.begin() + (repeated ? 1 : 0), points.end());
}

/// Takes out the last point of a closed polyline that is the first.
template <class Point>
void close(std::vector<Point>& line) {
  if (line.size() > 1 && line.front() == line.back()) line.pop_back();
}

std::vector<dvec2> DocumentMaker::points(const PatchRegion& region,
                                         const TrimStretch& stretch) const {
  std::vector<dvec2> line;
  for (const Contact& c : contacts(region, stretch)) line.push_back(uv(c));
  return line;
}

void DocumentMaker::make_patch(const HullFace& face, HullDocument::Face& result) const {
  const Model& model = scene_.model();
  for (const PatchRegion& region : face.regions) {
    const Part& part = model.parts()[to_size(model.instances()[to_size(region.instance)].part)];
    const int source_face = part.patches()[to_size(region.patch)].face;
    HullDocument::Region& own = result.regions.emplace_back();
    own.patch = region.patch - part.faces()[to_size(source_face)].first_patch;
    own.sign = region.sign;
    for (const std::vector<TrimStretch>& loop : region.loops) {
      std::vector<dvec2>& line = own.loops.emplace_back();
      for (const TrimStretch& stretch : loop) append(line, points(region, stretch));
      close(line);
    }
  }
  for (std::size_t k = 0; k < face.loops.size(); ++k) {
    result.loops.push_back({face.loops[k], outline(face, face.outlines[k])});
  }
}

std::vector<dvec2> DocumentMaker::outline(const HullFace& face,
                                          const std::vector<StretchPlace>& stretches) const {
  std::vector<dvec2> line;
  for (const StretchPlace& at : stretches) {
    const PatchRegion& region = face.regions[at.region];
    std::vector<dvec2> stretch = points(region, region.loops[at.loop][at.stretch]);
    // Seen from outside, a region that is passed from within lies to the right.
    if (region.sign < 0) std::reverse(stretch.begin(), stretch.end());
    append(line, stretch);
  }
  close(line);
  return line;
}

void DocumentMaker::make_scroll(const HullFace& face, HullDocument::Face& result) const {
  result.curves = face.scroll_curves;
  const auto same = [](const Contact& a, const Contact& b) {
    return a.instance == b.instance && a.kind == b.kind && a.element == b.element && a.u == b.u &&
           a.v == b.v;
  };
  const Ruling* last = nullptr;
  for_each_piece(face.scroll, [&](const ArcPiece& piece) {
    for (const Ruling& r : piece.rulings) {
      if (last != nullptr && last->n == r.n && same(last->contact[0], r.contact[0]) &&
          same(last->contact[1], r.contact[1])) {
        continue;
      }
      result.rulings.push_back(
          {r.n, contact(r.contact[0], r.point[0]), contact(r.contact[1], r.point[1])});
      last = &r;
    }
  });
}

void DocumentMaker::make_facet(int index, HullDocument::Face& result) const {
  const HullFace& face = boundary_.faces[to_size(index)];
  const SceneFrame& frame = scene_.frame();
  result.normal = face.n;
  result.offset = frame.length_to_model(face.offset) + glm::dot(face.n, frame.center);
  for (std::size_t i = 0; i < face.contacts.size(); ++i) {
    result.contacts.push_back(contact(face.contacts[i], face.points[i]));
  }
  result.sides.reserve(face.sides.size());
  for (const EdgeStretch& stretch : face.sides) result.sides.push_back(side(stretch));
  result.outline = facet_outline(index);
  if (result.outline.empty()) {
    result.boundary = to_model(face.points);
    return;
  }
  for (const DirectedCurve& c : result.outline) {
    std::vector<dvec3> points = to_model(boundary_.curves[to_size(c.first)].points);
    if (c.second < 0) std::reverse(points.begin(), points.end());
    if (!result.boundary.empty()) points.erase(points.begin());
    append(result.boundary, points);
  }
  // It ends where it began, to rounding.
  result.boundary.pop_back();
}

/// The curves about a facet in order; none unless they close.
std::vector<DirectedCurve> DocumentMaker::facet_outline(int index) const {
  std::vector<DirectedCurve> left = curves_of_[to_size(index)];
  std::vector<DirectedCurve> outline;
  while (!left.empty()) {
    auto next = left.begin();
    if (!outline.empty()) {
      const dvec3 at = end_of(outline.back(), true);
      const auto gap = [&](const DirectedCurve& c) { return glm::distance(end_of(c, false), at); };
      next = std::min_element(left.begin(), left.end(),
                              [&](const auto& a, const auto& b) { return gap(a) < gap(b); });
      if (!(gap(*next) < outline_gap)) return {};
    }
    outline.push_back(*next);
    left.erase(next);
  }
  if (outline.empty()) return {};
  const double gap = glm::distance(end_of(outline.back(), true), end_of(outline.front(), false));
  return gap < outline_gap ? outline : std::vector<DirectedCurve>();
}

}  // namespace

HullDocument hull_document(const Scene& scene, const HullBoundary& boundary,
                           const std::vector<std::string>& files) {
  return DocumentMaker(scene, boundary, files).make();
}

}  // namespace taut
