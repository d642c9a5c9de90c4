#include "random_models.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include "shapes.h"
#include "taut/core/tolerances.h"
#include "taut/io/document/write_document.h"

namespace taut_test {
namespace {

using namespace taut;

/// Numbers at random that do not depend on the standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  /// 0 <= result < count
  int below(int count) { return int(engine_() % std::uint64_t(count)); }
  /// from <= result <= to
  int pick(int from, int to) { return from + below(to - from + 1); }
  bool one_in(int count) { return below(count) == 0; }
  /// In [0, 1).
  double share() { return std::ldexp(double(engine_() >> 11U), -53); }
  double within(double lower, double upper) { return lower + (upper - lower) * share(); }
  dvec3 point() {
    const double x = within(-1, 1);
    const double y = within(-1, 1);
    return {x, y, within(-1, 1)};
  }
  template <class Item>
  const Item& of(const std::vector<Item>& items) {
    return items[std::size_t(below(int(items.size())))];
  }

 private:
  std::mt19937_64 engine_;
};

std::string text_of(double x) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}

// ---------------------------------------------------------------- cages

using Faces = std::vector<std::vector<int>>;

int vertex_count(const Faces& faces) {
  int count = 0;
  for (const std::vector<int>& face : faces) {
    for (const int v : face) count = std::max(count, v + 1);
  }
  return count;
}

/// Each corner is a new vertex or one that is there.
Faces met_as_it_happens(Dice& dice, int count, const std::function<int()>& size) {
  Faces faces;
  int vertices = 0;
  const int newness = dice.pick(2, 5);
  for (int f = 0; f < count; ++f) {
    std::vector<int> face;
    for (int k = size(); k > 0; --k) {
      const bool is_new = vertices < 3 || dice.one_in(newness);
      face.push_back(is_new ? vertices++ : dice.below(vertices));
    }
    faces.push_back(face);
  }
  return faces;
}

/// Each face begins at an edge of one before, most often run the other way, and may end at another.
Faces grown_along_edges(Dice& dice, int count, const std::function<int()>& size) {
  Faces faces;
  int vertices = 0;
  for (int f = 0; f < count; ++f) {
    std::vector<int> face;
    if (f > 0) {
      const std::vector<int>& other = dice.of(faces);
      const auto k = std::size_t(dice.below(int(other.size())));
      face = {other[(k + 1) % other.size()], other[k]};
      if (dice.one_in(3)) face.push_back(other[(k + other.size() - 1) % other.size()]);
      if (dice.one_in(10)) std::reverse(face.begin(), face.end());
    }
    const auto wanted = std::size_t(size());
    face.resize(std::min(face.size(), wanted));
    while (face.size() < wanted) {
      face.push_back(vertices > 3 && dice.one_in(3) ? dice.below(vertices) : vertices++);
    }
    faces.push_back(face);
  }
  return faces;
}

std::vector<dvec3> points_at_random(Dice& dice, int count) {
  std::vector<dvec3> points;
  const int kind = dice.below(6);
  for (int i = 0; i < count; ++i) {
    dvec3 p = dice.point();
    if (kind == 0) p = glm::round(2.0 * p);
    if (kind == 1) p.z = 0;
    points.push_back(p);
  }
  if (kind == 2) points[std::size_t(dice.below(count))] *= std::pow(10.0, dice.pick(3, 12));
  return points;
}

std::string tags_at_random(Dice& dice, const Faces& faces, int vertices) {
  const std::array<const char*, 8> sharpness = {"0.3", "1", "1.5", "2.5", "4", "9", "10", "1e9"};
  const auto any_sharpness = [&] {
    return std::string(sharpness[std::size_t(dice.below(int(sharpness.size())))]);
  };
  std::string text;
  for (int k = dice.below(5); k > 0; --k) {
    const std::vector<int>& face = dice.of(faces);
    const auto i = std::size_t(dice.below(int(face.size())));
    const int a = face[i];
    const int b = face[(i + 1) % face.size()];
    if (a == b) continue;
    text += "t crease 2/1/0 " + std::to_string(a) + " " + std::to_string(b) + " " +
            any_sharpness() + "\n";
  }
  for (int k = dice.below(4) - 1; k > 0; --k) {
    text += "t corner 1/1/0 " + std::to_string(dice.below(vertices)) + " " + any_sharpness() + "\n";
  }
  if (dice.one_in(6))
    text += "t hole 1/0/0 " + std::to_string(dice.below(int(faces.size()))) + "\n";
  if (dice.one_in(2)) text += "t interpolateboundary 1/0/0 " + std::to_string(dice.below(3)) + "\n";
  if (dice.one_in(4)) text += "t creasemethod 0/0/1 chaikin\n";
  if (dice.one_in(4)) text += "t smoothtriangles 0/0/1 smooth\n";
  return text;
}

