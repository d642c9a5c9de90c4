#include "taut/bounds/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <type_traits>

#include "taut/bounds/scene_content.h"
#include "taut/bounds/support_query.h"
#include "taut/core/error.h"
#include "taut/core/parallel.h"
#include "taut/surface/equal_parts.h"

namespace taut {
namespace {

const Box& box_of(const Box& box) { return box; }
Box box_of(const dvec3& point) { return {point, point}; }

/// Splits ranges of items, boxes or points, at the median of the longest axis; ties are ordered by
/// item.
template <class Item>
class BoxTreeBuilder {
 public:
  BoxTreeBuilder(std::span<const Item> items, BoxTree& tree) : boxes_(items), tree_(tree) {}

  void build() {
    tree_.items.resize(boxes_.size());
    std::iota(tree_.items.begin(), tree_.items.end(), 0);
    tree_.nodes.resize(1);
    fill(0, 0, boxes_.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      tree_.center[axis].reserve(boxes_.size());
      if (is_box) tree_.half[axis].reserve(boxes_.size());
    }
    for (const int item : tree_.items) {
      const BoxTree::Node bounds = enclosing(box(item));
      for (int axis = 0; axis < 3; ++axis) {
        tree_.center[std::size_t(axis)].push_back(bounds.center[axis]);
        if (is_box) tree_.half[std::size_t(axis)].push_back(bounds.half[axis]);
      }
    }
  }

 private:
  static constexpr bool is_box = std::is_same_v<Item, Box>;

  decltype(auto) box(int item) const { return box_of(boxes_[std::size_t(item)]); }

  /// The half-widths grow by the rounding of centre and half themselves.
  static BoxTree::Node enclosing(const Box& box) {
    return {box.center(),
            0.5 * (box.upper - box.lower) +
                4 * rounding_unit * (glm::abs(box.lower) + glm::abs(box.upper)),
            0,
            0,
            {}};
  }

  void fill(std::size_t node, std::size_t begin, std::size_t end) {
    auto& items = tree_.items;
    Box bounds, centers;
    for (std::size_t k = begin; k < end; ++k) {
      bounds.include(box(items[k]));
      centers.include(box(items[k]).center());
    }
    tree_.nodes[node] = enclosing(bounds);
    if (end - begin <= BoxTree::leaf_size) {
      tree_.nodes[node].first = std::int32_t(begin);
      tree_.nodes[node].count = std::int32_t(end - begin);
      return;
    }
    const dvec3 extent = centers.upper - centers.lower;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto position = [&](int item) { return box(item).center()[axis]; };
    const auto at = [&](std::size_t k) { return items.begin() + std::ptrdiff_t(k); };
    std::nth_element(at(begin), at(middle), at(end), [&](int a, int b) {
      return std::pair(position(a), a) < std::pair(position(b), b);
    });
    const std::size_t child = tree_.nodes.size();
    tree_.nodes[node].first = std::int32_t(child);
    tree_.nodes.resize(child + 2);
    fill(child, begin, middle);
    fill(child + 1, middle, end);
  }

  std::span<const Item> boxes_;
  BoxTree& tree_;
};

/// The slab grows by what rounds off its own bounds and what they are computed from: products and
/// sums of three coordinates of the box, some units each.
void grow(Slab& slab, const dvec3& center, const dvec3& half) {
  const dvec3 reach = glm::abs(center) + half;
  const double rounding = 32 * rounding_unit * (reach.x + reach.y + reach.z);
  slab.lower -= rounding;
  slab.upper += rounding;
}

/// Slabs of a tree's nodes, from those of its items up.
class NodeSlabs {
 public:
  explicit NodeSlabs(BoxTree& tree) : tree_(tree) {}

