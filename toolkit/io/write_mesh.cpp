#include "taut/io/write_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "taut/core/error.h"
#include "taut/io/file_polygons.h"
#include "taut/io/formats.h"
#include "taut/io/output_file.h"

namespace taut {
namespace {

/// Lengths of lists are one byte in PLY.
constexpr std::size_t most_corners = 255;

using Color = std::array<std::uint8_t, 3>;

/// Muted colours for patches, in which neighbouring numbers differ most in hue: multiples of the
/// golden ratio are spread evenly, however many there are. Scrolls and facets stand out.
Color face_color(FaceKind kind, int source) {
  if (kind == FaceKind::scroll) return {233, 164, 60};
  if (kind == FaceKind::facet) return {74, 106, 143};
  if (source < 0) return {190, 190, 190};
  constexpr double golden_ratio = 0.6180339887498949;
  constexpr double lightest = 216;
  constexpr double saturation = 0.34;
  const double hue = 6 * (source * golden_ratio - std::floor(source * golden_ratio));
  Color color;
  for (std::size_t i = 0; i < 3; ++i) {
    // Hexagonal hue: each primary is full within one sixth of its own hue, and absent beyond two.
    const double distance = std::abs(std::remainder(hue - 2 * static_cast<double>(i), 6));
    const double share = std::clamp(2 - distance, 0.0, 1.0);
    color[i] = static_cast<std::uint8_t>(lightest * (1 - saturation * (1 - share)));
  }
  return color;
}

void write_ply(const std::filesystem::path& path, const HullMesh& mesh) {
  const FilePolygons polygons(mesh, most_corners);
  OutputFile out(path);
  out.text("ply\nformat binary_little_endian 1.0\n")
      .text("comment convex hull by Taut; kind: 0 patch, 1 scroll, 2 facet\n")
      .text("element vertex ")
      .text(static_cast<long>(mesh.n_vertices()))
      .text("\nproperty double x\nproperty double y\nproperty double z\n")
      .text("property double nx\nproperty double ny\nproperty double nz\n")
      .text("property float quality\nproperty double u\nproperty double v\nproperty int source\n")
      .text("element face ")
      .text(static_cast<long>(polygons.size()))
      .text("\nproperty list uchar int vertex_indices\n")
      .text("property uchar red\nproperty uchar green\nproperty uchar blue\n")
      .text("property uchar kind\nproperty int source\nproperty int hull_face\nend_header\n");

  for (const auto vertex : mesh.vertices()) {
    const auto& data = mesh.data(vertex);
    for (const double x : mesh.point(vertex)) out.binary(x);
    for (const double n : mesh.normal(vertex)) out.binary(n);
    out.binary(data.quality).binary(data.u).binary(data.v).binary(std::int32_t{data.source});
  }
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const auto& data = mesh.data(polygons.face(i));
    out.binary(static_cast<std::uint8_t>(polygons.corners(i).size()));
    for (const int corner : polygons.corners(i)) out.binary(std::int32_t{corner});
    for (const std::uint8_t c : face_color(data.kind, data.source)) out.binary(c);
    out.binary(static_cast<std::uint8_t>(data.kind))
        .binary(std::int32_t{data.source})
        .binary(std::int32_t{data.hull_face});
  }
  out.finish();
  out.publish();
}

/// What OBJ faces are coloured by: the kind, and the source of a patch.
struct Material {
  FaceKind kind = FaceKind::facet;
  int source = -1;

  std::string name() const {
    if (kind == FaceKind::scroll) return "scroll";
    if (kind == FaceKind::facet) return "facet";
    return source < 0 ? "patch" : "patch_" + std::to_string(source);
  }
  bool operator<(const Material& other) const {
    return std::pair(kind, source) < std::pair(other.kind, other.source);
  }
  bool operator==(const Material&) const = default;
};

Material material(const HullMesh& mesh, OpenMesh::FaceHandle face) {
  const auto& data = mesh.data(face);
  return {data.kind, data.kind == FaceKind::patch ? data.source : -1};
}

void write_materials(OutputFile& out, const HullMesh& mesh) {
  std::set<Material> materials;
  for (const auto face : mesh.faces()) materials.insert(material(mesh, face));
  out.text("# Materials of a convex hull by Taut\n");
  for (const Material& m : materials) {
    out.text("newmtl ").text(m.name()).text("\nKd");
    for (const std::uint8_t c : face_color(m.kind, m.source)) {
      out.text(" ").text(std::round(c / 0.255) / 1000);
    }
    out.text("\nillum 1\n");
  }
}

void write_obj_faces(OutputFile& out, const HullMesh& mesh) {
  const FilePolygons polygons(mesh, most_corners);
  std::vector<std::size_t> order(polygons.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto hull_face = [&](std::size_t i) { return mesh.data(polygons.face(i)).hull_face; };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return hull_face(a) < hull_face(b); });

  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t i = order[k];
    const bool new_group = k == 0 || hull_face(i) != hull_face(order[k - 1]);
    if (new_group) {
      const int group = hull_face(i);
      out.text("g ").text(group < 0 ? "unassigned" : "face_" + std::to_string(group)).text("\n");
    }
    const Material m = material(mesh, polygons.face(i));
    if (new_group || m != material(mesh, polygons.face(order[k - 1]))) {
      out.text("usemtl ").text(m.name()).text("\n");
    }
    out.text("f");
    for (const int corner : polygons.corners(i)) out.text(" ").text(long{corner} + 1);
    out.text("\n");
  }
}