RandomModel cage(const Faces& faces, const std::vector<dvec3>& points, Scheme scheme,
                 const std::string& tags) {
  std::string text;
  for (const dvec3& p : points) {
    text += "v " + text_of(p.x) + " " + text_of(p.y) + " " + text_of(p.z) + "\n";
  }
  for (const std::vector<int>& face : faces) {
    text += "f";
    for (const int v : face) text += " " + std::to_string(v + 1);
    text += "\n";
  }
  return {{Reader::Kind::model, ".obj", scheme}, text + tags};
}

// ---------------------------------------------------------------- gluings

/// Whether the corners' vertices, numbered as they are met, come before all others that the same
/// cage gives in another order of its faces or with other first corners.
class FirstOfItsKind {
 public:
  explicit FirstOfItsKind(const std::vector<int>& sizes) : sizes_(sizes) {
    int first = 0;
    for (const int size : sizes) {
      first_.push_back(first);
      first += size;
    }
    order_.resize(sizes.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    do {
      if (keeps_sizes()) orders_.push_back(order_);
    } while (std::next_permutation(order_.begin(), order_.end()));
  }

  bool operator()(const std::vector<int>& corners) {
    return std::all_of(orders_.begin(), orders_.end(), [&](const auto& order) {
      std::vector<int> turns(sizes_.size());
      do {
        if (comes_earlier(corners, order, turns)) return false;
      } while (next(turns));
      return true;
    });
  }

 private:
  bool keeps_sizes() const {
    for (std::size_t i = 0; i < sizes_.size(); ++i) {
      if (sizes_[order_[i]] != sizes_[i]) return false;
    }
    return true;
  }
  bool next(std::vector<int>& turns) const {
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (++turns[i] < sizes_[i]) return true;
      turns[i] = 0;
    }
    return false;
  }
  bool comes_earlier(const std::vector<int>& corners, const std::vector<std::size_t>& order,
                     const std::vector<int>& turns) {
    number_.assign(corners.size(), -1);
    int count = 0;
    std::size_t at = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const int size = sizes_[i];
      for (int k = 0; k < size; ++k, ++at) {
        const int v = corners[std::size_t(first_[order[i]] + (k + turns[i]) % size)];
        int& n = number_[std::size_t(v)];
        if (n < 0) n = count++;
        if (n != corners[at]) return n < corners[at];
      }
    }
    return false;
  }

  std::vector<int> sizes_, first_;
  std::vector<std::size_t> order_;
  std::vector<std::vector<std::size_t>> orders_;
  std::vector<int> number_;
};

void each_partition(std::vector<int>& corners, std::size_t at, int used,
                    const std::function<void()>& visit) {
  if (at == corners.size()) {
    visit();
    return;
  }
  for (int v = 0; v <= used; ++v) {
    corners[at] = v;
    each_partition(corners, at + 1, std::max(used, v + 1), visit);
  }
}

// ---------------------------------------------------------------- surfaces

using shapes::Shape;

BezierPatch bumpy(Dice& dice, int degree_u, int degree_v) {
  BezierPatch patch;
  patch.degree_u = degree_u;
  patch.degree_v = degree_v;
  for (int i = 0; i <= degree_u; ++i) {
    for (int j = 0; j <= degree_v; ++j) {
      const dvec3 p(double(i) / degree_u, double(j) / degree_v, 0);
      patch.points.push_back(homogeneous(p + 0.3 * dice.point()));
    }
  }
  return patch;
}

Shape body(Dice& dice) {
  const double r = dice.within(0.1, 0.9);
  switch (dice.below(12)) {
    case 0:
      return shapes::sphere();
    case 1:
      return shapes::torus(1, r);
    case 2:
      return shapes::solid_cylinder(r, 1);
    case 3:
      return shapes::solid_cone(r, 1);
    case 4:
      return shapes::frustum(1, r, 1);
    case 5:
      return shapes::filleted_box(1, 2, 3, 0.5 * r);
    case 6:
      return shapes::dented_ellipsoid();
    case 7:
      return shapes::spherical_cap(r) + shapes::disc(1, 0);
    case 8:
      return shapes::two_spheres(1, r, 2);
    case 9:
      return shapes::box(1, 1, 1) + shapes::cylinder(0.5, r);
    case 10:
      return shapes::dented();
    default: {
      Shape shape;
      for (int k = dice.pick(1, 3); k > 0; --k) {
        shape = shape + shapes::of_patch(bumpy(dice, dice.pick(1, 4), dice.pick(1, 4)));
      }
      return shape;
    }
  }
}

dmat3 rotation(Dice& dice) {
  const dvec3 a = glm::normalize(dice.point() + dvec3(0, 0, 1e-3));
  const dvec3 b = glm::normalize(glm::cross(a, dice.point() + dvec3(2, 0, 0)));
  return {a, b, glm::cross(a, b)};
}

/// 1 to 6 of the body's Bezier patches, one after the other.
std::vector<BezierPatch> some_patches(Dice& dice, const Shape& shape) {
  std::vector<BezierPatch> all;
  for (const NurbsSurface& surface : shape.surfaces) {
    for (const PatchPiece& piece : decompose(surface)) all.push_back(piece.bezier);
  }
  const int count = std::min(dice.pick(1, 6), int(all.size()));
  const int first = dice.below(int(all.size()) - count + 1);
  return {all.begin() + first, all.begin() + first + count};
}