  void fill() {
    for (std::size_t k = tree_.nodes.size(); k-- > 0;) {  // children come after their parent
      BoxTree::Node& node = tree_.nodes[k];
      Slab& slab = node.slab;
      slab.normal = dvec3(0.0);
      visit(node, [&](const Slab& s, const auto&) {
        slab.normal += std::copysign(1.0, glm::dot(s.normal, slab.normal)) * s.normal;
      });
      slab.normal = unit(slab.normal);
      slab.upper = -std::numeric_limits<double>::infinity();
      slab.lower = -slab.upper;
      visit(node, [&](const Slab&, const auto& bound) {
        slab.upper = std::max(slab.upper, bound(slab.normal));
        slab.lower = std::min(slab.lower, -bound(-slab.normal));
      });
      grow(slab, node.center, node.half);
    }
  }

 private:
  /// The slabs below a node, with what bounds x . n over what they belong to.
  template <class Visit>
  void visit(const BoxTree::Node& node, const Visit& visit) const {
    const auto first = std::size_t(node.first);
    if (node.count == 0) {
      for (const std::size_t k : {first, first + 1}) {
        const BoxTree::Node& child = tree_.nodes[k];
        visit(child.slab, [&](const dvec3& n) { return child.slab_bound(n); });
      }
      return;
    }
    for (std::size_t k = first; k < first + std::size_t(node.count); ++k) {
      visit(tree_.slabs[k], [&](const dvec3& n) { return tree_.slab_bound(k, n); });
    }
  }

