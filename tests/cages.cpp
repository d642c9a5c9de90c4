#include "cages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>
#include <utility>

#include "models.h"
#include "taut/core/tolerances.h"
#include "taut/subdivision/add_cage.h"

namespace taut_test {
namespace {

constexpr double turn = 2 * std::numbers::pi;

}  // namespace

ControlCage cube_cage() {
  ControlCage cage;
  for (int k = 0; k < 8; ++k) {
    cage.points.emplace_back((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
  }
  cage.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return cage;
}

ControlCage l_profile_cage() {
  ControlCage cage;
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : {std::pair{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}) {
      cage.points.emplace_back(x, y, z);
    }
  }
  cage.faces = {{0, 3, 2, 1}, {0, 5, 4, 3}, {6, 7, 8, 9}, {6, 9, 10, 11}};
  for (int k = 0; k < 6; ++k) cage.faces.push_back({k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k});
  return cage;
}

ControlCage box_cage(const BoxCage& box) {
  ControlCage cage;
  std::map<std::array<int, 3>, int> known;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [place, is_new] = known.emplace(at, int(cage.points.size()));
    if (is_new) {
      const dvec3 p = 2.0 / box.k * dvec3(at[0], at[1], at[2]) - 1.0;
      const double share = 1 - box.taper * (p.z + 1);
      cage.points.emplace_back(share * p.x, share * p.y, p.z);
    }
    return place->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      if (axis == 2 && (upper ? box.open_top : box.open_bottom)) continue;
      for (int i = 0; i < box.k; ++i) {
        for (int j = 0; j < box.k; ++j) {
          std::vector<int> face;
          for (const auto& [a, b] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}) {
            std::array<int, 3> at{};
            at[axis] = upper ? box.k : 0;
            at[(axis + 1) % 3] = a;
            at[(axis + 2) % 3] = b;
            face.push_back(vertex(at));
          }
          if (!upper) std::reverse(face.begin(), face.end());
          cage.faces.push_back(face);
        }
      }
    }
  }
  return cage;
}

ControlCage rimmed_cage(bool flat) {
  ControlCage cage = cube_cage();
  const std::vector<int>& top = cage.faces[1];
  for (std::size_t k = 0; k < 4; ++k) {
    cage.creases.push_back({{top[k], top[(k + 1) % 4]}, taut::infinite_sharpness});
    if (!flat && k % 2 == 0) cage.points[std::size_t(top[k])].z += 0.2 + 0.1 * double(k);
  }
  return cage;
}

ControlCage tetrahedron_cage(CageScheme scheme) {
  ControlCage cage;
  cage.scheme = scheme;
  cage.points = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  cage.faces = {{0, 1, 3}, {0, 3, 2}, {0, 2, 1}, {1, 2, 3}};
  return cage;
}

ControlCage torus_cage(int m, int n) {
  ControlCage cage;
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      const double a = turn * i / m;
      const double b = turn * j / n;
      const double r = 2 + 0.8 * std::cos(b);
      cage.points.emplace_back(r * std::cos(a), r * std::sin(a), 0.8 * std::sin(b));
    }
  }
  const auto at = [&](int i, int j) { return i % m * n + j % n; };
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      cage.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return cage;
}

ControlCage triangle_torus_cage(int m, int n) {
  ControlCage cage = torus_cage(m, n);
  cage.scheme = CageScheme::loop;
  std::vector<std::vector<int>> triangles;
  for (const auto& f : cage.faces) {
    triangles.push_back({f[0], f[1], f[2]});
    triangles.push_back({f[0], f[2], f[3]});
  }
  cage.faces = triangles;
  return cage;
}

ControlCage dome_cage(CageScheme scheme, int valence) {
  ControlCage cage;
  cage.scheme = scheme;
  const bool quads = scheme == CageScheme::catmark;
  const int ring = quads ? 2 * valence : valence;
  cage.points = {{0.05, 0.03, 1.1}, {-0.02, 0.04, -1.2}};
  for (const double z : {0.6, -0.6}) {
    for (int i = 0; i < ring; ++i) {
      const double a = turn * i / ring;
      // The corners of the top's quads lie farther out.
      const double r = quads && i % 2 == 1 ? 1.1 : 1;
      cage.points.emplace_back(1.2 * r * std::cos(a), r * std::sin(a), z + 0.04 * std::cos(a));
    }
  }
  const auto upper = [&](int i) { return 2 + i % ring; };
  const auto lower = [&](int i) { return 2 + ring + i % ring; };
  for (int i = 0; i < ring; ++i) {
    if (quads) {
      cage.faces.push_back({upper(i), lower(i), lower(i + 1), upper(i + 1)});
      if (i % 2 != 0) continue;
      cage.faces.push_back({0, upper(i), upper(i + 1), upper(i + 2)});
      cage.faces.push_back({1, lower(i + 2), lower(i + 1), lower(i)});
    } else {
      cage.faces.push_back({upper(i), lower(i), lower(i + 1)});
      cage.faces.push_back({upper(i), lower(i + 1), upper(i + 1)});
      cage.faces.push_back({0, upper(i), upper(i + 1)});
      cage.faces.push_back({1, lower(i + 1), lower(i)});
    }
  }
  for (dvec3& p : cage.points) p = skew_rotation() * p;
  return cage;
}