dvec4 mapped(const dvec4& p, const dmat3& matrix, const dvec3& translation) {
  return {matrix * dvec3(p) + p.w * translation, p.w};
}

/// The last patch once more: as it is, a little off, mirrored or moved.
void repeat_one(Dice& dice, std::vector<BezierPatch>& patches) {
  if (patches.size() >= 6 || !dice.one_in(2)) return;
  dmat3 matrix(1.0);
  dvec3 translation(0.0);
  switch (dice.below(4)) {
    case 0:
      translation = std::pow(10.0, -dice.pick(3, 12)) * dice.point();
      break;
    case 1:
      matrix[2][2] = -1;
      break;
    case 2:
      translation = 2.0 * dice.point();
      break;
    default:
      break;
  }
  BezierPatch copy = patches.back();
  for (dvec4& p : copy.points) p = mapped(p, matrix, translation);
  patches.push_back(copy);
}

/// Borders of a patch that shrink to a point, each to its own or all to one, or meet the one
/// across.
void close_one(Dice& dice, std::vector<BezierPatch>& patches) {
  if (!dice.one_in(3)) return;
  BezierPatch& patch = patches[std::size_t(dice.below(int(patches.size())))];
  const bool at_one_point = dice.one_in(2);
  const dvec4 point = patch.points.front();
  for (const Side side : all_sides) {
    const int way = dice.below(3);
    const int count = along_v(side) ? patch.degree_v : patch.degree_u;
    const auto entry = [&](bool upper, int k) -> dvec4& {
      const int across = upper ? (along_v(side) ? patch.degree_u : patch.degree_v) : 0;
      return patch.points[along_v(side) ? patch.index(across, k) : patch.index(k, across)];
    };
    const bool upper = at_upper_end(side);
    for (int k = 0; k <= count; ++k) {
      if (at_one_point) {
        entry(upper, k) = point;
      } else if (way == 1) {
        entry(upper, k) = entry(upper, 0);
      } else if (way == 2) {
        entry(upper, k) = entry(!upper, k);
      }
    }
  }
}

double rounded(double x, int decimals) {
  const double unit = std::pow(10.0, -decimals);
  return unit * std::round(x / unit);
}

}  // namespace

RandomModel random_cage(std::uint64_t seed) {
  Dice dice(seed);
  const Scheme scheme = dice.one_in(2) ? Scheme::loop : Scheme::catmark;
  const bool mixed = dice.one_in(3);
  const auto size = [&] {
    if (scheme == Scheme::loop) return 3;
    return mixed ? dice.pick(3, 5) : 4;
  };
  const int count = dice.pick(2, 12);
  const Faces faces =
      dice.one_in(2) ? met_as_it_happens(dice, count, size) : grown_along_edges(dice, count, size);
  const int vertices = vertex_count(faces);
  const std::vector<dvec3> points = points_at_random(dice, vertices);
  return cage(faces, points, scheme, tags_at_random(dice, faces, vertices));
}

RandomModel random_surfaces(std::uint64_t seed) {
  Dice dice(seed);
  std::vector<BezierPatch> patches = some_patches(dice, body(dice));
  close_one(dice, patches);
  repeat_one(dice, patches);
  const dmat3 turn = dice.one_in(3) ? dmat3(1.0) : rotation(dice);
  const double size = std::pow(10.0, dice.pick(-1, 3));
  const int precision = dice.pick(0, 10);  // 0: doubles, 10: float32, else decimals
  Part part;
  for (BezierPatch& patch : patches) {
    for (dvec4& p : patch.points) {
      dvec3 x = size * (turn * (dvec3(p) / p.w));
      for (int k = 0; k < 3; ++k) {
        if (precision == 10) x[k] = double(float(x[k]));
        if (precision > 0 && precision < 10) x[k] = rounded(x[k], precision);
      }
      p = {p.w * x, p.w};
    }
    part.add_surface(as_nurbs(patch), "face");
  }
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  return {{Reader::Kind::model, ".taut.json", {}}, to_document(model, DocumentEncoding::json)};
}

void each_gluing(const std::vector<int>& sizes, const std::function<void(const Faces&)>& visit) {
  std::vector<int> corners(std::size_t(std::accumulate(sizes.begin(), sizes.end(), 0)));
  FirstOfItsKind is_first(sizes);
  each_partition(corners, 0, 0, [&] {
    if (!is_first(corners)) return;
    Faces faces;
    auto next = corners.begin();
    for (const int size : sizes) {
      faces.emplace_back(next, next + size);
      next += size;
    }
    visit(faces);
  });
}

RandomModel cage_of_gluing(const Faces& faces, Scheme scheme) {
  Dice dice(1);
  std::vector<dvec3> points;
  for (int v = vertex_count(faces); v > 0; --v) points.push_back(dice.point());
  return cage(faces, points, scheme, "");
}

}  // namespace taut_test
