#include "taut/io/mesh/write_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "taut/core/error.h"
#include "taut/io/mesh/file_polygons.h"
#include "taut/io/mesh/rounded_hull.h"
#include "taut/io/text/formats.h"
#include "taut/io/text/output_file.h"

namespace taut {
namespace {

/// Lengths of lists are one byte in PLY.
constexpr std::size_t most_corners = 255;

using Color = std::array<std::uint8_t, 3>;

/// Muted colours for patches, in which neighbouring numbers differ most in hue: multiples of the
/// golden ratio are spread evenly, however many there are. Scrolls and facets stand out.
Color face_color(FaceKind kind, int source) {
  if (kind == FaceKind::scroll) return {250, 192, 84};
  if (kind == FaceKind::facet) return {112, 150, 196};
  if (source < 0) return {190, 190, 190};
  constexpr double golden_ratio = 0.6180339887498949;
  constexpr double lightest = 228;
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

/// Its one edge is written as such, since it bounds no face.
bool is_segment(const HullMesh& mesh) { return mesh.n_faces() == 0 && mesh.n_edges() == 1; }

void write_ply(OutputBuffer& out, const HullMesh& mesh) {
  const FilePolygons polygons(mesh, most_corners);
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
      .text("property uchar kind\nproperty int source\nproperty int hull_face\n");
  if (is_segment(mesh)) out.text("element edge 1\nproperty int vertex1\nproperty int vertex2\n");
  out.text("end_header\n");

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
  if (is_segment(mesh)) out.binary(std::int32_t{0}).binary(std::int32_t{1});
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

void write_materials(OutputBuffer& out, const HullMesh& mesh) {
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

void write_obj_faces(OutputBuffer& out, const HullMesh& mesh, bool with_materials) {
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
    if (with_materials && (new_group || m != material(mesh, polygons.face(order[k - 1])))) {
      out.text("usemtl ").text(m.name()).text("\n");
    }
    out.text("f");
    for (const int corner : polygons.corners(i)) out.text(" ").text(long{corner} + 1);
    out.text("\n");
  }
}

void write_point(OutputBuffer& out, const HullMesh& mesh, OpenMesh::VertexHandle vertex) {
  const dvec3 p = position(mesh, vertex);
  out.text(p.x).text(" ").text(p.y).text(" ").text(p.z).text("\n");
}

/// `materials`: the name of the file that describes the materials, empty if there is none.
void write_obj(OutputBuffer& out, const std::string& materials, const HullMesh& mesh) {
  out.text("# Convex hull by Taut\n");
  if (!materials.empty()) out.text("mtllib ").text(materials).text("\n");
  for (const auto vertex : mesh.vertices()) {
    out.text("v ");
    write_point(out, mesh, vertex);
  }
  write_obj_faces(out, mesh, !materials.empty());
  if (mesh.n_vertices() == 1) out.text("p 1\n");
  if (is_segment(mesh)) out.text("l 1 2\n");
}

/// A segment is its edge in number only: readers want three corners of a face at least.
void write_off(OutputBuffer& out, const HullMesh& mesh) {
  const FilePolygons polygons(mesh, most_corners);
  // Every diagonal that splits a face adds an edge and a polygon.
  const std::size_t edges = mesh.n_edges() + (polygons.size() - mesh.n_faces());
  out.text("OFF\n").text(static_cast<long>(mesh.n_vertices()));
  out.text(" ").text(static_cast<long>(polygons.size()));
  out.text(" ").text(static_cast<long>(edges)).text("\n");
  for (const auto vertex : mesh.vertices()) write_point(out, mesh, vertex);
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    out.text(static_cast<long>(polygons.corners(i).size()));
    for (const int corner : polygons.corners(i)) out.text(" ").text(long{corner});
    out.text("\n");
  }
}

void write_floats(OutputBuffer& out, const dvec3& p) {
  for (int i = 0; i < 3; ++i) out.binary(static_cast<float>(p[i]));
}

std::string_view dimension_name(const HullMesh& mesh) {
  return mesh.n_vertices() == 0 ? "empty" : mesh.n_vertices() == 1 ? "a point" : "a segment";
}

/// Triangles of floats.
WrittenMesh write_stl(OutputBuffer& out, const std::string& name, const HullMesh& mesh) {
  const auto refuse = [&](const std::string& what) {
    throw IoError(name + ": " + what + "; .ply holds it");
  };
  RoundedHull rounded;
  try {
    rounded = rounded_hull(mesh);
  } catch (const InvalidInput& error) {
    refuse(std::string(error.what()) + " of STL");
  }
  if (rounded.mesh.n_faces() == 0) {
    refuse("an STL file holds triangles only, and the hull is " +
           std::string(dimension_name(rounded.mesh)) + (mesh.n_faces() > 0 ? " in floats" : ""));
  }
  const FilePolygons triangles(rounded.mesh, 3);
  if (triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    refuse("has too many triangles for STL");
  }
  std::string header = "Convex hull by Taut, binary STL";  // no first word "solid", as text has
  header.resize(80, ' ');
  out.text(header).binary(static_cast<std::uint32_t>(triangles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    std::array<dvec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = position(rounded.mesh, OpenMesh::VertexHandle(triangles.corners(i)[k]));
    }
    write_floats(out, unit(glm::cross(p[1] - p[0], p[2] - p[0])));
    for (const dvec3& corner : p) write_floats(out, corner);
    out.binary(std::uint16_t{0});
  }
  return {rounded.rounding};
}

/// Puts out what a file of the format holds. `materials`: as for write_obj().
WrittenMesh write(OutputBuffer& out, const std::string& name, const std::string& format,
                  const std::string& materials, const HullMesh& mesh) {
  if (format == ".stl") return write_stl(out, name, mesh);
  if (format == ".ply") write_ply(out, mesh);
  if (format == ".obj") write_obj(out, materials, mesh);
  if (format == ".off") write_off(out, mesh);
  return {};
}

void check_format(const std::string& name, const std::string& format) {
  if (format == ".ply" || format == ".obj" || format == ".off" || format == ".stl") return;
  throw IoError(name + ": no format of meshes has the extension \"" + format +
                "\"; known are .obj, .off, .ply, .stl");
}

}  // namespace

double float_rounding_bound(const Box& box) {
  if (box.empty()) return 0;
  constexpr double unit = std::numeric_limits<float>::epsilon() / 2;
  const double reach = glm::length(glm::max(glm::abs(box.lower), glm::abs(box.upper)));
  return std::max(unit * reach, double(std::numeric_limits<float>::denorm_min()));
}

double float_rounding(std::span<const dvec3> points) {
  using Float = std::numeric_limits<float>;
  double largest = 0;
  for (const dvec3& p : points) {
    dvec3 half_unit(0.0);
    for (int i = 0; i < 3; ++i) {
      const bool is_float = std::abs(p[i]) <= double{Float::max()} && nearest_float(p[i]) == p[i];
      if (!is_float) continue;
      const int exponent = std::max(std::ilogb(p[i]), Float::min_exponent - 1);
      half_unit[i] = std::ldexp(1.0, exponent - Float::digits);
    }
    largest = std::max(largest, glm::length(half_unit));
  }
  return largest;
}

WrittenMesh write_mesh(const std::filesystem::path& path, const HullMesh& mesh) {
  const std::string format = extension(path);
  check_format(path.string(), format);
  std::filesystem::path materials_path = path;
  materials_path.replace_extension(".mtl");
  std::optional<OutputFile> materials;
  if (format == ".obj" && mesh.n_faces() > 0) {
    write_materials(materials.emplace(materials_path), mesh);
    materials->finish();
  }
  OutputFile out(path);
  const WrittenMesh written =
      write(out, path.string(), format, materials ? materials_path.filename().string() : "", mesh);
  out.finish();

  if (materials) materials->publish();
  try {
    out.publish();
  } catch (const IoError&) {
    if (materials) materials->withdraw();
    throw;
  }
  return written;
}

WrittenMesh write_mesh(std::string& data, const std::string& name, const std::string& format,
                       const HullMesh& mesh) {
  check_format(name, format);
  OutputBuffer out;
  const WrittenMesh written = write(out, name, format, "", mesh);
  data += out.content();
  return written;
}

}  // namespace taut
