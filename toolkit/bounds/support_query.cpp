#include "taut/bounds/support_query.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "taut/bounds/scene_content.h"
#include "taut/bounds/search_stack.h"
#include "taut/bounds/second_order.h"
#include "taut/bounds/support_polish.h"
#include "taut/core/progress.h"

namespace taut {
namespace {

/// Cells that one query may look at before it settles for a weaker, still proven, bound. Ordinary
/// queries need about ten, contact along a whole curve in general position some ten thousand.
constexpr int cell_limit = 400'000;

/// Cells after which a query turns from depth first to best first, so that, should it meet its
/// limit, what it has left is as low as can be.
constexpr int patience = 2'000;
/// Cells between two looks at whether to stop.
constexpr int stop_interval = 256;

/// A bound, in the scene's frame, that even the vanishing of all slopes leaves so high is not worth
/// the evaluation that would complete it.
constexpr double hopeless_bound = 0.01;

/// Weights of a cell within this factor add little to the rounding of its proof.
constexpr double narrow_weights = 4;

}  // namespace

/// Depth-first search, the higher bound first: with the good first value that a hint or the first
/// descent gives, it visits hardly more than a best-first search and needs no heap. With f = N / W
/// the support value on an element and h the best value so far, everything is asked of the
/// polynomial g = N - h W: where g <= 0, f <= h. Raising h to f at the maximum of g is Dinkelbach's
/// iteration, so rational elements need no quotient rule.
class SupportQuery::Search {
 public:
  Search(const SceneContent& scene, Stop stop, SupportBounds bounds)
      : scene_(scene),
        stop_(std::move(stop)),
        bounds_(bounds),
        rounding_(scene.rounding),
        directions_(scene.instances.size()) {}

  Support run(const dvec3& n, const Contact& hint);
  double run_above(double least, const dvec3& n, const Contact& hint);
  void leave_out(const Contact& patch);
  void leave_out_lines(double off) { off_lines_ = off; }
  void check_stop() const { stop_.check(); }

  long queries = 0;
  long newton_iterations = 0;
  long cells = 0;

 private:
  enum class Kind : std::int32_t {
    instance_node,
    part_node,
    point_node,
    cell,
    coons_cell,
    net_cell
  };
  struct Entry {
    double bound;
    Kind kind;
    std::int32_t instance;
    std::int32_t index;  // node of a tree, cell of the part, coons cell or net cell
    bool operator<(const Entry& other) const { return bound < other.bound; }
  };
  /// A sub-rectangle of an element with its nets: N, and W where rational, at `slot`.
  struct NetCell {
    std::int32_t instance;
    std::int32_t element;
    double u, v, size_u, size_v;
    std::size_t slot;
  };
  struct CoonsEntry {
    std::int32_t element;
    CoonsCell cell;
  };
  /// The direction in an instance's own frame, and what its translation adds to every value.
  struct LocalDirection {
    long query = -1;
    dvec3 n;
    dvec3 abs_n;
    double offset;
  };

  const LocalDirection& local(int instance) {
    LocalDirection& d = directions_[std::size_t(instance)];
    if (d.query != queries) {
      const SceneInstance& i = scene_.instances[std::size_t(instance)];
      d.query = queries;
      d.n = i.rotated ? n_ * i.rotation : n_;
      d.abs_n = glm::abs(d.n);
      d.offset = glm::dot(i.translation, n_);
    }
    return d;
  }
  const SceneElement& element(int instance, int index) const {
    return scene_.part_of(instance).elements[std::size_t(index)];
  }
  bool is_left_out(int instance, int element) const {
    if (left_out_.empty()) return false;
    const std::vector<bool>& own = left_out_[std::size_t(instance)];
    return !own.empty() && own[std::size_t(element)];
  }
  /// Nothing at or below this can change the answer.
  double threshold() const { return best_h_ + support_slack; }

