#pragma once

#include <string>
#include <utility>
#include <vector>

#include "taut/io/text/text_scanner.h"
#include "taut/surface/control_cage.h"

namespace taut {

/// OpenSubdiv's tags of a subdivision cage. Vertices and faces are in range, faces are polygons in
/// their order.
struct ObjTags {
  std::vector<CageCrease> creases;
  std::vector<CageCorner> corners;
  std::vector<int> holes;
  CageBoundary boundary = CageBoundary::edge_and_corner;
  bool chaikin = false;
  bool smooth_triangles = false;
};

/// Reads the tags that OpenSubdiv writes into OBJ files: `t NAME I/F/S`, behind which stand I
/// integers, F numbers and S words. Indices count from 0.
///
/// Creases (a chain of vertices with one sharpness for all its edges or one each), corners, holes,
/// the rules at boundaries and of creases and of triangles are known.
class ObjTagReader {
 public:
  /// False if the tag is not known. @throws IoError, InvalidInput with place
  bool add(const TextScanner& scanner, const std::vector<Word>& statement);
  /// @throws InvalidInput if a tag names a vertex or face that is not there
  void check(const TextScanner& scanner, std::size_t vertices, std::size_t faces) const;
  ObjTags take() { return std::move(tags_); }

 private:
  struct Reference {
    long index = 0;
    long line = 0;
  };
  struct Tag;

  void add_crease(const TextScanner& scanner, const Tag& tag);
  void add_corners(const TextScanner& scanner, const Tag& tag);
  int vertex(const TextScanner& scanner, long index, long line);

  ObjTags tags_;
  Reference last_vertex_ = {-1, 0};
  Reference last_face_ = {-1, 0};
};

}  // namespace taut