ControlCage sheet_cage(int m, int n) {
  ControlCage cage;
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double x = 2.0 * i / m - 1;
      const double y = 2.0 * j / n - 1;
      cage.points.emplace_back(x, y, 0.6 - 0.3 * x * x - 0.4 * y * y + 0.1 * x * y);
    }
  }
  const auto at = [&](int i, int j) { return i * (n + 1) + j; };
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      cage.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return cage;
}

std::vector<NamedCage> smooth_cages() {
  std::vector<NamedCage> all;
  for (const CageScheme scheme : {CageScheme::catmark, CageScheme::loop}) {
    for (const int n : {3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 50}) {
      all.push_back({std::string(name_of(scheme)) + " of valence " + std::to_string(n),
                     dome_cage(scheme, n)});
    }
    all.push_back({std::string(name_of(scheme)) + " tetrahedron", tetrahedron_cage(scheme)});
  }
  all.push_back({"cube", cube_cage()});
  all.push_back({"torus", torus_cage(6, 5)});
  all.push_back({"torus of triangles", triangle_torus_cage(6, 5)});
  return all;
}

void make_sharp(ControlCage& cage, const std::function<bool(const dvec3&)>& is_there,
                double sharpness) {
  for (const std::vector<int>& face : cage.faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      const int a = face[i];
      const int b = face[(i + 1) % face.size()];
      const bool both =
          is_there(cage.points[std::size_t(a)]) && is_there(cage.points[std::size_t(b)]);
      if (a < b && both) cage.creases.push_back({{a, b}, sharpness});
    }
  }
}

ControlCage triangulated(ControlCage cage) {
  std::vector<std::vector<int>> triangles;
  for (const std::vector<int>& f : cage.faces) {
    triangles.push_back({f[0], f[1], f[2]});
    triangles.push_back({f[0], f[2], f[3]});
  }
  cage.faces = std::move(triangles);
  cage.scheme = CageScheme::loop;
  return cage;
}

ControlCage semi_sharp_rim_cage(int k) {
  ControlCage cage = triangulated(box_cage({k}));
  for (const int axis : {0, 1}) {
    for (const double side : {-1.0, 1.0}) {
      const auto is_there = [&](const dvec3& p) { return p.z == 1 && p[axis] == side; };
      make_sharp(cage, is_there, 1.5);
    }
  }
  return cage;
}

std::vector<CageCrease> rim(const ControlCage& cage, double sharpness) {
  const int ring = int(cage.points.size() - 2) / 2;
  std::vector<CageCrease> creases;
  creases.reserve(std::size_t(ring));
  for (int i = 0; i < ring; ++i) creases.push_back({{2 + i, 2 + (i + 1) % ring}, sharpness});
  return creases;
}

std::vector<NamedCage> tagged_cages() {
  std::vector<NamedCage> all;
  for (const CageScheme scheme : {CageScheme::catmark, CageScheme::loop}) {
    const std::string name = name_of(scheme);
    for (const double sharpness : {0.5, 1.0, 2.3, 4.0}) {
      ControlCage cage = dome_cage(scheme, 5);
      cage.creases = rim(cage, sharpness);
      all.push_back({name + ", rim of sharpness " + std::to_string(sharpness), cage});
      cage.creases.resize(cage.creases.size() / 2);
      if (sharpness < 1) continue;
      cage.corners = {{0, sharpness}};
      all.push_back({name + ", half a rim and a corner " + std::to_string(sharpness), cage});
    }
    ControlCage sharp = dome_cage(scheme, 6);
    sharp.creases = rim(sharp, taut::infinite_sharpness);
    all.push_back({name + ", sharp rim", sharp});
    for (const int n : {3, 5, 8}) {
      // From the top down, and a part of the rim.
      ControlCage darts = dome_cage(scheme, n);
      darts.creases = rim(darts, taut::infinite_sharpness);
      const int ring = int(darts.creases.size());
      darts.creases.resize(darts.creases.size() / 2);
      darts.creases.push_back({{0, ring}, taut::infinite_sharpness});
      all.push_back({name + ", darts at a vertex of valence " + std::to_string(n), darts});
      darts.creases.erase(darts.creases.begin(), darts.creases.end() - 1);
      darts.corners = {{0, taut::infinite_sharpness}};
      all.push_back({name + ", a sharp edge to an apex of valence " + std::to_string(n), darts});
      darts.creases.clear();
      all.push_back({name + ", an apex of valence " + std::to_string(n), darts});
    }
    ControlCage hole = dome_cage(scheme, 4);
    hole.holes = {0, 4};
    all.push_back({name + ", holes", hole});
    ControlCage open = dome_cage(scheme, 5);
    open.faces.erase(open.faces.begin(), open.faces.begin() + 3);
    all.push_back({name + ", open", open});
    open.boundary = taut::CageBoundary::edge_only;
    all.push_back({name + ", open without corners", open});
    open.boundary = taut::CageBoundary::none;
    all.push_back({name + ", without surface at the boundary", open});
    ControlCage uneven = dome_cage(scheme, 5);
    uneven.creases = rim(uneven, 1.4);
    for (std::size_t k = 0; k < uneven.creases.size(); k += 3) uneven.creases[k].sharpness = 2.7;
    uneven.chaikin = true;
    all.push_back({name + ", uneven rim by Chaikin", uneven});
  }
  ControlCage triangles = dome_cage(CageScheme::loop, 5);
  triangles.scheme = CageScheme::catmark;
  triangles.smooth_triangles = true;
  all.push_back({"smooth triangles", triangles});
  ControlCage eight = cube_cage();
  eight.creases = {{{0, 1}, 8.0}};
  all.push_back({"cube with an edge of sharpness 8", eight});
  all.push_back({"cube with an edge of sharpness 8, loop", triangulated(eight)});
  ControlCage box = cube_cage();
  for (const auto& f : box.faces) {
    for (std::size_t k = 0; k < 4; ++k) box.creases.push_back({{f[k], f[(k + 1) % 4]}, 10});
  }
  all.push_back({"cube with sharp edges", box});
  for (const bool flat : {true, false}) {
    const std::string name = flat ? "cube with a flat rim" : "cube with a bent rim";
    all.push_back({name, rimmed_cage(flat)});
    all.push_back({name + ", loop", triangulated(rimmed_cage(flat))});
  }
  all.push_back({"sheet", sheet_cage(3, 4)});
  // At two corners one triangle is alone, at the others there are two.
  ControlCage cut = triangulated(sheet_cage(3, 4));
  cut.boundary = taut::CageBoundary::edge_only;
  all.push_back({"sheet of triangles without corners", cut});
  return all;
}