  void push(double bound, Kind kind, int instance, int index) {
    if (!(bound > threshold())) return;
    stack_.push({bound, kind, instance, index});
  }
  const BoxTree& tree_of(const Entry& entry) const {
    if (entry.kind == Kind::instance_node) return scene_.tree;
    const ScenePart& part = scene_.part_of(entry.instance);
    return entry.kind == Kind::part_node ? part.tree : part.point_tree;
  }
  void open_node(const Entry& entry);
  void open_points(const BoxTree& tree, const BoxTree::Node& leaf, int instance);
  void take_point(int instance, int vertex, double h);
  void open_cell(int instance, int index);
  void open_coons(const Entry& entry);
  static bool is_inside(double lower, double size) { return lower > 0 && lower + size < 1; }
  void push_coons(int instance, const CoonsEntry& entry, const SceneElement& e);
  static double off_inside(const NetCell& cell, const SceneElement& e);
  void push_net(const NetCell& cell, const SceneElement& e);
  NetCell net_cell(int instance, int element, const CoonsCell& place, const SceneNet& net,
                   const SceneElement& e);
  void improve(const NetCell& cell, double u, double v, double h);
  void open_net(const Entry& entry);

  template <class Net>
  static dvec2 largest_coefficient(const Net& net, const SceneElement& e, const double* N);
  template <class Net>
  bool settle(const Net& net, const SceneElement& e, const NetCell& cell, bool& split_u);
  /// Rounding of a second-order bound, as a share of the weight. The coefficients at hand are those
  /// of a polynomial that differs from the true one by what they carry: 4 rounding units, and one
  /// for each of the p or q averages that a halving takes. About that polynomial the bound errs by
  /// the rounding of its second differences, at most 2 units each (3 mixed), times p (p - 1) / 2,
  /// q (q - 1) / 2 and p q. Twice all that, since g is a difference of two such values.
  double certificate_rounding(const SceneElement& e, const NetCell& cell,
                              const Interval& weight) const {
    const int p = e.shape.p;
    const int q = e.shape.q;
    const double averages = -p * std::log2(cell.size_u) - q * std::log2(cell.size_v);
    return 2 * (4 + averages + p * p + q * q + 3 * p * q) * rounding_unit * e.reach * weight.upper /
           weight.lower;
  }
  /// Whether it is the spread of the weights, which falls as cells are halved, that makes the
  /// rounding of a proof exceed the slack.
  bool halves_know_better(const SceneElement& e, const NetCell& cell,
                          const Interval& weight) const {
    return weight.upper > narrow_weights * weight.lower &&
           certificate_rounding(e, cell, weight) > support_slack;
  }
  template <class Net>
  void split(const Net& net, const SceneElement& e, NetCell cell, bool along_u);
  void polish(const Contact& contact);
  void polish_from(const Contact& hint);
  void start(const dvec3& n, const Contact& hint);
  void search();
  void finish();

  const SceneContent& scene_;
  Stop stop_;
  SupportBounds bounds_;
  double rounding_;       ///< of a value x . n
  double off_lines_ = 0;  ///< insides of straight lines that are off by no more do not count
  dvec3 n_ = dvec3(0.0);
  dvec3 abs_n_ = dvec3(0.0);
  std::vector<LocalDirection> directions_;
  std::vector<std::vector<bool>> left_out_;  // by instance and element; empty where none is

  double best_h_ = -infinity;
  Contact best_;
  int best_element_ = -1;
  double low_ = 0;             ///< of the answer, as lines were left out
  double proof_rounding_ = 0;  ///< of the second-order bounds that the answer rests on
  bool converged_ = false;     ///< Newton's method has ended at the best contact
  bool curved_ = false;        ///< the value is strictly concave there

