#include <string>
#include <utility>
#include <vector>

#include "taut/io/mesh/mesh_readers.h"
#include "taut/io/text/text_scanner.h"

namespace taut {
namespace {

/// What begins an OFF file, or "" if nothing of the kind does: "OFF", "COFF", "STCNOFF", ...
std::string_view off_keyword(std::string_view word) {
  std::string_view rest = word;
  for (const std::string_view prefix : {"ST", "C", "N", "4", "n"}) {
    if (rest.starts_with(prefix)) rest.remove_prefix(prefix.size());
  }
  return rest == "OFF" ? word : std::string_view();
}

/// Vertices and faces; the number of edges, which means nothing, may be absent.
std::pair<std::size_t, std::size_t> read_off_counts(TextScanner& scanner) {
  constexpr std::size_t vertex_bytes = 3 * 2;
  constexpr std::size_t face_bytes = 4 * 2;
  const Word vertices = scanner.next("the number of vertices");
  const Word faces = scanner.next("the number of faces");
  const TextScanner without_edges = scanner;
  if (scanner.at_end() || scanner.next("the number of edges").line != faces.line) {
    scanner = without_edges;
  }
  return {scanner.count(vertices, vertex_bytes, "vertices"),
          scanner.count(faces, face_bytes, "faces")};
}

std::vector<int> read_off_face(TextScanner& scanner, std::size_t vertex_count) {
  const Word word = scanner.next("the number of a face's vertices");
  const std::size_t corners = scanner.count(word, 2, "vertices of a face");
  if (corners < 3) scanner.refuse(word.line, "a face has fewer than three vertices");
  std::vector<int> face(corners);
  for (int& corner : face) {
    const Word vertex = scanner.next("a vertex index");
    const long index = scanner.integer(vertex, "a vertex index");
    if (index < 0 || static_cast<std::size_t>(index) >= vertex_count) {
      scanner.refuse(vertex.line, "vertex index " + std::to_string(index) + " is not below " +
                                      std::to_string(vertex_count));
    }
    corner = static_cast<int>(index);
  }
  scanner.skip_line();  // a colour may follow
  return face;
}

}  // namespace

PolygonMesh read_off(const std::string& file, std::string_view data, const Progress& progress) {
  TextScanner scanner(file, data);
  scanner.at_end();
  const TextScanner beginning = scanner;
  const Word word = scanner.next("OFF");
  const std::string_view keyword = off_keyword(word.text);
  if (keyword.empty()) {
    scanner = beginning;  // the keyword is optional; counts must follow at once
  } else if (keyword.find_first_of("4n") != keyword.npos) {
    scanner.fail(word.line, "points of other than three coordinates are not supported");
  }
  const TextScanner counts = scanner;
  if (!keyword.empty() && scanner.next("the number of vertices").text == "BINARY") {
    scanner.fail(word.line, "the binary form of OFF is not supported");
  }
  scanner = counts;

  const auto [vertices, faces] = read_off_counts(scanner);
  const double bytes = static_cast<double>(scanner.bytes_left());
  const auto update = [&](std::size_t k) {
    constexpr std::size_t lines_per_update = 65536;
    if (k % lines_per_update != 0) return;
    progress.update("read", 1 - static_cast<double>(scanner.bytes_left()) / bytes);
  };
  PolygonMesh mesh;
  mesh.points.resize(vertices);
  for (std::size_t k = 0; k < vertices; ++k) {
    update(k);
    dvec3& p = mesh.points[k];
    for (int i = 0; i < 3; ++i) p[i] = scanner.next_number("a coordinate");
    // Normals, colours and texture coordinates, of which the keyword tells.
    if (keyword.size() > 3) scanner.skip_line();
  }
  mesh.polygons.reserve(faces);
  for (std::size_t k = 0; k < faces; ++k) {
    update(k);
    mesh.polygons.push_back(read_off_face(scanner, vertices));
  }
  return mesh;
}

}  // namespace taut