std::vector<NamedCage> degenerate_cages() {
  ControlCage top = cube_cage();
  top.faces[1] = {4, 5, 7, 7};
  top.faces.push_back({4, 7, 6, 6});
  ControlCage folded = cube_cage();
  folded.points.insert(folded.points.end(), {{1, 0, 2}, {2, 0, 2}, {1, 1, 3}});
  folded.faces.push_back({8, 9, 8, 10});
  ControlCage triangle = dome_cage(CageScheme::loop, 5);
  triangle.faces.push_back({0, 2, 2});
  return {{"cube with degenerate quads", top},
          {"cube and a folded quad", folded},
          {"loop with a degenerate triangle", triangle}};
}

ControlCage two_sided_fin_cage() {
  ControlCage cage = dome_cage(CageScheme::loop, 5);
  const int tip = int(cage.points.size());
  cage.points.push_back(1.5 * (cage.points[0] + cage.points[2]));
  cage.faces.insert(cage.faces.end(), {{0, 2, tip}, {2, 0, tip}});
  return cage;
}

std::vector<NamedCage> all_cages() {
  std::vector<NamedCage> all = smooth_cages();
  for (NamedCage& cage : tagged_cages()) all.push_back(std::move(cage));
  for (NamedCage& cage : degenerate_cages()) all.push_back(std::move(cage));
  return all;
}

std::vector<NamedCage> closed_cages() {
  std::vector<NamedCage> all = all_cages();
  std::erase_if(all, [](const NamedCage& c) { return boundary_edges(c.cage) > 0; });
  return all;
}

int boundary_edges(const ControlCage& cage) {
  std::map<std::pair<int, int>, int> uses;
  for (int f = 0; f < int(cage.faces.size()); ++f) {
    if (std::find(cage.holes.begin(), cage.holes.end(), f) != cage.holes.end()) continue;
    const std::vector<int>& face = cage.faces[std::size_t(f)];
    for (std::size_t k = 0; k < face.size(); ++k) {
      ++uses[std::minmax({face[k], face[(k + 1) % face.size()]})];
    }
  }
  return int(std::count_if(uses.begin(), uses.end(), [](const auto& u) { return u.second == 1; }));
}

double size_of(const ControlCage& cage) {
  taut::Box box;
  for (const dvec3& p : cage.points) box.include(p);
  return diagonal(box);
}

taut::Model cage_model(const ControlCage& cage, double accuracy) {
  taut::Part part;
  taut::add_cage(part, cage, "cage", {accuracy, {}});
  taut::Model model;
  model.add_part(std::move(part), taut::smooth_join_angle);
  return model;
}

std::optional<Model> model_from_elsewhere(const std::string& file,
                                          std::optional<taut::Scheme> scheme, double accuracy) {
  const char* const folder = std::getenv("TAUT_MODELS");
  if (folder == nullptr) return std::nullopt;
  const std::filesystem::path path = std::filesystem::path(folder) / file;
  if (!std::filesystem::exists(path)) return std::nullopt;
  Model model;
  taut::ReadOptions options;
  options.scheme = scheme;
  options.cage_accuracy = accuracy;
  taut::read_model(path, model, options);
  return model;
}

const ControlCage& cage_of(const Model& model) { return *model.parts().at(0).cages().at(0).cage; }

}  // namespace taut_test