  BoxTree& tree_;
};

SceneNet make_net(const BezierPatch& patch, bool rational) {
  SceneNet net;
  for (const dvec4& p : patch.points) {
    const dvec3 x = rational ? dvec3(p) : euclidean(p);
    net.x.push_back(x.x);
    net.y.push_back(x.y);
    net.z.push_back(x.z);
    net.w.push_back(rational ? p.w : 1.0);
  }
  return net;
}

SceneElement make_element(SourceKind kind, int index, const BezierPatch& patch) {
  const bool rational = !is_polynomial(patch.points);
  double reach = 0;
  for (const dvec4& p : patch.points) {
    const dvec3 x = glm::abs(euclidean(p));
    reach = std::max(reach, x.x + x.y + x.z);
  }
  return {kind,
          index,
          {patch.degree_u, patch.degree_v},
          rational,
          reach,
          make_net(patch, rational),
          CoonsBvh(patch, coons_tolerance)};
}

/// Holds the control points, along the plane of the diagonals; none of a curve.
Slab slab_of(const BezierPatch& patch, const Box& box) {
  Slab slab;
  if (patch.degree_v == 0) return slab;
  const auto corner = [&](int i, int j) { return euclidean(patch.points[patch.index(i, j)]); };
  const int p = patch.degree_u;
  const int q = patch.degree_v;
  slab.normal = unit(glm::cross(corner(p, q) - corner(0, 0), corner(0, q) - corner(p, 0)));
  slab.upper = -std::numeric_limits<double>::infinity();
  slab.lower = -slab.upper;
  for (const dvec4& x : patch.points) {
    const double h = glm::dot(euclidean(x), slab.normal);
    slab.upper = std::max(slab.upper, h);
    slab.lower = std::min(slab.lower, h);
  }
  grow(slab, box.center(), 0.5 * (box.upper - box.lower));
  return slab;
}

/// Of fewer cells slabs rule out hardly any that boxes do not: all of the cells are near a
/// contact.
constexpr std::size_t least_slabs = 1024;

/// Cells at which searches start, with the boxes and slabs of their control points.
struct StartCells {
  std::vector<SceneCell> cells;
  std::vector<Box> boxes;
  std::vector<Slab> slabs;
};

/// Adds an element's start cells, from a cell of its CBVH down.
void add_cells(const SceneElement& element, int index, const BezierPatch& patch,
               const CoonsCell& cell, StartCells& to) {
  const bool flat = element.bvh.deviation(cell) <= cell_deviation;
  if (!flat && cell.level < cell_level_limit && !element.bvh.is_leaf(cell)) {
    for (const CoonsCell& child : element.bvh.children(cell)) {
      add_cells(element, index, patch, child, to);
    }
    return;
  }
  const BezierPatch part = restricted(patch, cell.u(), cell.v());
  to.cells.push_back({index, cell, make_net(part, element.rational)});
  Box box;
  for (const dvec4& p : part.points) box.include(euclidean(p));
  to.boxes.push_back(box);
  to.slabs.push_back(slab_of(part, box));
}

/// What of a part is queried besides its points: its patches and the pieces of free curves. Borders
/// and their ends lie in the closed patches already.
struct Candidates {
  std::vector<std::pair<SourceKind, int>> elements;
  std::vector<BezierPatch> patches;
};

Candidates candidates(const Part& part) {
  Candidates result;
  for (std::size_t i = 0; i < part.patches().size(); ++i) {
    result.elements.emplace_back(SourceKind::face, int(i));
    result.patches.push_back(part.patches()[i].bezier);
  }
  for (std::size_t i = 0; i < part.pieces().size(); ++i) {
    const EdgePiece& piece = part.pieces()[i];
    // Seams, and what comes after them, lie in patches.
    if (piece.edge < 0) break;
    if (!part.edges()[std::size_t(piece.edge)].faces.empty()) continue;
    result.elements.emplace_back(SourceKind::edge, int(i));
    result.patches.push_back({piece.bezier.degree(), 0, piece.bezier.points});
  }
  return result;
}

/// The homogeneous point about the centre, scaled; w (x - c) = w x - w c is rounded once, so points
/// far from the origin lose nothing but what they share with the centre.
dvec4 moved(const dvec4& p, const dvec3& center, double scale) {
  return {scale * std::fma(-p.w, center.x, p.x), scale * std::fma(-p.w, center.y, p.y),
          scale * std::fma(-p.w, center.z, p.z), p.w};
}

/// Passes over all patches, those that are not ruled first.
template <class Visit>
void visit_curved_first(const Part& part, const Visit& visit) {
  for (const bool ruled : {false, true}) {
    for (std::size_t i = 0; i < part.patches().size(); ++i) {
      if (part.patches()[i].ruled() == ruled) visit(int(i), part.patches()[i]);
    }
  }
}

/// What stands for seams and their vertices: a side or corner of a patch, of a curved one if there
/// is any, since that is where support points move on; but an edge that passes through a vertex.
void find_seams(const Part& part, ScenePart& result) {
  const std::vector<EdgePiece>& pieces = part.pieces();
  const auto first = std::find_if(pieces.begin(), pieces.end(),
                                  [](const EdgePiece& piece) { return piece.edge < 0; });
  const auto count = std::size_t(pieces.end() - first);
  const auto first_vertex = part.vertices().size() - std::size_t(part.seam_vertex_count());
  result.first_seam = int(pieces.size() - count);
  result.seams.resize(count);
  result.seam_vertices.resize(std::size_t(part.seam_vertex_count()));
  if (count == 0) return;
  const auto stand_for = [&](int vertex, const Contact& c) {
    if (vertex < int(first_vertex)) return;
    Contact& contact = result.seam_vertices[std::size_t(vertex) - first_vertex];
    if (contact.element < 0) contact = c;
  };
  for (int i = 0; i < result.first_seam; ++i) {
    const EdgePiece& piece = pieces[std::size_t(i)];
    for (const int end : {0, 1}) {
      stand_for(piece.end_vertex[std::size_t(end)], {-1, SourceKind::edge, i, double(end), 0});
    }
  }
  visit_curved_first(part, [&](int index, const Patch& patch) {
    for (int corner = 0; corner < 4; ++corner) {
      stand_for(patch.corner_vertex[std::size_t(corner)],
                {-1, SourceKind::face, index, corner < 2 ? 0.0 : 1.0, double(corner % 2)});
    }
    for (const Side side : all_sides) {
      const Border& border = patch.borders[std::size_t(side)];
      if (border.piece < result.first_seam) continue;
      SeamSide& seam = result.seams[std::size_t(border.piece - result.first_seam)];
      if (seam.patch < 0) seam = {index, side, border.piece_reversed};
    }
  });
}

ScenePart make_part(const Part& part, double scale, const SceneOptions& options) {
  Candidates found = candidates(part);
  ScenePart result;
  result.center = part.control_box().empty() ? dvec3(0.0) : part.control_box().center();
  std::vector<std::optional<SceneElement>> built(found.elements.size());
  parallel_for(built.size(), 8, options.threads, [&](std::size_t begin, std::size_t end) {
    options.progress.check();
    for (std::size_t k = begin; k < end; ++k) {
      for (dvec4& p : found.patches[k].points) p = moved(p, result.center, scale);
      const auto [kind, index] = found.elements[k];
      built[k] = make_element(kind, index, found.patches[k]);
      if (kind != SourceKind::face) continue;
      const Patch& patch = part.patches()[std::size_t(index)];
      built[k]->off_u = patch.ruled_u ? 0 : scale * patch.off_ruled.u;
      built[k]->off_v = patch.ruled_v ? 0 : scale * patch.off_ruled.v;
      built[k]->off_oblique = patch.ruled_obliquely ? 0 : scale * patch.off_ruled.oblique;
      built[k]->stand_in = patch.stand_in;
    }
  });
  result.element_of_patch.assign(part.patches().size(), -1);
  result.element_of_piece.assign(part.pieces().size(), -1);
  StartCells starts;
  for (std::size_t k = 0; k < built.size(); ++k) {
    options.progress.check();
    const auto [kind, index] = found.elements[k];
    auto& table = kind == SourceKind::face ? result.element_of_patch : result.element_of_piece;
    table[std::size_t(index)] = int(k);
    add_cells(*built[k], int(k), found.patches[k], built[k]->bvh.root(), starts);
    result.elements.push_back(std::move(*built[k]));
  }
  result.cells = std::move(starts.cells);
  const bool many = starts.boxes.size() >= least_slabs;
  result.tree = many ? BoxTree(starts.boxes, starts.slabs) : BoxTree(starts.boxes);
  std::vector<dvec3> points;
  points.reserve(std::size_t(part.point_count()));
  for (int i = 0; i < part.point_count(); ++i) {
    points.push_back(scale * (part.vertices()[std::size_t(i)] - result.center));
  }
  result.point_tree = BoxTree(points);
  find_seams(part, result);
  return result;
}

/// Bound of the rounding of x . n over an element: Bernstein sums with positive weights err by some
/// rounding units a degree, of the size of the points, however uneven the weights; so do nets that
/// are halved up to 40 times.
double value_rounding(const SceneElement& e) {
  return 2 * (16 + 40.0 * (e.shape.p + e.shape.q)) * rounding_unit * e.reach;
}

/// Bound of the rounding of x . n over points in the box, about its centre: three products and
/// sums.
double value_rounding(const Box& box) {
  const dvec3 half = box.upper - box.center();
  return 16 * rounding_unit * (half.x + half.y + half.z);
}

/// @throws InvalidInput
void refuse_trimmed(const Model& model) {
  for (const Part& part : model.parts()) {
    for (const Face& face : part.faces()) {
      if (face.loops.empty()) continue;
      throw InvalidInput(printable(part.name) + ": the face \"" + printable(face.name) +
                         "\" is trimmed, and trimmed faces cannot be evaluated yet");
    }
  }
}

/// Over some of the boxes.
BoxTree tree_over(const std::vector<int>& items, const std::vector<Box>& boxes) {
  std::vector<Box> own;
  own.reserve(items.size());
  for (const int item : items) own.push_back(boxes[std::size_t(item)]);
  BoxTree tree(own);
  for (int& item : tree.items) item = items[std::size_t(item)];
  return tree;
}

/// Per instance the first with the same part, of `parts`, and the same pose.
std::vector<int> first_instances(const std::vector<Instance>& instances,
                                 const std::vector<int>& parts) {
  const auto key = [&](int i) {
    const Instance& instance = instances[std::size_t(i)];
    std::array<double, 12> numbers;
    for (int k = 0; k < 3; ++k) {
      for (int column = 0; column < 3; ++column) {
        numbers[std::size_t(3 * column + k)] = instance.pose.rotation[column][k];
      }
      numbers[std::size_t(9 + k)] = instance.pose.translation[k];
    }
    return std::pair(parts[std::size_t(instance.part)], numbers);
  };
  std::map<std::pair<int, std::array<double, 12>>, int> seen;
  std::vector<int> result;
  result.reserve(instances.size());
  for (int i = 0; i < int(instances.size()); ++i) {
    result.push_back(seen.try_emplace(key(i), i).first->second);
  }
  return result;
}

/// Box of the part's control box under a rigid motion.
Box moved(const Box& box, const RigidMotion& pose) {
  Box result;
  for (int k = 0; k < 8; ++k) {
    result.include(pose({k & 1 ? box.upper.x : box.lower.x, k & 2 ? box.upper.y : box.lower.y,
                         k & 4 ? box.upper.z : box.lower.z}));
  }
  return result;
}

}  // namespace

BoxTree::BoxTree(std::span<const Box> boxes) {
  if (!boxes.empty()) BoxTreeBuilder(boxes, *this).build();
}

BoxTree::BoxTree(std::span<const Box> boxes, std::span<const Slab> of) : BoxTree(boxes) {
  slabs.reserve(items.size());
  for (const int item : items) slabs.push_back(of[std::size_t(item)]);
  NodeSlabs(*this).fill();
}

BoxTree::BoxTree(std::span<const dvec3> points) {
  if (!points.empty()) BoxTreeBuilder(points, *this).build();
}

int SceneContent::element(const Contact& contact) const {
  if (contact.kind == SourceKind::vertex) return -1;
  const ScenePart& part = part_of(contact.instance);
  const bool is_face = contact.kind == SourceKind::face;
  return (is_face ? part.element_of_patch : part.element_of_piece)[std::size_t(contact.element)];
}

bool SceneContent::can_support(const Contact& contact) const {
  if (contact.kind != SourceKind::vertex) return element(contact) >= 0;
  const int part = instances[std::size_t(contact.instance)].part;
  return contact.element < model.parts()[std::size_t(part)].point_count();
}

dvec3 SceneContent::local_point(const Contact& contact) const {
  const int part_index = instances[std::size_t(contact.instance)].part;
  const ScenePart& part = parts[std::size_t(part_index)];
  if (contact.kind == SourceKind::vertex) {
    const Part& source = model.parts()[std::size_t(part_index)];
    return frame.scale * (source.vertices()[std::size_t(contact.element)] - part.center);
  }
  const SceneElement& element = part.elements[std::size_t(this->element(contact))];
  const SceneNet& b = element.net;
  return with_scalar_net(element.shape, [&](const auto& net) {
    const auto value = [&](const std::vector<double>& c) {
      return net.value(c.data(), contact.u, contact.v);
    };
    return dvec3(value(b.x), value(b.y), value(b.z)) / (element.rational ? value(b.w) : 1.0);
  });
}

dvec3 SceneContent::frame_point(const Contact& contact) const {
  const SceneInstance& instance = instances[std::size_t(contact.instance)];
  const dvec3 local = local_point(contact);
  return (instance.rotated ? instance.rotation * local : local) + instance.translation;
}

Scene::Scene(Model model, const SceneOptions& options)
    : content_(std::make_unique<SceneContent>()) {
  SceneContent& c = *content_;
  c.model = std::move(model);
  Box control;
  std::vector<Box> boxes;
  for (const Instance& instance : c.model.instances()) {
    const Part& part = c.model.parts()[std::size_t(instance.part)];
    boxes.push_back(part.control_box().empty() ? Box() : moved(part.control_box(), instance.pose));
    control.include(boxes.back());
  }
  if (control.empty()) throw InvalidInput("the model holds no geometry");
  refuse_trimmed(c.model);
  // An empty part lies anywhere: nothing is found in it.
  for (Box& box : boxes) {
    if (box.empty()) box = {control.center(), control.center()};
  }
  c.frame = scene_frame(control);
  const std::vector<int> first_part = equal_parts(c.model.parts());
  for (std::size_t k = 0; k < first_part.size(); ++k) {
    const Part& part = c.model.parts()[k];
    options.progress.check();
    if (first_part[k] < int(k)) {
      const dvec3 center = c.parts[std::size_t(first_part[k])].center;
      ScenePart& repeated = c.parts.emplace_back();
      repeated.center = center;
      repeated.repeats = true;
      continue;
    }
    c.parts.push_back(make_part(part, c.frame.scale, options));
    for (const SceneElement& e : c.parts.back().elements) {
      c.rounding = std::max(c.rounding, value_rounding(e));
    }
    if (part.point_count() > 0) {
      c.rounding = std::max(c.rounding, c.frame.scale * value_rounding(part.control_box()));
    }
  }
  const std::vector<int> first = first_instances(c.model.instances(), first_part);
  double pose_rounding = 0;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const Instance& instance = c.model.instances()[k];
    const dvec3& center = c.parts[std::size_t(instance.part)].center;
    // The two far parts cancel before anything is rounded to their size, where nothing is turned.
    const dvec3 turned = c.frame.scale * (instance.pose.rotation * center);
    const dvec3 offset = c.frame.scale * (instance.pose.translation - c.frame.center);
    const bool rotated = instance.pose.rotation != dmat3(1.0);
    c.instances.push_back({first_part[std::size_t(instance.part)], first[k], rotated,
                           instance.pose.rotation, turned + offset});
    if (first[k] == int(k)) c.distinct_instances.push_back(int(k));
    // Unturned, the centres cancel exactly or nearly; turned, their products are rounded first.
    const double rounded = rotated ? 8 * (glm::length(turned) + glm::length(offset))
                           : instance.pose.translation == dvec3(0.0)
                               ? glm::length(turned + offset)
                               : glm::length(offset) + glm::length(turned + offset);
    pose_rounding = std::max(pose_rounding, 2 * rounding_unit * rounded);
    Box& box = boxes[k];
    box = {c.frame.to_frame(box.lower), c.frame.to_frame(box.upper)};
  }
  c.rounding += pose_rounding;
  c.tree = tree_over(c.distinct_instances, boxes);

