#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/io/text/text_scanner.h"

namespace taut {

/// The index of a reference "v", "v/vt" or "v/vt/vn", counted from 0; `count` things of its kind
/// were read before it, from the last of which negative references count. The kind has its article.
/// @throws IoError if it is no such reference, InvalidInput if it lies before the first
std::size_t obj_index(const TextScanner& scanner, const Word& word, std::size_t count,
                      std::string_view kind = "a vertex");

/// The index of something that must stand before it is referred to, as by obj_index.
/// @throws InvalidInput also where it stands later
std::size_t earlier_obj_index(const TextScanner& scanner, const Word& word, std::size_t count,
                              std::string_view kind);

/// The vertices that polygons and points refer to. They may follow later, so that indices can be
/// checked at the end only.
class ObjReferences {
 public:
  /// The index of obj_index(), noted. @throws as that does
  int add(const TextScanner& scanner, const Word& word, std::size_t count);
  /// @throws InvalidInput if one is not below the number of vertices
  void check(const TextScanner& scanner, std::size_t count) const;

 private:
  std::size_t most_ = 0;
  long line_ = 0;
};

/// The coordinates of a `v` statement. @throws IoError, InvalidInput with place
dvec3 obj_point(const TextScanner& scanner, const std::vector<Word>& statement);

/// Adds the polygon of an `f` statement. @throws IoError, InvalidInput with place
void add_obj_polygon(const TextScanner& scanner, const std::vector<Word>& statement,
                     std::size_t count, ObjReferences& references,
                     std::vector<std::vector<int>>& polygons);

}  // namespace taut