void write_point(OutputFile& out, const HullMesh& mesh, OpenMesh::VertexHandle vertex) {
  const dvec3 p = position(mesh, vertex);
  out.text(p.x).text(" ").text(p.y).text(" ").text(p.z).text("\n");
}

void write_obj(const std::filesystem::path& path, const HullMesh& mesh) {
  std::filesystem::path materials_path = path;
  materials_path.replace_extension(".mtl");
  OutputFile materials(materials_path);
  write_materials(materials, mesh);
  materials.finish();

  OutputFile out(path);
  out.text("# Convex hull by Taut\nmtllib ").text(materials_path.filename().string()).text("\n");
  for (const auto vertex : mesh.vertices()) {
    out.text("v ");
    write_point(out, mesh, vertex);
  }
  write_obj_faces(out, mesh);
  out.finish();

  materials.publish();
  try {
    out.publish();
  } catch (const IoError&) {
    materials.withdraw();
    throw;
  }
}

void write_off(const std::filesystem::path& path, const HullMesh& mesh) {
  const FilePolygons polygons(mesh, most_corners);
  // Every diagonal that splits a face adds an edge and a polygon.
  const std::size_t edges = mesh.n_edges() + (polygons.size() - mesh.n_faces());
  OutputFile out(path);
  out.text("OFF\n").text(static_cast<long>(mesh.n_vertices()));
  out.text(" ").text(static_cast<long>(polygons.size()));
  out.text(" ").text(static_cast<long>(edges)).text("\n");
  for (const auto vertex : mesh.vertices()) write_point(out, mesh, vertex);
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    out.text(static_cast<long>(polygons.corners(i).size()));
    for (const int corner : polygons.corners(i)) out.text(" ").text(long{corner});
    out.text("\n");
  }
  out.finish();
  out.publish();
}

void write_floats(OutputFile& out, const dvec3& p) {
  for (int i = 0; i < 3; ++i) out.binary(static_cast<float>(p[i]));
}

/// STL has triangles of floats only: vertices are rounded, and triangles that are smaller than a
/// float can tell collapse.
void write_stl(const std::filesystem::path& path, const HullMesh& mesh) {
  const auto point = [&](int vertex) { return position(mesh, OpenMesh::VertexHandle(vertex)); };
  for (const auto vertex : mesh.vertices()) {
    const dvec3 p = glm::abs(point(vertex.idx()));
    if (!(std::max({p.x, p.y, p.z}) <= double{std::numeric_limits<float>::max()})) {
      throw IoError(path.string() + ": a coordinate of vertex " + std::to_string(vertex.idx()) +
                    " is beyond the floats of STL; .ply holds it");
    }
  }
  const FilePolygons triangles(mesh, 3);
  if (triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw IoError(path.string() + ": has too many triangles for STL");
  }
  OutputFile out(path);
  std::string header = "Convex hull by Taut, binary STL";  // no first word "solid", as text has
  header.resize(80, ' ');
  out.text(header).binary(static_cast<std::uint32_t>(triangles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto corners = triangles.corners(i);
    const dvec3 a = point(corners[0]), b = point(corners[1]), c = point(corners[2]);
    write_floats(out, unit(glm::cross(b - a, c - a)));
    for (const dvec3& p : {a, b, c}) write_floats(out, p);
    out.binary(std::uint16_t{0});
  }
  out.finish();
  out.publish();
}

}  // namespace

void write_mesh(const std::filesystem::path& path, const HullMesh& mesh) {
  const std::string kind = extension(path);
  if (kind == ".ply") return write_ply(path, mesh);
  if (kind == ".obj") return write_obj(path, mesh);
  if (kind == ".off") return write_off(path, mesh);
  if (kind == ".stl") return write_stl(path, mesh);
  throw IoError(path.string() + ": no format of meshes has the extension \"" + kind +
                "\"; known are .obj, .off, .ply, .stl");
}

}  // namespace taut