  SupportQuery query(c);
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 n(0.0);
    n[axis] = 1;
    box.upper[axis] = query(n).h;
    box.lower[axis] = -query(-n).h;
  }
  c.box = {c.frame.to_model(box.lower), c.frame.to_model(box.upper)};
  c.diagonal = c.frame.length_to_model(taut::diagonal(box));
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

const Model& Scene::model() const { return content_->model; }
const SceneFrame& Scene::frame() const { return content_->frame; }
const Box& Scene::box() const { return content_->box; }
double Scene::diagonal() const { return content_->diagonal; }
const std::vector<int>& Scene::distinct_instances() const { return content_->distinct_instances; }

int Scene::first_instance(int instance) const {
  return content_->instances[std::size_t(instance)].first;
}

int Scene::patch_count() const {
  int count = 0;
  for (const int i : content_->distinct_instances) {
    const Instance& instance = content_->model.instances()[std::size_t(i)];
    count += int(content_->model.parts()[std::size_t(instance.part)].patches().size());
  }
  return count;
}

dvec3 Scene::point(const Contact& contact) const {
  return content_->frame.to_model(content_->frame_point(contact));
}

SourceContact Scene::source(const Contact& contact) const {
  const Model& model = content_->model;
  const Instance& instance = model.instances()[std::size_t(contact.instance)];
  const Part& part = model.parts()[std::size_t(instance.part)];
  const auto made = [&](SourceKind kind, int index, double u, double v) {
    return SourceContact{model.source_id({kind, contact.instance, index}), kind, u, v};
  };
  const ScenePart& own = content_->part_of(contact.instance);
  const auto on_patch = [&](int index, const dvec2& uv) {
    const Patch& patch = part.patches()[std::size_t(index)];
    return made(SourceKind::face, patch.face, patch.u.at(uv.x), patch.v.at(uv.y));
  };
  const auto on_piece = [&](int index, double t) {
    if (index >= own.first_seam) {
      const SeamSide& seam = own.seams[std::size_t(index - own.first_seam)];
      return on_patch(seam.patch, on_side(seam.side, seam.reversed ? 1 - t : t));
    }
    const EdgePiece& piece = part.pieces()[std::size_t(index)];
    return made(SourceKind::edge, piece.edge, piece.t.at(t), 0);
  };
  const auto at_vertex = [&](int index) {
    const int seam = index - (int(part.vertices().size()) - part.seam_vertex_count());
    if (seam < 0) return made(SourceKind::vertex, index, 0, 0);
    const Contact& c = own.seam_vertices[std::size_t(seam)];
    return c.kind == SourceKind::edge ? on_piece(c.element, c.u) : on_patch(c.element, {c.u, c.v});
  };
  if (contact.kind == SourceKind::vertex) return at_vertex(contact.element);
  if (contact.kind == SourceKind::edge) return on_piece(contact.element, contact.u);

  const Patch& patch = part.patches()[std::size_t(contact.element)];
  const double u = contact.u;
  const double v = contact.v;
  const bool at[4] = {u == 0, u == 1, v == 0, v == 1};
  for (const Side side : all_sides) {
    const Border& border = patch.borders[std::size_t(side)];
    if (at[std::size_t(side)] && border.kind == BorderKind::collapsed && border.vertex >= 0) {
      return at_vertex(border.vertex);
    }
  }
  if ((at[0] || at[1]) && (at[2] || at[3])) {
    const int vertex = patch.corner_vertex[std::size_t(2 * int(at[1]) + int(at[3]))];
    if (vertex >= 0) return at_vertex(vertex);
  }
  for (const Side side : all_sides) {
    const Border& border = patch.borders[std::size_t(side)];
    if (!at[std::size_t(side)] || border.piece < 0) continue;
    const double t = along_v(side) ? v : u;
    return on_piece(border.piece, border.piece_reversed ? 1 - t : t);
  }
  return on_patch(contact.element, {u, v});
}

std::size_t Scene::memory() const {
  std::size_t bytes = content_->tree.nodes.size() * sizeof(BoxTree::Node);
  for (const ScenePart& part : content_->parts) {
    bytes += part.tree.nodes.size() * sizeof(BoxTree::Node) +
             part.tree.items.size() * (sizeof(int) + 6 * sizeof(double)) +
             part.tree.slabs.size() * sizeof(Slab);
    bytes += part.point_tree.nodes.size() * sizeof(BoxTree::Node) +
             part.point_tree.items.size() * (sizeof(int) + 3 * sizeof(double));
    for (const SceneElement& element : part.elements) {
      bytes += sizeof(element) - sizeof(CoonsBvh) + element.bvh.memory() +
               4 * element.net.x.size() * sizeof(double);
    }
    for (const SceneCell& cell : part.cells) {
      bytes += sizeof(cell) + 4 * cell.net.x.size() * sizeof(double);
    }
  }
  return bytes;
}

}  // namespace taut
