#include "taut/io/model/write_project.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "taut/core/error.h"
#include "taut/io/mesh/write_mesh.h"
#include "taut/io/text/output_file.h"

namespace taut {
namespace {

constexpr int patch_segments = 10;
constexpr int curve_segments = 24;

constexpr std::array<std::string_view, 4> layer_names = {"hull", "curves", "model", "tolerant"};

/// Vertices, edges and triangles of a PLY file.
struct MeshLayer {
  std::vector<dvec3> points;
  std::vector<std::array<int, 2>> edges;
  std::vector<std::array<int, 3>> triangles;

  int add(const dvec3& p) {
    points.push_back(p);
    return int(points.size()) - 1;
  }
  void add_line(const Polyline& line) {
    int last = -1;
    for (const dvec3& p : line) {
      const int next = add(p);
      if (last >= 0) edges.push_back({last, next});
      last = next;
    }
  }
  void add_triangle(int a, int b, int c) {
    const auto at = [&](int i) { return points[std::size_t(i)]; };
    if (at(a) == at(b) || at(b) == at(c) || at(c) == at(a)) return;
    triangles.push_back({a, b, c});
  }
};

void add_patch(const Patch& patch, const RigidMotion& pose, MeshLayer& layer) {
  constexpr int n = patch_segments;
  const auto first = int(layer.points.size());
  const auto collapsed = [&](Side side) {
    return patch.borders[std::size_t(side)].kind == BorderKind::collapsed;
  };
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      // One point to the last bit, where the side is one but for rounding.
      const bool u_free = !(j == 0 && collapsed(Side::v0)) && !(j == n && collapsed(Side::v1));
      const bool v_free = !(i == 0 && collapsed(Side::u0)) && !(i == n && collapsed(Side::u1));
      const double u = u_free ? double(i) / n : 0;
      const double v = v_free ? double(j) / n : 0;
      layer.add(pose(point(patch.bezier, u, v)));
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int corner = first + i * (n + 1) + j;
      layer.add_triangle(corner, corner + n + 1, corner + n + 2);
      layer.add_triangle(corner, corner + n + 2, corner + 1);
    }
  }
}

void add_part(const Part& part, const RigidMotion& pose, MeshLayer& layer) {
  for (const Patch& patch : part.patches()) add_patch(patch, pose, layer);
  for (const EdgePiece& piece : part.pieces()) {
    if (piece.edge < 0) break;                                           // seams
    if (!part.edges()[std::size_t(piece.edge)].faces.empty()) continue;  // a border
    Polyline line;
    for (int i = 0; i <= curve_segments; ++i) {
      line.push_back(pose(point(piece.bezier, double(i) / curve_segments)));
    }
    layer.add_line(line);
  }
  const auto first = int(layer.points.size());
  for (int i = 0; i < part.point_count(); ++i) {
    layer.add(pose(part.vertices()[std::size_t(i)]));
  }
  for (const std::vector<int>& polygon : part.polygons()) {
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      layer.add_triangle(first + polygon[0], first + polygon[k], first + polygon[k + 1]);
    }
  }
}

MeshLayer layer_of(const std::vector<Polyline>& curves) {
  MeshLayer layer;
  for (const Polyline& curve : curves) layer.add_line(curve);
  return layer;
}

MeshLayer model_layer(const Model& model) {
  MeshLayer layer;
  for (const Instance& instance : model.instances()) {
    add_part(model.parts()[std::size_t(instance.part)], instance.pose, layer);
  }
  return layer;
}

void write_layer(OutputBuffer& out, const MeshLayer& layer) {
  out.text("ply\nformat binary_little_endian 1.0\nelement vertex ")
      .text(long(layer.points.size()))
      .text("\nproperty double x\nproperty double y\nproperty double z\n");
  if (!layer.triangles.empty()) {
    out.text("element face ")
        .text(long(layer.triangles.size()))
        .text("\nproperty list uchar int vertex_indices\n");
  }
  if (!layer.edges.empty()) {
    out.text("element edge ")
        .text(long(layer.edges.size()))
        .text("\nproperty int vertex1\nproperty int vertex2\n");
  }
  out.text("end_header\n");
  for (const dvec3& p : layer.points) out.binary(p.x).binary(p.y).binary(p.z);
  for (const auto& triangle : layer.triangles) {
    out.binary(std::uint8_t{3});
    for (const int v : triangle) out.binary(std::int32_t{v});
  }
  for (const auto& edge : layer.edges) {
    for (const int v : edge) out.binary(std::int32_t{v});
  }
}