  SearchStack<Entry> stack_;
  std::vector<NetCell> net_cells_;
  std::vector<CoonsEntry> coons_cells_;
  std::vector<double> nets_;
  std::vector<double> g_;
  SupportPolish polish_;
};

void SupportQuery::Search::open_node(const Entry& entry) {
  const bool top = entry.kind == Kind::instance_node;
  const BoxTree& tree = tree_of(entry);
  const bool has_slabs = !tree.slabs.empty();
  const BoxTree::Node& node = tree.nodes[std::size_t(entry.index)];
  const dvec3& n = top ? n_ : local(entry.instance).n;
  const dvec3& abs_n = top ? abs_n_ : local(entry.instance).abs_n;
  const double offset = (top ? 0 : local(entry.instance).offset) + rounding_;
  const std::size_t size = stack_.size();
  if (node.count == 0) {
    for (const int index : {node.first, node.first + 1}) {
      const BoxTree::Node& child = tree.nodes[std::size_t(index)];
      const double bound = child.upper_bound(n, abs_n) + offset;
      if (!(bound > threshold())) continue;
      // Slabs only rule out: the way through the model is that of the boxes.
      if (has_slabs && !(child.slab_bound(n) + offset > threshold())) continue;
      push(bound, entry.kind, entry.instance, index);
    }
  } else if (entry.kind == Kind::point_node) {
    open_points(tree, node, entry.instance);
  } else {
    double bounds[BoxTree::leaf_size];
    tree.upper_bounds(node, n, abs_n, bounds);
    for (int k = 0; k < node.count; ++k) {
      const int item = tree.items[std::size_t(node.first + k)];
      if (top) {
        const ScenePart& part = scene_.part_of(item);
        if (!part.tree.nodes.empty()) push(bounds[k] + offset, Kind::part_node, item, 0);
        if (!part.point_tree.nodes.empty()) push(bounds[k] + offset, Kind::point_node, item, 0);
      } else {
        const double bound = bounds[k] + offset;
        if (!(bound > threshold())) continue;
        const auto place = std::size_t(node.first + k);
        if (has_slabs && !(tree.slab_bound(place, n) + offset > threshold())) continue;
        push(bound, Kind::cell, entry.instance, item);
      }
    }
  }
  stack_.highest_last(size);
}

void SupportQuery::Search::open_points(const BoxTree& tree, const BoxTree::Node& leaf,
                                       int instance) {
  const LocalDirection& d = local(instance);
  const auto first = std::size_t(leaf.first);
  for (std::size_t i = first; i < first + std::size_t(leaf.count); ++i) {
    const double h =
        tree.center[0][i] * d.n.x + tree.center[1][i] * d.n.y + tree.center[2][i] * d.n.z;
    if (h + d.offset > best_h_) take_point(instance, tree.items[i], h + d.offset);
  }
}

void SupportQuery::Search::take_point(int instance, int vertex, double h) {
  best_h_ = h;
  best_ = {instance, SourceKind::vertex, vertex, 0, 0};
  best_element_ = -1;
  converged_ = curved_ = true;  // there is nothing to polish
}

void SupportQuery::Search::open_cell(int instance, int index) {
  const SceneCell& cell = scene_.part_of(instance).cells[std::size_t(index)];
  if (is_left_out(instance, cell.element)) return;
  const SceneElement& e = element(instance, cell.element);
  if (bounds_ == SupportBounds::coons) {
    push_coons(instance, {cell.element, cell.coons}, e);
  } else {
    push_net(net_cell(instance, cell.element, cell.coons, cell.net, e), e);
  }
}

void SupportQuery::Search::push_coons(int instance, const CoonsEntry& entry,
                                      const SceneElement& e) {
  const LocalDirection& d = local(instance);
  const auto corners = e.bvh.corners(entry.cell);
  double highest = -infinity;
  for (const dvec3& corner : corners) highest = std::max(highest, glm::dot(corner, d.n));
  const double bound = highest + e.bvh.deviation(entry.cell) + d.offset + rounding_;
  if (!(bound > threshold())) return;
  coons_cells_.push_back(entry);
  push(bound, Kind::coons_cell, instance, int(coons_cells_.size()) - 1);
}

void SupportQuery::Search::open_coons(const Entry& entry) {
  const CoonsEntry coons = coons_cells_[std::size_t(entry.index)];
  const SceneElement& e = element(entry.instance, coons.element);
  // Below a leaf the bound cannot fall under the distance from the Coons patch.
  if (!e.bvh.is_leaf(coons.cell)) {
    for (const CoonsCell& child : e.bvh.children(coons.cell)) {
      push_coons(entry.instance, {coons.element, child}, e);
    }
    return;
  }
  const NetCell cell = net_cell(entry.instance, coons.element, coons.cell, e.net, e);
  const Interval u = coons.cell.u();
  const Interval v = coons.cell.v();
  const ScalarNet<-1, -1> net(e.shape);
  for (int k = 0; k < (e.rational ? 2 : 1); ++k) {
    net.restrict(nets_.data() + cell.slot + std::size_t(k * net.size()), u.lower, u.upper, v.lower,
                 v.upper);
  }
  push_net(cell, e);
}

/// A cell with the values of the control points in the query's direction.
SupportQuery::Search::NetCell SupportQuery::Search::net_cell(int instance, int element,
                                                             const CoonsCell& place,
                                                             const SceneNet& net,
                                                             const SceneElement& e) {
  const std::size_t slot = nets_.size();
  nets_.resize(slot + net.value_count(e.rational));
  net.values(local(instance).n, e.rational, nets_.data() + slot);
  const Interval u = place.u();
  const Interval v = place.v();
  return {instance, element, u.lower, v.lower, u.upper - u.lower, v.upper - v.lower, slot};
}

/// By how much the cell may be above the ends of straight lines on whose insides it lies, infinity
/// if it lies on none; the straight lines of a plane patch are no parameter lines.
double SupportQuery::Search::off_inside(const NetCell& cell, const SceneElement& e) {
  const bool inside_u = is_inside(cell.u, cell.size_u);
  const bool inside_v = is_inside(cell.v, cell.size_v);
  if (inside_u && inside_v) return std::min({e.off_u, e.off_v, e.off_oblique});
  const bool plane = e.off_u < infinity && e.off_v < infinity;
  if (plane || !(inside_u || inside_v)) return infinity;
  return inside_u ? e.off_u : e.off_v;
}

/// Queues the cell under its largest coefficient, by which the convex hull property bounds it.
void SupportQuery::Search::push_net(const NetCell& cell, const SceneElement& e) {
  const double off = off_inside(cell, e);
  if (off == 0) return;
  const int size = e.shape.size();
  const double* b = nets_.data() + cell.slot;
  double highest = -infinity;
  if (e.rational) {
    for (int k = 0; k < size; ++k) highest = std::max(highest, b[k] / b[size + k]);
  } else {
    for (int k = 0; k < size; ++k) highest = std::max(highest, b[k]);
  }
  const double bound = highest + local(cell.instance).offset;
  if (!(bound > threshold())) return;
  if (off <= off_lines_) {
    low_ = std::max(low_, off);
    return;
  }
  net_cells_.push_back(cell);
  push(bound, Kind::net_cell, cell.instance, int(net_cells_.size()) - 1);
}

void SupportQuery::Search::improve(const NetCell& cell, double u, double v, double h) {
  const SceneElement& e = element(cell.instance, cell.element);
  best_h_ = h;
  best_ = {cell.instance, e.kind, e.index, cell.u + u * cell.size_u, cell.v + v * cell.size_v};
  best_element_ = cell.element;
  converged_ = false;
}

/// The parameters at which the largest coefficient stands.
template <class Net>
dvec2 SupportQuery::Search::largest_coefficient(const Net& net, const SceneElement& e,
                                                const double* N) {
  const double* W = N + net.size();
  int top = 0;
  for (int k = 1; k < net.size(); ++k) {
    if (e.rational ? N[k] * W[top] > N[top] * W[k] : N[k] > N[top]) top = k;
  }
  const int row = top / (net.q() + 1);
  const int column = top % (net.q() + 1);
  return {net.p() > 0 ? double(row) / net.p() : 0, net.q() > 0 ? double(column) / net.q() : 0};
}

/// Seeks the cell's maximum by Newton's method, raising the best value on the way. True if the
/// second-order bound then proves that the cell holds nothing higher.
template <class Net>
bool SupportQuery::Search::settle(const Net& net, const SceneElement& e, const NetCell& cell,
                                  bool& split_u) {
  const int size = net.size();
  const double* N = nets_.data() + cell.slot;
  const double* W = N + size;
  const double offset = local(cell.instance).offset;
  ++cells;

  const bool same = best_element_ == cell.element && best_.instance == cell.instance;
  const double best_u = (best_.u - cell.u) / cell.size_u;
  const double best_v = (best_.v - cell.v) / cell.size_v;
  const bool inside = same && best_u >= 0 && best_u <= 1 && best_v >= 0 && best_v <= 1;
  const auto choose_split = [&](const NetCurvature& c, const SecondOrderBound& b) {
    split_u = splits_along_u(c, b, cell.size_u, cell.size_v);
  };

  // Start at the best contact if it is on this element, else at the largest coefficient.
  const dvec2 start = same ? dvec2(std::clamp(best_u, 0.0, 1.0), std::clamp(best_v, 0.0, 1.0))
                           : largest_coefficient(net, e, N);
  double u = start.x;
  double v = start.y;
  double h = best_h_ - offset;
  if (best_h_ == -infinity) {
    h = e.rational ? net.value(N, u, v) / net.value(W, u, v) : net.value(N, u, v);
    improve(cell, u, v, h + offset);
  }
  const double* g = N;
  const auto refer_to = [&] {  // the net of g, of which polynomial cells share N and shift values
    if (!e.rational) return;
    g_.resize(std::size_t(size));
    for (int k = 0; k < size; ++k) g_[std::size_t(k)] = N[k] - h * W[k];
    g = g_.data();
  };
  refer_to();
  const Interval weight =
      e.rational ? Interval{*std::min_element(W, W + size), *std::max_element(W, W + size)}
                 : Interval{1, 1};
  NetCurvature curvature = net.curvature(g);
  // Not concave where Newton's method has already been: no bound about that point can succeed.
  const bool concave = curvature.uu_max < 0 && curvature.vv_max < 0 &&
                       curvature.uv_abs * curvature.uv_abs < curvature.uu_max * curvature.vv_max;
  if (inside && converged_ && !concave) {
    const SecondOrderBound b = second_order_bound({}, curvature, u, v);
    choose_split(curvature, b);
    if (b.bound > hopeless_bound) return false;
  }
  const double loss = shared_curvature(curvature).loss();
  for (int step = 0; step < newton_step_limit; ++step) {
    NetJet jet = net.jet(g, u, v);
    if (!e.rational) jet.g -= h;
    if (jet.g > gain_worth_taking * weight.upper) {
      const double gain = e.rational ? jet.g / net.value(W, u, v) : jet.g;
      h += gain;
      improve(cell, u, v, h + offset);
      refer_to();
      if (e.rational) {
        curvature = net.curvature(g);
        jet = net.jet(g, u, v);
      } else {
        jet.g -= gain;
      }
    }
    const SecondOrderBound b = second_order_bound(jet, curvature, u, v);
    const bool proven = b.bound <= support_slack * weight.lower;
    if (proven && !halves_know_better(e, cell, weight)) {
      proof_rounding_ = std::max(proof_rounding_, certificate_rounding(e, cell, weight));
      return true;
    }
    choose_split(curvature, b);
    if (proven || (inside && converged_)) return false;
    const double u_before = u;
    const double v_before = v;
    ++newton_iterations;
    // Worth a step only where it may beat the best value, or where the bound about the cell's own
    // maximum, or about a point of a ridge as good as level, may succeed.
    const double gain = newton_step(jet, u, v);
    if (jet.g + gain < 0 && jet.g + gain + loss > 0) return false;
    if (std::abs(u - u_before) + std::abs(v - v_before) < newton_step_end) return false;
  }
  return false;
}

template <class Net>
void SupportQuery::Search::split(const Net& net, const SceneElement& e, NetCell cell,
                                 bool along_u) {
  if (net.p() == 0) along_u = false;
  if (net.q() == 0) along_u = true;
  const std::size_t size = std::size_t(net.size());
  const std::size_t slots = e.rational ? 2 * size : size;
  NetCell upper = cell;
  upper.slot = nets_.size();
  nets_.resize(upper.slot + slots);
  for (std::size_t k = 0; k < slots; k += size) {
    double* b = nets_.data() + cell.slot + k;
    double* c = nets_.data() + upper.slot + k;
    along_u ? net.split_u(b, c) : net.split_v(b, c);
  }
  if (along_u) {
    upper.size_u = cell.size_u *= 0.5;
    upper.u += cell.size_u;
  } else {
    upper.size_v = cell.size_v *= 0.5;
    upper.v += cell.size_v;
  }
  const std::size_t entries = stack_.size();
  push_net(cell, e);
  push_net(upper, e);
  stack_.highest_last(entries);
}

void SupportQuery::Search::open_net(const Entry& entry) {
  const NetCell cell = net_cells_[std::size_t(entry.index)];
  const SceneElement& e = element(cell.instance, cell.element);
  with_scalar_net(e.shape, [&](const auto& net) {
    bool split_u = true;
    if (!settle(net, e, cell, split_u)) split(net, e, cell, split_u);
  });
}

/// Takes the maximum next to a contact on an element for the best one.
void SupportQuery::Search::polish(const Contact& contact) {
  const int index = scene_.element(contact);
  const SceneElement& e = element(contact.instance, index);
  const LocalDirection& d = local(contact.instance);
  polish_.take(e, d.n);
  const PolishedSupport p = polish_.polish({contact.u, contact.v});
  newton_iterations += p.steps;
  best_h_ = p.h + d.offset;
  best_ = {contact.instance, e.kind, e.index, p.uv.x, p.uv.y};
  best_element_ = index;
  converged_ = p.converged;
  curved_ = p.curved;
}

void SupportQuery::Search::polish_from(const Contact& hint) {
  if (hint.kind == SourceKind::vertex) {
    const LocalDirection& d = local(hint.instance);
    take_point(hint.instance, hint.element, glm::dot(scene_.local_point(hint), d.n) + d.offset);
  } else {
    polish(hint);
  }
}

/// Where the best value does not change along a line, goes to the line's end.
void SupportQuery::Search::finish() {
  const LocalDirection& d = local(best_.instance);
  if (converged_) {
    polish_.take(element(best_.instance, scene_.element(best_)), d.n);
  } else {
    polish(best_);
  }
  const dvec2 uv = polish_.end_of_flat({best_.u, best_.v}, best_h_ - d.offset);
  best_.u = uv.x;
  best_.v = uv.y;
  if (best_.kind != SourceKind::face) return;
  if (const auto end = end_of_ruling(scene_, best_, n_, best_h_)) best_ = *end;
}

void SupportQuery::Search::start(const dvec3& n, const Contact& hint) {
  n_ = n;
  abs_n_ = glm::abs(n);
  ++queries;
  best_h_ = -infinity;
  best_element_ = -1;
  converged_ = false;
  low_ = proof_rounding_ = 0;
  stack_.clear();
  net_cells_.clear();
  coons_cells_.clear();
  nets_.clear();
  if (hint.instance >= 0 && scene_.can_support(hint)) {
    Contact first = hint;
    first.instance = scene_.instances[std::size_t(hint.instance)].first;
    const int index = scene_.element(first);
    if (index < 0 || !is_left_out(first.instance, index)) polish_from(first);
  }
}

void SupportQuery::Search::search() {
  stack_.push({infinity, Kind::instance_node, -1, 0});
  for (int count = 0; !stack_.empty() && count < cell_limit; ++count) {
    if (count % stop_interval == 0) stop_.check();
    if (count == patience) stack_.turn_best_first();
    const Entry entry = stack_.pop();
    if (!(entry.bound > threshold())) continue;
    switch (entry.kind) {
      case Kind::net_cell:
        open_net(entry);
        break;
      case Kind::coons_cell:
        open_coons(entry);
        break;
      case Kind::cell:
        open_cell(entry.instance, entry.index);
        break;
      default:
        open_node(entry);
    }
  }
}

Support SupportQuery::Search::run(const dvec3& n, const Contact& hint) {
  start(n, hint);
  search();
  // The limit may have left entries open.
  const double proven = std::max(best_h_ + support_slack, stack_.highest());
  assert(best_.instance >= 0);  // the direction is finite
  if (!converged_ || !curved_) finish();
  return {best_h_, std::max(proven, best_h_) + rounding_ + proof_rounding_ + low_, low_, best_,
          scene_.frame_point(best_)};
}

/// The search starts as if a point so high were known; only if lines were left out that may be
/// higher, it must be known what they are next to.
double SupportQuery::Search::run_above(double least, const dvec3& n, const Contact& hint) {
  start(n, hint);
  best_h_ = std::max(best_h_, least);
  search();
  if (best_h_ <= least) return low_ > 0 ? std::max(least, run(n, hint).highest()) : least;
  if (!converged_ || !curved_) finish();
  return best_h_ + low_;
}

void SupportQuery::Search::leave_out(const Contact& patch) {
  left_out_.resize(scene_.instances.size());
  std::vector<bool>& own = left_out_[std::size_t(patch.instance)];
  own.resize(scene_.part_of(patch.instance).elements.size());
  own[std::size_t(scene_.element(patch))] = true;
}

SupportQuery::SupportQuery(const SceneContent& scene, Stop stop, SupportBounds bounds)
    : search_(std::make_unique<Search>(scene, std::move(stop), bounds)) {}
SupportQuery::~SupportQuery() = default;
SupportQuery::SupportQuery(SupportQuery&&) noexcept = default;

Support SupportQuery::operator()(const dvec3& n, const Contact& hint) {
  return search_->run(n, hint);
}

double SupportQuery::highest_above(double least, const dvec3& n, const Contact& hint) {
  return search_->run_above(least, n, hint);
}

void SupportQuery::leave_out(const std::vector<Contact>& patches) {
  for (const Contact& c : patches) search_->leave_out(c);
}

void SupportQuery::leave_out_lines(double off) { search_->leave_out_lines(off); }

void SupportQuery::check_stop() const { search_->check_stop(); }

long SupportQuery::queries() const { return search_->queries; }
long SupportQuery::newton_iterations() const { return search_->newton_iterations; }
long SupportQuery::cells() const { return search_->cells; }

}  // namespace taut