/// The text as the value of an XML attribute.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '"') {
      result += "&quot;";
    } else {
      result += c;
    }
  }
  return result;
}

/// `layers`: places in the list of layers, and of their files.
void write_list(OutputBuffer& out, const std::vector<std::filesystem::path>& files,
                const std::vector<std::size_t>& layers) {
  out.text("<!DOCTYPE MeshLabDocument>\n<MeshLabProject>\n <MeshGroup>\n");
  for (const std::size_t i : layers) {
    out.text("  <MLMesh filename=\"")
        .text(escaped(files[i].filename().string()))
        .text("\" label=\"")
        .text(layer_names[i])
        .text("\" visible=\"1\">\n")
        .text("   <MLMatrix44>\n1 0 0 0 \n0 1 0 0 \n0 0 1 0 \n0 0 0 1 \n</MLMatrix44>\n")
        .text("  </MLMesh>\n");
  }
  out.text(" </MeshGroup>\n <RasterGroup/>\n</MeshLabProject>\n");
}

Polyline polyline(const SceneFrame& frame, const HullCurve& curve) {
  Polyline line;
  for (const dvec3& p : curve.points) line.push_back(frame.to_model(p));
  return line;
}

}  // namespace

std::vector<Polyline> hull_curves(const SceneFrame& frame, const HullBoundary& boundary) {
  std::vector<Polyline> curves;
  for (const HullCurve& curve : boundary.curves) curves.push_back(polyline(frame, curve));
  return curves;
}

std::vector<Polyline> tolerant_curves(const SceneFrame& frame, const HullBoundary& boundary) {
  std::vector<Polyline> curves;
  for (const HullCurve& curve : boundary.curves) {
    const bool tolerant = std::any_of(curve.faces.begin(), curve.faces.end(), [&](int face) {
      return face >= 0 && boundary.faces[std::size_t(face)].tolerant > 0;
    });
    if (tolerant) curves.push_back(polyline(frame, curve));
  }
  return curves;
}

std::vector<Polyline> hull_curves(const HullMesh& mesh) {
  std::vector<Polyline> curves;
  for (const auto e : mesh.edges()) {
    if (!mesh.data(e).feature && mesh.n_faces() > 0) continue;
    const auto h = mesh.halfedge_handle(e, 0);
    curves.push_back(
        {position(mesh, mesh.from_vertex_handle(h)), position(mesh, mesh.to_vertex_handle(h))});
  }
  return curves;
}

std::vector<std::filesystem::path> project_files(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  for (const std::string_view layer : layer_names) {
    std::filesystem::path file = path;
    file.replace_extension();
    file += "-" + std::string(layer) + ".ply";
    files.push_back(std::move(file));
  }
  files.push_back(path);
  return files;
}

std::vector<std::filesystem::path> write_project(const std::filesystem::path& path,
                                                 const HullMesh& mesh,
                                                 const std::vector<Polyline>& curves,
                                                 const Model& model,
                                                 const std::vector<Polyline>& tolerant) {
  const std::vector<std::filesystem::path> files = project_files(path);
  std::vector<std::unique_ptr<OutputFile>> outputs;
  std::vector<std::size_t> layers;
  const auto add = [&](std::size_t file) -> OutputFile& {
    return *outputs.emplace_back(std::make_unique<OutputFile>(files[file]));
  };
  std::string hull;
  write_mesh(hull, files[0].string(), ".ply", mesh);
  add(0).text(hull);
  layers.push_back(0);
  const auto add_layer = [&](std::size_t i, const MeshLayer& layer) {
    if (layer.points.empty()) return;
    write_layer(add(i), layer);
    layers.push_back(i);
  };
  add_layer(1, layer_of(curves));
  write_layer(add(2), model_layer(model));
  layers.push_back(2);
  add_layer(3, layer_of(tolerant));
  write_list(add(4), files, layers);
  for (const auto& output : outputs) output->finish();

  std::size_t published = 0;
  try {
    for (; published < outputs.size(); ++published) outputs[published]->publish();
  } catch (const IoError&) {
    for (std::size_t i = 0; i < published; ++i) outputs[i]->withdraw();
    throw;
  }
  std::vector<std::filesystem::path> written;
  for (const std::size_t i : layers) written.push_back(files[i]);
  written.push_back(path);
  return written;
}

}  // namespace taut
